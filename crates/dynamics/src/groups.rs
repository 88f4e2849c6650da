//! Members that touch each other, and the directions in which something else holds them.

use bowknot_geometry::{UnionFind, Vector};
use nalgebra::{Matrix3, SymmetricEigen};

/// Resistance up to which a direction is free, as a share of the largest one: normals that differ by rounding
/// alone span one direction.
const FREE: f64 = 1e-14;

/// Disjoint sets of 0..n, and what holds their members. The smallest member represents its set.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    sets: UnionFind,
    held: Vec<Hold>,
}

/// What holds a member.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hold {
    /// Contacts without friction: the sum of n n^T over their normals n.
    Along(Matrix3<f64>),
    /// Something that holds it in all directions.
    Fully,
}

/// A set, and how it may move as a whole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    /// Ascending.
    pub members: Vec<usize>,
    /// The projection on the directions in which nothing holds it.
    pub free: Matrix3<f64>,
}

impl Hold {
    pub const NONE: Self = Self::Along(Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0));

    /// A contact with a unit `normal`; it has friction if it is `rough`.
    pub fn contact(normal: &Vector, rough: bool) -> Self {
        if rough { Self::Fully } else { Self::Along(normal * normal.transpose()) }
    }

    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Along(a), Self::Along(b)) => Self::Along(a + b),
            _ => Self::Fully,
        }
    }

    /// The projection on the directions that are free; 0 if none is.
    fn free(&self) -> Matrix3<f64> {
        let Self::Along(resistance) = self else { return Matrix3::zeros() };
        if *resistance == Matrix3::zeros() {
            return Matrix3::identity();
        }
        let SymmetricEigen { eigenvectors, eigenvalues } = resistance.symmetric_eigen();
        // Nothing is free along a normal that is not a number.
        let free = (0..3).filter(|&k| eigenvalues[k] <= FREE * eigenvalues.max());
        free.map(|k| eigenvectors.column(k) * eigenvectors.column(k).transpose()).sum()
    }
}

impl Groups {
    /// Each of 0..`count` is a group of its own.
    pub fn new(count: usize) -> Self {
        Self { sets: UnionFind::new(count), held: vec![Hold::NONE; count] }
    }

    /// Joins the groups of two members.
    pub fn join(&mut self, a: usize, b: usize) {
        self.sets.join(a as u32, b as u32);
    }

    /// Adds to what holds a member, and thereby its group.
    pub fn hold(&mut self, member: usize, hold: Hold) {
        self.held[member] = self.held[member].and(hold);
    }

    /// Joins all of `members`, which something else may hold.
    pub fn join_all(&mut self, members: impl IntoIterator<Item = usize>, hold: Hold) {
        let mut members = members.into_iter();
        let Some(first) = members.next() else { return };
        self.hold(first, hold);
        members.for_each(|member| self.join(first, member));
    }

    /// The groups that are free in some direction, in the order of their smallest members.
    pub fn free(mut self) -> Vec<Group> {
        let count = self.held.len();
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut held = vec![Hold::NONE; count];
        for member in 0..count {
            let root = self.sets.find(member as u32) as usize;
            members[root].push(member);
            held[root] = held[root].and(self.held[member]);
        }
        let groups = members.into_iter().zip(held).filter(|(members, _)| !members.is_empty());
        let groups = groups.map(|(members, held)| Group { members, free: held.free() });
        groups.filter(|group| group.free != Matrix3::zeros()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn members(groups: Groups) -> Vec<Vec<usize>> {
        groups.free().into_iter().map(|group| group.members).collect()
    }

    #[test]
    fn groups_are_sorted_and_held_ones_are_left_out() {
        let mut groups = Groups::new(6);
        groups.join(4, 1);
        groups.join(5, 4);
        groups.join_all([2, 0], Hold::NONE);
        assert_eq!(members(groups.clone()), [vec![0, 2], vec![1, 4, 5], vec![3]]);
        assert!(groups.clone().free().iter().all(|group| group.free == Matrix3::identity()));
        groups.hold(5, Hold::Fully);
        assert_eq!(members(groups), [vec![0, 2], vec![3]]);
    }

    /// Nearly: rounding turns the normals of a plane.
    #[test]
    fn smooth_contacts_leave_the_directions_across_them_free() {
        let hold = |normals: &[[f64; 3]]| {
            let mut groups = Groups::new(2);
            groups.join(0, 1);
            for (k, normal) in normals.iter().enumerate() {
                groups.hold(k % 2, Hold::contact(&Vector::from(*normal).normalize(), false));
            }
            groups.free().first().map_or_else(Matrix3::zeros, |group| group.free)
        };
        let is = |free: Matrix3<f64>, diagonal: [f64; 3]| {
            (free - Matrix3::from_diagonal(&diagonal.into())).amax() < 1e-8
        };
        assert!(is(hold(&[[0.0, 0.0, 1.0], [1e-15, 0.0, -1.0], [0.0, 1e-9, 1.0]]), [1.0, 1.0, 0.0]));
        assert!(is(hold(&[[0.0, 0.0, 1.0], [0.0, 1e-3, 1.0]]), [1.0, 0.0, 0.0]));
        assert!(is(hold(&[[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0]]), [0.0; 3]));
        assert!(is(hold(&[[f64::NAN, 0.0, 1.0]]), [0.0; 3]));
    }

    #[test]
    fn friction_holds_in_all_directions() {
        let mut groups = Groups::new(1);
        groups.hold(0, Hold::contact(&Vector::z(), true));
        assert!(groups.free().is_empty());
    }
}
