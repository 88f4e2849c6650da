//! Blocks of nodes: those of one component within a window of 256. The device sums over blocks, the host over
//! the blocks of each component.

use super::layout::WINDOW;
use bowknot_dynamics::LinearSpring;
use bowknot_geometry::Vector;
use std::ops::Range;

/// The blocks of a model.
#[derive(Debug, Default)]
pub struct Blocks {
    /// The block of each node.
    pub of_nodes: Vec<u32>,
    /// The component of each node.
    component_of: Vec<u32>,
    /// The blocks of each component.
    of_components: Vec<Range<usize>>,
}

impl Blocks {
    /// Divides components, which follow each other.
    pub fn new(components: &[Range<u32>], nodes: usize) -> Self {
        let mut blocks =
            Self { of_nodes: vec![0; nodes], component_of: vec![0; nodes], of_components: Vec::new() };
        let mut count = 0;
        for (index, component) in components.iter().enumerate() {
            let first = count;
            let mut start = component.start as usize;
            while start < component.end as usize {
                let end = (start / WINDOW * WINDOW + WINDOW).min(component.end as usize);
                blocks.of_nodes[start..end].fill(count as u32);
                blocks.component_of[start..end].fill(index as u32);
                (start, count) = (end, count + 1);
            }
            blocks.of_components.push(first..count);
        }
        blocks
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.of_components.last().map_or(0, |blocks| blocks.end)
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.of_components.len()
    }

    /// The sums over components of what a device has summed over blocks, four numbers each.
    pub fn sums(&self, words: &[u32]) -> impl Iterator<Item = [f64; 4]> {
        let number = |block: usize, k: usize| f64::from(f32::from_bits(words[4 * block + k]));
        self.of_components
            .iter()
            .map(move |blocks| std::array::from_fn(|k| blocks.clone().map(|b| number(b, k)).sum()))
    }

    /// The sums over components of a number per node.
    pub fn sums_of(&self, values: &[Vector]) -> Vec<Vector> {
        let mut sums = vec![Vector::zeros(); self.components()];
        self.component_of.iter().zip(values).for_each(|(c, value)| sums[*c as usize] += value);
        sums
    }

    /// The forces of springs on components [N].
    pub fn spring_forces(&self, springs: &[LinearSpring]) -> Vec<Vector> {
        let mut sums = vec![Vector::zeros(); self.components()];
        for spring in springs {
            for (node, weight) in spring.nodes.iter().zip(spring.weights) {
                if let Some(component) = self.component_of.get(*node as usize) {
                    sums[*component as usize] += spring.force * weight;
                }
            }
        }
        sums
    }

    /// What each component has, once per block.
    pub fn spread(&self, values: &[Vector]) -> Vec<[f32; 4]> {
        let entry = |(value, blocks): (&Vector, &Range<usize>)| {
            let single = [value.x as f32, value.y as f32, value.z as f32, 0.0];
            std::iter::repeat_n(single, blocks.len())
        };
        values.iter().zip(&self.of_components).flat_map(entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Blocks;

    #[test]
    fn blocks_stay_in_their_component_and_window() {
        let blocks = Blocks::new(&[0..3, 3..600, 600..601, 601..1024], 1024);
        assert_eq!(blocks.of_components, [0..1, 1..4, 4..5, 5..7]);
        assert_eq!((blocks.count(), blocks.of_nodes[255], blocks.of_nodes[256]), (7, 1, 2));
        assert!(blocks.of_nodes.is_sorted() && blocks.of_nodes[1023] == 6);
        let words: Vec<u32> = (0..28).map(|k| (k as f32).to_bits()).collect();
        let sums: Vec<[f64; 4]> = blocks.sums(&words).collect();
        assert_eq!(sums[1], [24.0, 27.0, 30.0, 33.0]);
        assert_eq!(Blocks::new(&[], 0).count(), 0);
    }
}
