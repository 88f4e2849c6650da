//! Which groups of the preconditioner are coupled, on every level: what the host prepares for a set of free
//! nodes.

use super::layout::{Chunk, Part};
use crate::layout::NONE;
use crate::linear::{CHILDREN, PATCH_SLOTS, Patches};
use bowknot_dynamics::{ElementModel, LinearSpring};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The groups, and their pairs that elements join. Level 0 has the groups of patches, level 1 the patches,
/// and so on.
#[derive(Debug, Default)]
pub struct Hierarchy {
    pub levels: Vec<Level>,
    /// Slot of each node that is in a group; [`NONE`] for the others.
    pub places: Vec<u32>,
    /// Pairs (a, b) of groups of the levels 0 and 1 with a <= b, as indices within their level.
    pub pairs: Vec<[u32; 2]>,
    /// Of each pair of any level its first part, the number of parts, the frames of both groups.
    pub sums: Vec<[u32; 4]>,
    pub parts: Vec<Part>,
    /// The pairs of each domain: 64 per domain.
    pub tables: Vec<u32>,
    /// Number of frames: the groups of all levels, and the last domain.
    pub frames: usize,
}

/// A level.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Slots of a group.
    pub width: usize,
    pub groups: usize,
    pub first_frame: usize,
    pub pairs: usize,
    pub first_pair: usize,
    pub domains: usize,
    pub first_domain: usize,
}

impl Hierarchy {
    pub fn new(model: &ElementModel, patches: &Patches) -> Self {
        let mut hierarchy = Self { places: vec![NONE; model.rest.len()], ..Self::default() };
        if patches.grouped == 0 {
            return hierarchy;
        }
        for (slot, node) in patches.slots.iter().enumerate().take(PATCH_SLOTS * patches.grouped) {
            if let Some(node) = node {
                hierarchy.places[*node as usize] = slot as u32;
            }
        }
        let mut counts = vec![CHILDREN * patches.grouped];
        counts.extend(&patches.levels);
        let mut before: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for (index, &groups) in counts.iter().enumerate() {
            let first_pair = hierarchy.sums.len();
            let width = if index == 0 { CHILDREN } else { PATCH_SLOTS << (3 * (index - 1)) };
            let level = Level {
                width,
                groups,
                first_frame: hierarchy.frames,
                pairs: 0,
                first_pair,
                domains: groups.div_ceil(CHILDREN),
                first_domain: hierarchy.tables.len() / 64,
            };
            before = if index < 2 {
                hierarchy.add_pairs_of_nodes(model, &level, index == 0)
            } else {
                hierarchy.add_pairs_of_groups(&level, &before)
            };
            hierarchy.frames += groups;
            hierarchy.fill_tables(&level, &before);
            hierarchy.levels.push(Level { pairs: before.len(), ..level });
        }
        hierarchy.frames += 1;
        hierarchy
    }

    /// Adds the pairs of groups that elements join, those within a domain only if `within`. Returns their
    /// places.
    fn add_pairs_of_nodes(
        &mut self,
        model: &ElementModel,
        level: &Level,
        within: bool,
    ) -> BTreeMap<[u32; 2], u32> {
        let mut pairs = BTreeMap::new();
        for (i, place) in self.places.iter().enumerate().filter(|(_, place)| **place != NONE) {
            let a = place / level.width as u32;
            pairs.insert([a, a], 0);
            let blocks = &model.columns[model.starts[i] as usize..model.starts[i + 1] as usize];
            let scalars =
                &model.scalar_columns[model.scalar_starts[i] as usize..model.scalar_starts[i + 1] as usize];
            for &j in blocks.iter().chain(scalars) {
                let other = self.places[j as usize];
                let b = other / level.width as u32;
                let is_near = !within || a as usize / CHILDREN == b as usize / CHILDREN;
                if other != NONE && a < b && is_near {
                    pairs.insert([a, b], 0);
                }
            }
        }
        for (pair, place) in &mut pairs {
            *place = self.sums.len() as u32;
            self.pairs.push(*pair);
            self.sums.push([0; 4]);
        }
        pairs
    }

