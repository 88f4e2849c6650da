//! The preconditioner of a linear solve: block-Jacobi plus rigid motions of groups on every level of a hierarchy.
//!
//! It is a multilevel additive Schwarz method: on each level the space is divided into domains of eight groups, the Galerkin
//! matrix P^T A P of a domain is inverted, and the corrections of all levels are added (J. Xu, "Iterative Methods by Space
//! Decomposition and Subspace Correction", SIAM Review 1992; B. Wu, Z. Wang and H. Wang, "A GPU-Based Multilevel Additive
//! Schwarz Preconditioner for Cloth and Deformable Body Simulation", SIGGRAPH 2022, whose groups only shift). It is made in
//! double precision and rounded at the end.

use super::inverse::inverse;
use super::layout::{CHILDREN, DOMAIN_UNKNOWNS, PATCH_SLOTS, PatchSlot};
use super::patches::Patches;
use super::rigid::{Link, Mode, Rigid};
use bowknot_dynamics::LinearSystem;
use bowknot_geometry::Vector;
use nalgebra::{Matrix3, Matrix6};
use rayon::prelude::*;

/// Eight groups that move as rigid bodies.
#[derive(Clone, Debug)]
pub struct Domain {
    /// Inverse of the matrix of their motions, three shifts and three spins each; zero for motions that move nothing.
    pub inverse: Vec<f32>,
    /// From the center of all eight to that of each, over the size of all; the ratio of the sizes.
    pub links: [[f32; 4]; CHILDREN],
}

/// What the device reads.
#[derive(Debug, Default)]
pub struct Multilevel {
    pub slots: Vec<PatchSlot>,
    /// Of the patches with groups, then of the groups of eight of them, and so on; see [`Patches::levels`].
    pub domains: Vec<Domain>,
}

/// Spins about axes with less than this share of the largest moment of inertia are held: a strand that is straight hardly
/// moves when it spins about itself, and in single precision the force on that spin is rounding.
const SMALLEST_MOMENT: f64 = 1e-4;

/// Center and size of a group, and the mean of o o^T over the arms o of its nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Frame {
    center: Vector,
    size: f64,
    moment: Matrix3<f64>,
}

impl Frame {
    fn of_point(center: Vector) -> Self {
        Self { center, ..Self::default() }
    }

    /// Of a group of groups, or of points.
    fn around(parts: &[Self]) -> Self {
        if parts.is_empty() {
            return Self { size: 1.0, ..Self::default() };
        }
        let count = parts.len() as f64;
        let center = parts.iter().map(|part| part.center).sum::<Vector>() / count;
        let size = parts.iter().map(|part| (part.center - center).norm() + part.size).fold(0.0, f64::max);
        let mut frame = Self { center, size: if size > 0.0 { size } else { 1.0 }, ..Self::default() };
        for part in parts {
            let Link { way, ratio } = frame.link(part);
            frame.moment += (way * way.transpose() + part.moment * (ratio * ratio)) / count;
        }
        frame
    }

    fn link(&self, child: &Self) -> Link {
        Link { way: (child.center - self.center) / self.size, ratio: child.size / self.size }
    }

    /// The sum of a a^T over the axes a about which spins are held.
    fn held_spins(&self) -> Matrix3<f64> {
        let eigen = (Matrix3::from_diagonal_element(self.moment.trace()) - self.moment).symmetric_eigen();
        let smallest = SMALLEST_MOMENT * eigen.eigenvalues.max();
        let is_held = |k: &usize| eigen.eigenvalues[*k] <= smallest;
        (0..3)
            .filter(is_held)
            .map(|k| eigen.eigenvectors.column(k))
            .fold(Matrix3::zeros(), |sum, axis| sum + axis * axis.transpose())
    }
}

/// Where a node stands in the hierarchy.
#[derive(Clone, Copy, Debug)]
struct Place {
    patch: u32,
    group: u32,
    /// From the centers of its group and of its patch, over their sizes.
    arm: Vector,
    patch_arm: Vector,
}

/// Rows of the Galerkin matrix of a level: couplings of a group with others, by group.
type Row = Vec<(u32, Matrix6<f64>)>;
type Rows = Vec<Row>;

