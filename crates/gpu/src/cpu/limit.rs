//! Twin of `shader/limit.wgsl`, which states the bound of the rounding.

use super::dot;
use super::pair::pair_of;
use crate::bound::Bound;
use crate::layout::{Candidate, Control, NONE, Separation, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub damping: f32,
}

const STEP: f32 = 8.0;
const PATH_ROUNDING: f32 = 3.814_697_3e-6;

pub fn bound(buffers: Bound<'_>) {
    limit(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &buffers.read(5),
        &mut buffers.write(6),
        &mut buffers.write::<Control>(7)[0],
    );
}

pub fn limit(
    params: Params,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    vertices: &[Vertex],
    candidates: &[Candidate],
    separations: &[Separation],
    paths: &[[f32; 4]],
    alphas: &mut [u32],
    control: &mut Control,
) {
    for c in 0..control.candidates.min(params.capacity) as usize {
        let (candidate, separation) = (candidates[c], separations[c]);
        limit_pair(&params, candidate, &separation, edges, triangles, vertices, paths, alphas, control);
    }
}

fn lower(alpha: f32, stored: &mut u32) {
    let mut bits = alpha.to_bits();
    if bits >= 0x7f80_0000 {
        bits = 0;
    }
    *stored = (*stored).min(bits);
}

fn limit_pair(
    params: &Params,
    candidate: Candidate,
    separation: &Separation,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    vertices: &[Vertex],
    paths: &[[f32; 4]],
    alphas: &mut [u32],
    control: &mut Control,
) {
    let pair = pair_of(candidate, edges, triangles);
    let at = pair.vertices.map(|v| v as usize);
    let path = at.map(|v| paths[v]);
    let mut longest = 0.0f32;
    for path in &path[..pair.count] {
        longest = longest.max(path[0].abs() + path[1].abs() + path[2].abs());
    }
    if longest == 0.0 {
        return;
    }
    let rounding = STEP + PATH_ROUNDING * longest;
    let is_certified = separation.width > 2.0 * rounding;
    if !is_certified {
        at[..pair.count].iter().for_each(|&v| lower(0.0, &mut alphas[v]));
        control.frozen += 1;
        return;
    }
    let allowed = (params.damping * (separation.width - separation.min_separation) - rounding).max(0.0);

    let (mut closing, mut speeds, mut extremes) = ([0.0f32; 4], [0.0f32; 2], [-3.0e38f32; 2]);
    let group = vertices[at[0]].group;
    let mut one_group = group != NONE;
    for k in 0..pair.count {
        let along = dot(separation.normal, [path[k][0], path[k][1], path[k][2]]);
        let side = usize::from(k >= pair.side_a);
        closing[k] = if side == 0 { -along } else { along };
        speeds[side] = speeds[side].max(closing[k]);
        extremes[side] = extremes[side].max(closing[k]);
        one_group &= vertices[at[k]].group == group;
    }
    if one_group {
        let total = extremes[0] + if pair.side_a == pair.count { 0.0 } else { extremes[1] };
        if total > allowed {
            for k in 0..pair.count {
                lower(allowed / total * path[k][3], &mut alphas[at[k]]);
            }
        }
        return;
    }
    let total = speeds[0] + speeds[1];
    if total <= allowed {
        return;
    }
    let heights = heights_of(pair.side_a, separation.heights);
    let mut needs = [0.0f32; 2];
    for k in 0..pair.count {
        let side = usize::from(k >= pair.side_a);
        needs[side] = needs[side].max(closing[k] - heights[k]);
    }
    let needed = needs[0] + needs[1];
    if needed <= allowed {
        return;
    }
    for k in 0..pair.count {
        let room = allowed * (needs[usize::from(k >= pair.side_a)] / needed) + heights[k];
        if closing[k] > room {
            lower((room / closing[k]).min(1.0) * path[k][3], &mut alphas[at[k]]);
        }
    }
}

fn heights_of(side_a: usize, relative: [f32; 2]) -> [f32; 4] {
    let [x, y] = relative;
    if side_a == 2 {
        return [-x, x, -y, y].map(|height| height.max(0.0));
    }
    let nearest = x.min(y).min(0.0);
    [0.0, -nearest, x - nearest, y - nearest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::separate;
    use crate::layout::Kind;

    /// On grids from a few quanta to the largest, also where one coordinate is much longer than the others.
    #[test]
    fn heights_are_never_overstated() {
        let (edges, triangles) = ([[0, 1], [2, 3]], [[1, 2, 3, 0]]);
        let mut random = fastrand::Rng::with_seed(9);
        let mut raised = 0;
        for _ in 0..20_000 {
            let sizes = [0; 3].map(|_| 1 << random.i32(1..28));
            let x: [[i32; 4]; 4] = std::array::from_fn(|_| {
                std::array::from_fn(|k| if k < 3 { random.i32(0..sizes[k]) } else { 0 })
            });
            for candidate in [
                Candidate::new(Kind::VertexEdge, 0, 1),
                Candidate::new(Kind::VertexTriangle, 0, 0),
                Candidate::new(Kind::EdgeEdge, 0, 1),
            ] {
                let mut separations = [Separation::default()];
                let (params, control) = (
                    separate::Params { capacity: 1, after_search: 0 },
                    Control { candidates: 1, ..Control::default() },
                );
                separate::separate(
                    params,
                    &x,
                    &edges,
                    &triangles,
                    &[],
                    &[candidate],
                    &mut separations,
                    &control,
                );
                let pair = pair_of(candidate, &edges, &triangles);
                let heights = heights_of(pair.side_a, separations[0].heights);
                let normal = separations[0].normal.map(f64::from);
                let along = |k: usize| -> f64 {
                    let place = x[pair.vertices[k] as usize];
                    let sign = if k < pair.side_a { 1.0 } else { -1.0 };
                    sign * (0..3).map(|c| normal[c] * f64::from(place[c])).sum::<f64>()
                };
                for side in [0..pair.side_a, pair.side_a..pair.count] {
                    let nearest = side.clone().map(along).fold(f64::INFINITY, f64::min);
                    for k in side {
                        let exact = along(k) - nearest;
                        assert!(f64::from(heights[k]) <= exact, "{} {exact} {pair:?} {x:?}", heights[k]);
                        raised += usize::from(f64::from(heights[k]) > 0.9 * exact && exact > 1.0);
                    }
                }
            }
        }
        assert!(raised > 50_000, "{raised}");
    }
}
