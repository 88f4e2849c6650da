//! Which bodies the camera is fitted to: not those that have left the scene, such as one that fell off a
//! table.

use crate::bare_mesh::extent;
use bowknot::geometry::Point;
use bowknot::io::Mesh;
use std::collections::{HashMap, HashSet};

/// Distance from where all bodies are at the start, in the diagonal of their box there, beyond which a body
/// has left.
const LEFT: f64 = 1.0;

/// The bodies of a run, and where they are at the start.
pub struct Framing<'a> {
    body: &'a [u32],
    obstacle: &'a [bool],
    home: [Point; 2],
}

impl<'a> Framing<'a> {
    /// The bodies of a mesh, which is the first frame.
    pub fn new(first: &'a Mesh) -> Self {
        let body = first.body.as_deref().unwrap_or(&[]);
        let obstacle = first.obstacle.as_deref().unwrap_or(&[]);
        Self { body, obstacle, home: extent(&first.positions).into() }
    }

    /// The positions of a frame without those of bodies that have left; all of them if no deformable body
    /// stays.
    pub fn staying(&self, positions: &'a [Point]) -> impl Iterator<Item = &'a Point> {
        let body = |v: usize| self.body.get(v).copied().unwrap_or(0);
        // Lower and upper corner, and whether it deforms. Numbers of bodies may be any.
        let mut boxes: HashMap<u32, ([Point; 2], bool)> = HashMap::new();
        for (v, x) in positions.iter().enumerate() {
            let ([low, high], deforms) = boxes.entry(body(v)).or_insert(([*x; 2], true));
            (*low, *high) = (low.inf(x), high.sup(x));
            *deforms &= !self.obstacle.get(v).copied().unwrap_or(false);
        }
        let [low, high] = self.home;
        let farthest = LEFT * (high - low).norm();
        let has_left = |[l, h]: &[Point; 2]| {
            let apart = (l - high).sup(&(low - h)).map(|gap| gap.max(0.0));
            apart.norm() > farthest
        };
        let any_stays = boxes.values().any(|(corners, deforms)| *deforms && !has_left(corners));
        let left = boxes.iter().filter(|(_, (corners, _))| any_stays && has_left(corners));
        let left: HashSet<u32> = left.map(|(body, _)| *body).collect();
        let own = self.body;
        let stays = move |v: usize| !left.contains(&own.get(v).copied().unwrap_or(0));
        positions.iter().enumerate().filter(move |(v, _)| stays(*v)).map(|(_, x)| x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_falls_away_is_left_out_unless_it_is_the_last() {
        let at = |z: f64| Point::new(0.0, 0.0, z);
        let first = Mesh {
            positions: vec![at(0.0), at(1.0), at(0.5), at(-0.5)],
            body: Some(vec![0, 0, 1, 2]),
            obstacle: Some(vec![false, false, false, true]),
            ..Mesh::default()
        };
        let framing = Framing::new(&first);
        let staying = |z: [f64; 4]| {
            let positions = z.map(at);
            framing.staying(&positions).map(|x| x.z).collect::<Vec<f64>>()
        };
        assert_eq!(staying([0.0, 1.0, -1.9, -0.5]), [0.0, 1.0, -1.9, -0.5]);
        assert_eq!(staying([0.0, 1.0, -9.0, -0.5]), [0.0, 1.0, -0.5]);
        assert_eq!(staying([-8.0, -9.0, -9.0, -0.5]), [-8.0, -9.0, -9.0, -0.5]);
        // Parts of one body stay together.
        assert_eq!(staying([0.0, -9.0, -9.0, -0.5]), [0.0, -9.0, -0.5]);
    }
}