impl Multilevel {
    /// Builds the preconditioner of a system.
    pub fn new(system: &LinearSystem<'_>, patches: &Patches) -> Self {
        let frames: Vec<([Frame; CHILDREN], Frame)> =
            (0..patches.grouped).map(|k| frames_of(system, patches.slots_of(k))).collect();
        let mut places: Vec<Option<Place>> = vec![None; system.free.len()];
        for (k, (groups, patch)) in frames.iter().enumerate() {
            for (slot, node) in patches.slots_of(k).iter().enumerate() {
                let (Some(node), group) = (*node, slot / CHILDREN) else { continue };
                let x = system.positions[node as usize];
                places[node as usize] = Some(Place {
                    patch: k as u32,
                    group: group as u32,
                    arm: (x - groups[group].center) / groups[group].size,
                    patch_arm: (x - patch.center) / patch.size,
                });
            }
        }
        let mut slots: Vec<PatchSlot> =
            patches.slots.par_iter().map(|node| slot_of(system, &places, *node)).collect();

        let parts: Vec<(Vec<f64>, Row)> =
            (0..patches.grouped).into_par_iter().map(|k| patch_matrix(system, patches, &places, k)).collect();
        let (matrices, mut rows): (Vec<Vec<f64>>, Rows) = parts.into_iter().unzip();
        let invert = |(matrix, (groups, parent)): (Vec<f64>, &([Frame; CHILDREN], Frame))| {
            domain(matrix, groups, parent)
        };
        let mut domains: Vec<Domain> = matrices.into_par_iter().zip(&frames).map(invert).collect();
        for (patch, domain) in slots.chunks_mut(PATCH_SLOTS).zip(&domains) {
            for (group, [x, y, z, ratio]) in patch.chunks_mut(CHILDREN).zip(domain.links) {
                (group[0].link, group[1].link) = ([x, y], [z, ratio]);
            }
        }

        let mut level: Vec<Frame> = frames.iter().map(|(_, patch)| *patch).collect();
        for _ in &patches.levels {
            let parents: Vec<Frame> = level.chunks(CHILDREN).map(Frame::around).collect();
            domains.par_extend(
                parents
                    .par_iter()
                    .zip(level.par_chunks(CHILDREN))
                    .enumerate()
                    .map(|(k, (parent, children))| domain(domain_matrix(&rows, k), children, parent)),
            );
            let link = |child: usize| parents[child / CHILDREN].link(&level[child]);
            rows = coarsened(&rows, parents.len(), link);
            level = parents;
        }
        Self { slots, domains }
    }
}

fn frames_of(system: &LinearSystem<'_>, slots: &[Option<u32>]) -> ([Frame; CHILDREN], Frame) {
    let points = |slots: &[Option<u32>]| -> Vec<Frame> {
        slots.iter().flatten().map(|&node| Frame::of_point(system.positions[node as usize])).collect()
    };
    let groups = std::array::from_fn(|g| Frame::around(&points(&slots[CHILDREN * g..][..CHILDREN])));
    (groups, Frame::around(&points(slots)))
}

fn slot_of(system: &LinearSystem<'_>, places: &[Option<Place>], node: Option<u32>) -> PatchSlot {
    let Some(node) = node else { return PatchSlot::EMPTY };
    let factors = factors_of_block(system, node as usize);
    let arm = places[node as usize].map_or([0.0; 3], |place| <[f64; 3]>::from(place.arm).map(|x| x as f32));
    PatchSlot { node, factors, arm, link: [0.0; 2] }
}

/// The diagonal block of a node as a product L D L^T, see [`PatchSlot::factors`].
fn factors_of_block(system: &LinearSystem<'_>, node: usize) -> [f32; 6] {
    // The smallest eigenvalue is at least the inertia of the node: the block is singular only if the input is not finite.
    // Conjugate gradients detect that.
    let m = system.diagonal_with_springs(node);
    let (xy, xz) = (m[(1, 0)] / m[(0, 0)], m[(2, 0)] / m[(0, 0)]);
    let second = m[(1, 1)] - xy * m[(1, 0)];
    let rest = m[(2, 1)] - xy * m[(2, 0)];
    let yz = rest / second;
    let third = m[(2, 2)] - xz * m[(2, 0)] - yz * rest;
    [xy, xz, yz, 1.0 / m[(0, 0)], 1.0 / second, 1.0 / third].map(|number| number as f32)
}

