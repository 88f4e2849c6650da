//! Contacts that share a place share its stiffness.
//!
//! One vertex may be in contact with several features next to each other, and an edge with all edges that it
//! crosses. If each of these contacts were as stiff as one alone, a body would be lifted when it slides from
//! one triangle to two. So the contacts of a vertex with similar normals divide the stiffness of one among
//! them. Shares are continuous in positions.

use bowknot_dynamics::RepulsionSpring;
use bowknot_geometry::Vector;
use rustc_hash::FxHashMap;

/// Distance, in its reach, from which on a contact does not count among its neighbors. From the reach on it
/// counts less.
const FADED: f64 = 1.5;

/// Multiplies the stiffness of contacts with their share. `shares` is how much of a contact each is [1],
/// `gaps` its distance [m]; vertices that are not `deformable` do not count.
pub(super) fn share_stiffness(
    springs: &mut [RepulsionSpring],
    shares: &[f64],
    gaps: &[f64],
    deformable: &[bool],
) {
    let crowd = Crowd::new(springs, shares, gaps, deformable);
    let crowds: Vec<f64> = springs.iter().map(|spring| crowd.around(spring)).collect();
    for ((spring, share), crowd) in springs.iter_mut().zip(shares).zip(crowds) {
        spring.stiffness *= share / crowd;
    }
}

/// The contacts of each vertex: how much each counts [1], and the normal on the vertex's side.
struct Crowd {
    of_vertices: FxHashMap<u32, Vec<(f64, Vector)>>,
}

impl Crowd {
    fn new(springs: &[RepulsionSpring], shares: &[f64], gaps: &[f64], deformable: &[bool]) -> Self {
        let mut of_vertices: FxHashMap<u32, Vec<(f64, Vector)>> = FxHashMap::default();
        for ((spring, share), distance) in springs.iter().zip(shares).zip(gaps) {
            let near = (FADED - distance / spring.reach) / (FADED - 1.0);
            let counts = share * near.clamp(0.0, 1.0);
            if counts > 0.0 {
                for (&vertex, weight) in spring.vertices.iter().zip(spring.weights) {
                    if weight != 0.0 && deformable[vertex as usize] {
                        let contact = (counts * weight.abs(), spring.normal * weight.signum());
                        of_vertices.entry(vertex).or_default().push(contact);
                    }
                }
            }
        }
        Self { of_vertices }
    }

    /// How many contacts are where a contact is, at least 1: on the deformable side on which they are fewer.
    fn around(&self, spring: &RepulsionSpring) -> f64 {
        let on_side = |sign: f64| {
            let normal = spring.normal * sign;
            let along = |list: &Vec<(f64, Vector)>| {
                list.iter().map(|(counts, other)| counts * other.dot(&normal).max(0.0)).sum::<f64>()
            };
            let side = (0..4).filter(|&k| spring.weights[k] * sign > 0.0);
            let of_vertex = |k: usize| {
                let contacts = self.of_vertices.get(&spring.vertices[k])?;
                Some(spring.weights[k].abs() * along(contacts))
            };
            let mut known = side.filter_map(of_vertex).peekable();
            known.peek().is_some().then(|| known.sum::<f64>())
        };
        let fewest = [1.0, -1.0].into_iter().filter_map(on_side).fold(f64::INFINITY, f64::min);
        if fewest.is_finite() { fewest.max(1.0) } else { 1.0 }
    }
}
