//! The preconditioner of a linear solve: block-Jacobi plus rigid motions of groups on every level of a hierarchy.
//!
//! It is a multilevel additive Schwarz method: on each level the space is divided into domains of eight groups, the Galerkin
//! matrix P^T A P of a domain is inverted, and the corrections of all levels are added (J. Xu, "Iterative Methods by Space
//! Decomposition and Subspace Correction", SIAM Review 1992; B. Wu, Z. Wang and H. Wang, "A GPU-Based Multilevel Additive
//! Schwarz Preconditioner for Cloth and Deformable Body Simulation", SIGGRAPH 2022, whose groups only shift). It is made in
//! double precision and rounded at the end.

use super::layout::{CHILDREN, DOMAIN_UNKNOWNS, Domain, PatchSlot};
use super::patches::Patches;
use super::rigid::{Link, Mode, Rigid};
use bowknot_dynamics::LinearSystem;
use bowknot_geometry::Vector;
use nalgebra::{Matrix3, Matrix6};
use rayon::prelude::*;

/// A pivot at most this share of its diagonal entry counts as zero: the motion moves nothing that others do not.
const ZERO_PIVOT: f64 = 1e-11;

/// What the device reads.
#[derive(Debug, Default)]
pub struct Multilevel {
    pub slots: Vec<PatchSlot>,
    /// Of the patches with groups, then of the groups of eight of them, and so on; see [`Patches::levels`].
    pub domains: Vec<Domain>,
}

/// Center and size of a group.
#[derive(Clone, Copy, Debug, Default)]
struct Frame {
    center: Vector,
    size: f64,
}

impl Frame {
    /// Around points with radii.
    fn around(points: &[(Vector, f64)]) -> Self {
        if points.is_empty() {
            return Self { center: Vector::zeros(), size: 1.0 };
        }
        let center = points.iter().map(|(point, _)| point).sum::<Vector>() / points.len() as f64;
        let size = points.iter().map(|(point, radius)| (point - center).norm() + radius).fold(0.0, f64::max);
        Self { center, size: if size > 0.0 { size } else { 1.0 } }
    }

    fn link(&self, child: &Self) -> Link {
        Link { way: (child.center - self.center) / self.size, ratio: child.size / self.size }
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
        let slots = patches.slots.par_iter().map(|node| slot_of(system, &places, *node)).collect();

        let parts: Vec<(Vec<f64>, Row)> =
            (0..patches.grouped).into_par_iter().map(|k| patch_matrix(system, patches, &places, k)).collect();
        let (matrices, mut rows): (Vec<Vec<f64>>, Rows) = parts.into_iter().unzip();
        let invert = |(matrix, links): (Vec<f64>, [Link; CHILDREN])| domain(matrix, &links);
        let links = frames.iter().map(|(groups, patch)| groups.map(|group| patch.link(&group)));
        let whole: Vec<(Vec<f64>, [Link; CHILDREN])> = matrices.into_iter().zip(links).collect();
        let mut domains: Vec<Domain> = whole.into_par_iter().map(invert).collect();

        let mut level: Vec<Frame> = frames.iter().map(|(_, patch)| *patch).collect();
        for _ in &patches.levels {
            let parents: Vec<Frame> = level
                .chunks(CHILDREN)
                .map(|children| {
                    let points: Vec<(Vector, f64)> = children.iter().map(|f| (f.center, f.size)).collect();
                    Frame::around(&points)
                })
                .collect();
            let link = |child: usize| parents[child / CHILDREN].link(&level[child]);
            let whole: Vec<(Vec<f64>, [Link; CHILDREN])> = (0..parents.len())
                .map(|k| {
                    let links = std::array::from_fn(|m| {
                        let child = CHILDREN * k + m;
                        if child < level.len() { link(child) } else { Link::default() }
                    });
                    (domain_matrix(&rows, k), links)
                })
                .collect();
            domains.par_extend(whole.into_par_iter().map(invert));
            rows = coarsened(&rows, parents.len(), link);
            level = parents;
        }
        Self { slots, domains }
    }
}