/// Calls `visit` with every entry of row `i` of H.
fn visit_row(system: &LinearSystem<'_>, i: usize, visit: &mut dyn FnMut(usize, &Matrix3<f64>)) {
    visit(i, &system.diagonal_with_springs(i));
    system.blocks.row(i).for_each(|(j, block)| visit(j, block));
    system.scalars.row(i).for_each(|(j, value)| visit(j, &Matrix3::from_diagonal_element(*value)));
    for &(spring, weight) in system.springs_of(i) {
        let spring = &system.springs[spring as usize];
        for (&j, other) in spring.nodes.iter().zip(spring.weights) {
            if j != u32::MAX && j as usize != i {
                visit(j as usize, &(spring.hessian * (weight * other)));
            }
        }
    }
}

/// The matrix of the groups of patch `k`, and the row of the patch in that of all patches.
fn patch_matrix(
    system: &LinearSystem<'_>,
    patches: &Patches,
    places: &[Option<Place>],
    k: usize,
) -> (Vec<f64>, Row) {
    let mut matrix = vec![0.0; DOMAIN_UNKNOWNS * DOMAIN_UNKNOWNS];
    let mut row: Row = Vec::new();
    for &node in patches.slots_of(k).iter().flatten() {
        let Some(place) = places[node as usize] else { continue };
        let mut on_groups: [Option<Rigid>; CHILDREN] = [None; CHILDREN];
        let mut on_patches: Vec<(u32, Rigid)> = Vec::new();
        visit_row(system, node as usize, &mut |other, block| {
            let Some(other) = places[other] else { return };
            if other.patch as usize == k {
                on_groups[other.group as usize].get_or_insert_default().add(block, &other.arm);
            }
            entry(&mut on_patches, other.patch).add(block, &other.patch_arm);
        });
        for (g, sum) in on_groups.iter().enumerate() {
            if let Some(sum) = sum {
                add_block(&mut matrix, place.group as usize, g, &sum.restricted(&place.arm));
            }
        }
        for (other, sum) in on_patches {
            *entry(&mut row, other) += sum.restricted(&place.patch_arm);
        }
    }
    (matrix, row)
}

/// The entry of a key in a short list, made if it is missing.
fn entry<T: Default>(list: &mut Vec<(u32, T)>, key: u32) -> &mut T {
    let place = list.iter().position(|(k, _)| *k == key).unwrap_or_else(|| {
        list.push((key, T::default()));
        list.len() - 1
    });
    &mut list[place].1
}

fn add_block(matrix: &mut [f64], a: usize, b: usize, block: &Matrix6<f64>) {
    for i in 0..6 {
        for j in 0..6 {
            matrix[DOMAIN_UNKNOWNS * (6 * a + i) + 6 * b + j] += block[(i, j)];
        }
    }
}

/// The matrix of the eight groups of domain `k`.
fn domain_matrix(rows: &Rows, k: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; DOMAIN_UNKNOWNS * DOMAIN_UNKNOWNS];
    for (a, row) in rows.iter().skip(CHILDREN * k).take(CHILDREN).enumerate() {
        for (other, block) in row.iter().filter(|(other, _)| *other as usize / CHILDREN == k) {
            add_block(&mut matrix, a, *other as usize % CHILDREN, block);
        }
    }
    matrix
}

/// The rows of the next level.
fn coarsened(rows: &Rows, parents: usize, link: impl Fn(usize) -> Link) -> Rows {
    let mut coarse: Rows = vec![Vec::new(); parents];
    for (child, row) in rows.iter().enumerate() {
        let own = Mode::new(&link(child));
        for (other, block) in row {
            let theirs = Mode::new(&link(*other as usize));
            *entry(&mut coarse[child / CHILDREN], other / CHILDREN as u32) +=
                own.matrix().transpose() * block * theirs.matrix();
        }
    }
    coarse
}

/// A domain from the matrix of its groups.
fn domain(mut matrix: Vec<f64>, groups: &[Frame], parent: &Frame) -> Domain {
    for (g, group) in groups.iter().enumerate() {
        let diagonal = |k: usize| matrix[(DOMAIN_UNKNOWNS + 1) * (6 * g + k)];
        let stiffness: f64 = (0..6).map(diagonal).sum();
        let held = group.held_spins() * stiffness;
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            matrix[DOMAIN_UNKNOWNS * (6 * g + 3 + i) + 6 * g + 3 + j] += held[(i, j)];
        }
    }
    let inverse = inverse(matrix);
    let mut links = [[0.0; 4]; CHILDREN];
    for (link, group) in links.iter_mut().zip(groups) {
        let Link { way, ratio } = parent.link(group);
        *link = [way.x as f32, way.y as f32, way.z as f32, ratio as f32];
    }
    Domain { inverse: inverse.iter().map(|number| *number as f32).collect(), links }
}
