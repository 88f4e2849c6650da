//! Independent parts of a linear system: connected components of nodes, joined where springs act.
//!
//! No entry of the matrix joins two parts. Each has step lengths and an end of its own in conjugate gradients, so that it takes
//! the iterations that it needs, whatever the others need.

use super::springs::LinearSprings;
use crate::nodes::{CHUNK, NO_NODE};
use bowknot_geometry::{UnionFind, Vector};
use rayon::prelude::*;
use std::ops::Range;

/// The parts, and where their nodes are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    /// Runs of nodes of one component within one chunk, ascending.
    pieces: Vec<Piece>,
    /// Pieces of each chunk: `pieces[starts[chunk]..starts[chunk + 1]]`.
    starts: Vec<usize>,
    /// The part of each component.
    of_components: Vec<u32>,
    count: usize,
}

/// Nodes of a part.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub nodes: Range<usize>,
    pub part: usize,
}

impl Parts {
    /// One part of so many nodes.
    pub fn whole(nodes: usize) -> Self {
        Self::of(std::slice::from_ref(&(0..nodes as u32)), vec![0], 1)
    }

    /// The parts of `components`, which are ascending ranges of nodes, joined by `springs`.
    pub fn new(components: &[Range<u32>], springs: &LinearSprings) -> Self {
        let mut sets = UnionFind::new(components.len());
        if components.len() > 1 {
            let component = |node: u32| components.partition_point(|c| c.end <= node) as u32;
            for spring in springs.all() {
                let mut joined = spring.nodes.iter().filter(|node| **node != NO_NODE).map(|&n| component(n));
                if let Some(first) = joined.next() {
                    joined.for_each(|other| sets.join(first, other));
                }
            }
        }
        let mut count = 0;
        let mut of_components: Vec<u32> = Vec::with_capacity(components.len());
        for component in 0..components.len() as u32 {
            // The smallest member represents a set.
            let root = sets.find(component);
            let part = if root == component { count } else { of_components[root as usize] };
            count += u32::from(root == component);
            of_components.push(part);
        }
        Self::of(components, of_components, count as usize)
    }

    fn of(components: &[Range<u32>], of_components: Vec<u32>, count: usize) -> Self {
        let (mut pieces, mut starts): (Vec<Piece>, Vec<usize>) = (Vec::new(), Vec::new());
        for (component, &part) in components.iter().zip(&of_components) {
            let (mut first, end) = (component.start as usize, component.end as usize);
            while first < end {
                let chunk = first / CHUNK;
                if starts.len() <= chunk {
                    starts.push(pieces.len());
                }
                let last = end.min((chunk + 1) * CHUNK);
                pieces.push(Piece { nodes: first..last, part: part as usize });
                first = last;
            }
        }
        starts.push(pieces.len());
        Self { pieces, starts, of_components, count }
    }

    /// Number of parts.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The part of each component.
    pub fn of_components(&self) -> &[u32] {
        &self.of_components
    }

    /// The pieces of a chunk.
    #[inline]
    pub fn of_chunk(&self, chunk: usize) -> &[Piece] {
        &self.pieces[self.starts[chunk]..self.starts[chunk + 1]]
    }

    /// For each chunk, room for a number per piece of it.
    pub fn room<'a>(&self, numbers: &'a mut Vec<f64>) -> Vec<&'a mut [f64]> {
        numbers.clear();
        numbers.resize(self.pieces.len(), 0.0);
        let mut rest = numbers.as_mut_slice();
        let mut rooms = Vec::with_capacity(self.starts.len());
        for range in self.starts.windows(2) {
            let (room, others) = rest.split_at_mut(range[1] - range[0]);
            rooms.push(room);
            rest = others;
        }
        rooms
    }

    /// Sums of numbers per piece by part, in the order of nodes.
    pub fn sums(&self, numbers: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.count];
        self.pieces.iter().zip(numbers).for_each(|(piece, number)| sums[piece.part] += number);
        sums
    }

    /// The sum of a_i . b_i over each part.
    pub fn dot(&self, a: &[Vector], b: &[Vector]) -> Vec<f64> {
        let mut numbers = Vec::new();
        self.room(&mut numbers).into_par_iter().enumerate().for_each(|(chunk, room)| {
            for (piece, number) in self.of_chunk(chunk).iter().zip(room) {
                let nodes = piece.nodes.clone();
                *number = a[nodes.clone()].iter().zip(&b[nodes]).map(|(a, b)| a.dot(b)).sum();
            }
        });
        self.sums(&numbers)
    }

    /// y += s x with a factor s per part.
    pub fn add_scaled(&self, y: &mut [Vector], s: &[f64], x: &[Vector]) {
        y.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, y)| {
            for Piece { nodes, part } in self.of_chunk(chunk) {
                let first = chunk * CHUNK;
                let own = y[nodes.start - first..nodes.end - first].iter_mut().zip(&x[nodes.clone()]);
                own.for_each(|(y, x)| *y += x * s[*part]);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::springs::LinearSpring;
    use nalgebra::Matrix3;

    #[test]
    fn springs_join_components_to_parts() {
        let components = [0..3, 3..700, 700..701, 701..1100];
        let spring = |a, b| LinearSpring {
            nodes: [a, b, NO_NODE, NO_NODE],
            weights: [1.0, -1.0, 0.0, 0.0],
            hessian: Matrix3::identity(),
            force: Vector::zeros(),
        };
        let mut springs = LinearSprings::new(1100);
        springs.set(|all| all.extend([spring(800, 1), spring(5, 9), spring(700, NO_NODE)]));
        let parts = Parts::new(&components, &springs);
        assert_eq!((parts.count(), parts.of_components()), (3, &[0, 1, 2, 0][..]));
        let pieces =
            |chunk| parts.of_chunk(chunk).iter().map(|p| (p.nodes.clone(), p.part)).collect::<Vec<_>>();
        assert_eq!(pieces(0), [(0..3, 0), (3..512, 1)]);
        assert_eq!(pieces(1), [(512..700, 1), (700..701, 2), (701..1024, 0)]);
        assert_eq!(pieces(2), [(1024..1100, 0)]);
        let ones = vec![Vector::x(); 1100];
        assert_eq!(parts.dot(&ones, &ones), [402.0, 697.0, 1.0]);
        let mut y = ones.clone();
        parts.add_scaled(&mut y, &[0.0, 1.0, -1.0], &ones);
        assert_eq!((y[2].x, y[3].x, y[700].x, y[701].x), (1.0, 2.0, 0.0, 1.0));
        assert_eq!(Parts::whole(1100).dot(&ones, &y), [402.0 + 2.0 * 697.0]);
    }
}
