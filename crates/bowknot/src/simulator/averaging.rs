//! Contacts over the Newton iterations of a time step.
//!
//! Contacts follow from positions, but not smoothly. Normals turn with the bodies, so that bodies pressed together overshoot,
//! to one side and the other in turn. And contacts come and go: that of two crossing edges ends at once where its closest
//! point reaches the end of an edge, and others take over its stiffness (`crowding.rs`). Where forces balance only at
//! the border between two such sets of contacts, Newton's method would go from one set to the other for ever.
//!
//! So each contact is the mean of what it was after the iterations so far (Mann, "Mean value methods in iteration",
//! Proceedings of the American Mathematical Society 4, 1953). Contacts that come and go tend to the mixture of both sets
//! whose forces balance: a solution in the sense of Filippov. What contacts were at the start of the time step does not count:
//! in an impact that is far off.

use bowknot_constraints::Feature;
use bowknot_dynamics::RepulsionSpring;
use bowknot_geometry::{Point, Vector};
use rustc_hash::FxHashMap;

/// Share of its height above the floor that a contact which is none any more keeps at least. Nearer, its plane is not where
/// the bodies are: they have slid past each other.
const STILL_THERE: f64 = 0.9;

/// Stiffness, in that of a whole contact, below which one that is none any more is forgotten.
const FORGOTTEN: f64 = 0.01;

/// Contacts: their features, springs, and distances where they were found [m]. Other springs may follow after theirs.
#[derive(Clone, Debug, Default)]
pub(super) struct FoundContacts {
    pub features: Vec<[Feature; 2]>,
    pub springs: Vec<RepulsionSpring>,
    pub distances: Vec<f64>,
}

impl FoundContacts {
    /// Averages these contacts, found at the positions `x` after so many `iterations`, with the means `before`.
    /// Contacts that are none any more stay with their part. `stiffness` is that of a whole one.
    pub fn average(&mut self, before: &Self, iterations: usize, stiffness: f64, x: &[Point]) {
        let new = share_of(iterations);
        let all_before = before.features.iter().zip(&before.springs).zip(&before.distances);
        let mut gone: FxHashMap<&[Feature; 2], &RepulsionSpring> =
            all_before.clone().map(|(contact, _)| contact).collect();
        for (features, spring) in self.features.iter().zip(&mut self.springs) {
            match gone.remove(features) {
                Some(old) => mix(spring, old, new),
                None => spring.stiffness *= new,
            }
        }
        for ((features, old), &distance) in all_before {
            let left = RepulsionSpring { stiffness: old.stiffness * (1.0 - new), ..*old };
            let least = old.floor + STILL_THERE * (distance - old.floor);
            let stays = || left.stiffness > FORGOTTEN * stiffness && gap(old, x) > least;
            if gone.contains_key(features) && stays() {
                self.features.push(*features);
                self.springs.push(left);
                self.distances.push(distance);
            }
        }
    }
}

/// Share of an iteration in the mean, the first is number 1. In the first one contacts are farthest off, so the second counts
/// twice as much.
fn share_of(iteration: usize) -> f64 {
    if iteration == 2 { 2.0 / 3.0 } else { 1.0 / iteration as f64 }
}

/// Moves the spring of a contact from the `new` part on to what it was before.
fn mix(spring: &mut RepulsionSpring, old: &RepulsionSpring, new: f64) {
    let mean = |old: f64, now: f64| old + (now - old) * new;
    spring.stiffness = mean(old.stiffness, spring.stiffness);
    let normal = old.normal + (spring.normal - old.normal) * new;
    spring.normal = normal.try_normalize(0.0).unwrap_or(spring.normal);
    // The same two features may be in contact as pairs of other kinds.
    if spring.vertices == old.vertices {
        spring.weights = std::array::from_fn(|k| mean(old.weights[k], spring.weights[k]));
    }
}

/// The gap of a contact [m].
pub(super) fn gap(spring: &RepulsionSpring, x: &[Point]) -> f64 {
    let vertices = spring.vertices.iter().zip(spring.weights);
    let sides: Vector = vertices.map(|(&vertex, weight)| x[vertex as usize].coords * weight).sum();
    spring.normal.dot(&sides) - spring.offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_dynamics::SpringKind;

    const WHOLE: f64 = 3.0;

    /// Vertex 0 above vertex 1, which is at the origin.
    fn contacts(features: &[[Feature; 2]]) -> FoundContacts {
        let spring = RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: [0, 1, 0, 0],
            weights: [1.0, -1.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            reach: 1.0,
            floor: 0.2,
            start_gap: 0.5,
            stiffness: WHOLE,
            friction: 0.0,
            friction_ratio: Vector::zeros(),
        };
        let count = features.len();
        FoundContacts {
            features: features.to_vec(),
            springs: vec![spring; count],
            distances: vec![0.5; count],
        }
    }

    fn at(height: f64) -> [Point; 2] {
        [Point::new(0.0, 0.0, height), Point::origin()]
    }

    const FIRST: [Feature; 2] = [Feature::Edge(0), Feature::Edge(1)];
    const SECOND: [Feature; 2] = [Feature::Edge(0), Feature::Edge(2)];

    #[test]
    fn contacts_that_take_turns_tend_to_half_of_each() {
        let mut mean = contacts(&[FIRST]);
        for iteration in 2..200 {
            let mut found = contacts(&[if iteration % 2 == 0 { SECOND } else { FIRST }]);
            found.average(&mean, iteration, WHOLE, &at(0.5));
            mean = found;
        }
        let mut shares: Vec<f64> = mean.springs.iter().map(|spring| spring.stiffness / WHOLE).collect();
        shares.sort_by(f64::total_cmp);
        assert!(shares.len() == 2 && shares.iter().all(|share| (share - 0.5).abs() < 0.01), "{shares:?}");
    }

    #[test]
    fn a_contact_that_is_none_any_more_goes_where_its_plane_is_left() {
        for (height, count) in [(0.5, 2), (0.9, 2), (0.4, 1)] {
            let mut found = contacts(&[SECOND]);
            found.average(&contacts(&[FIRST]), 2, WHOLE, &at(height));
            assert_eq!(
                (found.features.len(), found.springs.len(), found.distances.len()),
                (count, count, count)
            );
        }
    }

    #[test]
    fn normals_and_weights_are_means_and_normals_stay_units() {
        let (mut found, mut before) = (contacts(&[FIRST]), contacts(&[FIRST]));
        found.springs[0].normal = Vector::x();
        found.springs[0].weights = [0.2, -1.0, 0.8, 0.0];
        before.springs[0].normal = Vector::z();
        found.average(&before, 4, WHOLE, &at(0.5));
        let spring = found.springs[0];
        assert!((spring.normal - Vector::new(1.0, 0.0, 3.0).normalize()).norm() < 1e-12);
        assert!(spring.weights.iter().zip([0.8, -1.0, 0.2, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert_eq!(spring.stiffness, WHOLE);
    }
}