    /// Adds the pairs of groups of groups from those of the level before.
    fn add_pairs_of_groups(
        &mut self,
        level: &Level,
        before: &BTreeMap<[u32; 2], u32>,
    ) -> BTreeMap<[u32; 2], u32> {
        let children = self.levels[self.levels.len() - 1].first_frame as u32;
        let mut sums: BTreeMap<[u32; 2], Vec<Part>> = BTreeMap::new();
        for (&[a, b], &block) in before {
            let parents = [a, b].map(|group| group / CHILDREN as u32);
            let both = u32::from(a != b && parents[0] == parents[1]);
            sums.entry(parents).or_default().push(Part { block, a: children + a, b: children + b, both });
        }
        let mut pairs = BTreeMap::new();
        for (pair, parts) in sums {
            pairs.insert(pair, self.sums.len() as u32);
            let [a, b] = pair.map(|group| level.first_frame as u32 + group);
            self.sums.push([self.parts.len() as u32, parts.len() as u32, a, b]);
            self.parts.extend(parts);
        }
        pairs
    }

    fn fill_tables(&mut self, level: &Level, pairs: &BTreeMap<[u32; 2], u32>) {
        self.tables.resize(64 * (level.first_domain + level.domains), NONE);
        for (pair, place) in pairs {
            let [a, b] = pair.map(|group| group as usize);
            if a / CHILDREN == b / CHILDREN {
                let table = 64 * (level.first_domain + a / CHILDREN);
                self.tables[table + CHILDREN * (a % CHILDREN) + b % CHILDREN] = *place;
            }
        }
    }

    /// Number of domains of all levels.
    pub fn domains(&self) -> usize {
        self.tables.len() / 64
    }

    /// The springs of each domain, in chunks.
    pub fn touching(&self, springs: &[LinearSpring]) -> Touching {
        let place = |node: u32, weight: f64| {
            if node == NONE || weight == 0.0 { NONE } else { self.places[node as usize] }
        };
        let places: Vec<[u32; 4]> = springs
            .iter()
            .map(|spring| std::array::from_fn(|k| place(spring.nodes[k], spring.weights[k])))
            .collect();
        let lists: Vec<[Vec<u32>; 2]> =
            self.levels.par_iter().map(|level| touching_level(level, &places)).collect();
        let mut starts = Vec::with_capacity(self.domains() + 1);
        let mut chunks: Vec<Chunk> = Vec::new();
        let mut before = 0;
        for (level, [ends, _]) in self.levels.iter().zip(&lists) {
            let mut begin = before;
            for (group, end) in (0..).step_by(CHILDREN).zip(ends) {
                starts.push(chunks.len() as u32);
                let end = before + end;
                while begin < end {
                    let next = end.min(begin + CHUNK);
                    let (width, frame) = (level.width as u32, level.first_frame as u32 + group);
                    chunks.push(Chunk { begin, end: next, width, group, frame });
                    begin = next;
                }
            }
            before = begin;
        }
        starts.push(chunks.len() as u32);
        let (first, count) = (starts.len(), chunks.len());
        let lists_begin = (first + size_of::<Chunk>() / 4 * count) as u32;
        for chunk in &mut chunks {
            chunk.begin += lists_begin;
            chunk.end += lists_begin;
        }
        let mut words = starts;
        words.extend_from_slice(bytemuck::cast_slice(&chunks));
        lists.iter().for_each(|[_, springs]| words.extend(springs));
        Touching { words, first, chunks: count }
    }
}

/// Most springs of a chunk.
const CHUNK: u32 = 256;

/// The springs that touch each domain.
#[derive(Debug)]
pub struct Touching {
    /// Where the chunks of each domain begin, then the chunks, then the springs.
    pub words: Vec<u32>,
    /// Where the chunks begin, in words.
    pub first: usize,
    pub chunks: usize,
}

/// Where the lists of springs of the domains of a level end, and the lists: ascending springs, each once per
/// domain. `places` are the slots of the nodes of each spring.
fn touching_level(level: &Level, places: &[[u32; 4]]) -> [Vec<u32>; 2] {
    // Domains have a power of two of slots.
    let bits = (level.width * CHILDREN).trailing_zeros();
    let mut pairs: Vec<[u32; 2]> = Vec::with_capacity(2 * places.len());
    let mut ends = vec![0u32; level.domains];
    for (spring, places) in (0..).zip(places) {
        let first = pairs.len();
        for &place in places.iter().filter(|place| **place != NONE) {
            let domain = (u64::from(place) >> bits) as u32;
            if !pairs[first..].iter().any(|pair| pair[0] == domain) {
                pairs.push([domain, spring]);
                ends[domain as usize] += 1;
            }
        }
    }
    // A counting sort.
    let mut sum = 0;
    let mut next: Vec<u32> = Vec::with_capacity(level.domains);
    for end in &mut ends {
        next.push(sum);
        sum += *end;
        *end = sum;
    }
    let mut springs = vec![0; pairs.len()];
    for [domain, spring] in pairs {
        let place = &mut next[domain as usize];
        springs[*place as usize] = spring;
        *place += 1;
    }
    [ends, springs]
}
