//! A part of a collision problem: some of its elements, and what they need.

use crate::recording::filters;
use crate::recording::states::States;
use bowknot_geometry::Point;
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{ContactSide, PairFriction};
use std::collections::BTreeSet;

/// No body, half-space or vertex of the part.
const DROPPED: u32 = u32::MAX;

impl States {
    /// Number of elements: triangles, strand edges, particles and half-spaces, numbered in this order.
    pub fn element_count(&self) -> usize {
        self.triangles.len() + self.strands.len() + self.particles.len() + self.half_spaces.len()
    }

    /// Vertices of an element; none of a half-space.
    pub(super) fn element(&self, index: u32) -> &[u32] {
        let index = index as usize;
        let strand = index.wrapping_sub(self.triangles.len());
        let particle = strand.wrapping_sub(self.strands.len());
        if let Some(triangle) = self.triangles.get(index) {
            triangle
        } else if let Some(strand) = self.strands.get(strand) {
            strand
        } else {
            self.particles.get(particle).map_or(&[], std::slice::from_ref)
        }
    }

    /// What an element belongs to: its body, or a number above those of bodies for each half-space.
    pub(super) fn owner(&self, index: u32) -> u32 {
        let bodies = self.body.iter().max().map_or(0, |&b| b + 1);
        let meshes = (self.element_count() - self.half_spaces.len()) as u32;
        match self.element(index).first() {
            Some(&v) => self.body[v as usize],
            None => bodies + (index - meshes),
        }
    }

    /// Distance of an element to a place [m]. A half-space is near everything.
    pub(super) fn distance(&self, index: u32, place: &Point) -> f64 {
        let vertices = self.element(index).iter();
        let nearest = vertices.map(|&v| (self.x[v as usize] - place).norm()).reduce(f64::min);
        nearest.unwrap_or(0.0)
    }

    /// The problem with these elements alone, ascending, and the vertices that they name. Vertices, bodies
    /// and half-spaces are numbered anew in the same order.
    pub fn part(&self, elements: &[u32]) -> Self {
        let used: BTreeSet<u32> = elements.iter().flat_map(|&e| self.element(e)).copied().collect();
        let vertices: Vec<u32> = used.into_iter().collect();
        let old_bodies: BTreeSet<u32> = vertices.iter().map(|&v| self.body[v as usize]).collect();
        let old_bodies: Vec<u32> = old_bodies.into_iter().collect();
        let first_plane = (self.element_count() - self.half_spaces.len()) as u32;
        let planes: Vec<u32> = elements.iter().filter_map(|&e| e.checked_sub(first_plane)).collect();

        let vertex = numbers(&vertices, self.x.len());
        let body = numbers(&old_bodies, self.body.iter().max().map_or(0, |&b| b as usize + 1));
        let plane = numbers(&planes, self.half_spaces.len());
        let (mut triangles, mut strands, mut particles) = (Vec::new(), Vec::new(), Vec::new());
        for &element in elements {
            let renamed = |v: &u32| vertex[*v as usize];
            match *self.element(element) {
                [a, b, c] => triangles.push([a, b, c].map(|v| renamed(&v))),
                [a, b] => strands.push([a, b].map(|v| renamed(&v))),
                [a] => particles.push(renamed(&a)),
                _ => {}
            }
        }
        let side = |side: ContactSide| match side {
            ContactSide::Body(b) => Some(body[b as usize]).filter(|&b| b != DROPPED).map(ContactSide::Body),
            ContactSide::HalfSpace(h) => {
                Some(plane[h as usize]).filter(|&h| h != DROPPED).map(ContactSide::HalfSpace)
            }
        };
        let pair = |pair: &PairFriction| {
            Some(PairFriction {
                sides: [side(pair.sides[0])?, side(pair.sides[1])?],
                friction: pair.friction,
            })
        };
        let kept_edge = |edge: &DistanceLimit| {
            let renamed = edge.vertices.map(|v| vertex.get(v as usize).copied().unwrap_or(DROPPED));
            (!renamed.contains(&DROPPED)).then_some(DistanceLimit { vertices: renamed, limit: edge.limit })
        };
        Self {
            x: pick(&self.x, &vertices),
            y: pick(&self.y, &vertices),
            triangles,
            strands,
            particles,
            rest: pick(&self.rest, &vertices),
            masses: pick(&self.masses, &vertices),
            fixed: pick(&self.fixed, &vertices),
            obstacle: pick(&self.obstacle, &vertices),
            body: vertices.iter().map(|&v| body[self.body[v as usize] as usize]).collect(),
            half_spaces: pick(&self.half_spaces, &planes),
            time_step: self.time_step,
            body_contacts: pick(&self.body_contacts, &old_bodies),
            half_space_contacts: pick(&self.half_space_contacts, &planes),
            pair_frictions: self.pair_frictions.iter().filter_map(pair).collect(),
            groups: pick(&self.groups, &vertices),
            start: pick(&self.start, &vertices),
            known: pick(&self.known, &vertices),
            // Elements have other numbers in a part.
            carried: Vec::new(),
            yielding: self.yielding.iter().filter_map(kept_edge).collect(),
            filters: filters::kept(pick(&self.filters, &old_bodies)),
        }
    }
}

/// The entries of `of` with these indices; none if there are no entries at all.
fn pick<T: Clone>(of: &[T], indices: &[u32]) -> Vec<T> {
    if of.is_empty() { Vec::new() } else { indices.iter().map(|&i| of[i as usize].clone()).collect() }
}

/// The new number of each of `count` things, of which these are kept.
fn numbers(kept: &[u32], count: usize) -> Vec<u32> {
    let mut numbers = vec![DROPPED; count];
    kept.iter().enumerate().for_each(|(new, &old)| numbers[old as usize] = new as u32);
    numbers
}