fn frames_of(system: &LinearSystem<'_>, slots: &[Option<u32>]) -> ([Frame; CHILDREN], Frame) {
    let points = |slots: &[Option<u32>]| -> Vec<(Vector, f64)> {
        slots.iter().flatten().map(|&node| (system.positions[node as usize], 0.0)).collect()
    };
    let groups = std::array::from_fn(|g| Frame::around(&points(&slots[CHILDREN * g..][..CHILDREN])));
    (groups, Frame::around(&points(slots)))
}

fn slot_of(system: &LinearSystem<'_>, places: &[Option<Place>], node: Option<u32>) -> PatchSlot {
    let Some(node) = node else { return PatchSlot::EMPTY };
    // The smallest eigenvalue is at least the inertia of the node: the block is singular only if the input is not finite.
    // Conjugate gradients detect that.
    let block = system.diagonal_with_springs(node as usize);
    let m = block.try_inverse().unwrap_or_else(Matrix3::identity);
    let half = |i: usize, j: usize| (0.5 * (m[(i, j)] + m[(j, i)])) as f32;
    let inverse = [half(0, 0), half(0, 1), half(0, 2), half(1, 1), half(1, 2), half(2, 2)];
    let arm = places[node as usize].map_or([0.0; 3], |place| <[f64; 3]>::from(place.arm).map(|x| x as f32));
    PatchSlot { node, inverse, arm, padding: [0; 2] }
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
        let mut on_groups = [Rigid::default(); CHILDREN];
        let mut on_patches: Vec<(u32, Rigid)> = Vec::new();
        visit_row(system, node as usize, &mut |other, block| {
            let Some(other) = places[other] else { return };
            if other.patch as usize == k {
                on_groups[other.group as usize].add(block, &other.arm);
            }
            entry(&mut on_patches, other.patch).add(block, &other.patch_arm);
        });
        for (g, sum) in on_groups.iter().enumerate() {
            add_block(&mut matrix, place.group as usize, g, &sum.restricted(&place.arm));
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

/// A domain from its matrix and the links of its groups.
fn domain(matrix: Vec<f64>, links: &[Link; CHILDREN]) -> Domain {
    let inverse = inverse(matrix);
    Domain {
        inverse: std::array::from_fn(|k| inverse[k] as f32),
        links: links.map(|link| [link.way.x as f32, link.way.y as f32, link.way.z as f32, link.ratio as f32]),
    }
}

/// The inverse of a symmetric positive semi-definite matrix; rows and columns of pivots that vanish are zero.
fn inverse(mut l: Vec<f64>) -> Vec<f64> {
    const N: usize = DOMAIN_UNKNOWNS;
    // Cholesky, row by row; a dropped unknown has a zero row in L and no pivot.
    let mut pivots = [0.0f64; N];
    for i in 0..N {
        let diagonal = l[N * i + i];
        for j in 0..=i {
            let (head, tail) = l.split_at_mut(N * i);
            let (mine, theirs) =
                if j < i { (&mut tail[..N], &head[N * j..N * j + N]) } else { (&mut tail[..N], &[][..]) };
            if j < i {
                let sum: f64 = (0..j).map(|k| mine[k] * theirs[k]).sum();
                mine[j] = if pivots[j] > 0.0 { (mine[j] - sum) / pivots[j] } else { 0.0 };
            } else {
                let rest = diagonal - (0..i).map(|k| mine[k] * mine[k]).sum::<f64>();
                if rest > ZERO_PIVOT * diagonal && rest.is_finite() {
                    pivots[i] = rest.sqrt();
                } else {
                    mine[..i].fill(0.0);
                }
            }
        }
    }
    // Column c of the inverse solves L L^T y = e_c.
    let mut inverse = vec![0.0; N * N];
    for c in (0..N).filter(|&c| pivots[c] > 0.0) {
        let mut y = [0.0f64; N];
        for i in c..N {
            if pivots[i] > 0.0 {
                let sum: f64 = (c..i).map(|k| l[N * i + k] * y[k]).sum();
                y[i] = (if i == c { 1.0 } else { 0.0 } - sum) / pivots[i];
            }
        }
        for i in (c..N).rev().filter(|&i| pivots[i] > 0.0) {
            y[i] /= pivots[i];
            for k in c..i {
                y[k] -= l[N * i + k] * y[i];
            }
        }
        for i in c..N {
            inverse[N * i + c] = y[i];
            inverse[N * c + i] = y[i];
        }
    }
    inverse
}
