//! Twin of `shader/bend.wgsl`.

use super::elements::Elements;
use super::normal::{Normal, factors_of, normal_of};
use super::{added, crossed, scaled};
use crate::assembly::Bend;
use crate::bound::Bound;

type V3 = [f32; 3];
/// By columns.
type M3 = [V3; 3];

pub fn bound(buffers: Bound<'_>) {
    let elements = Elements {
        params: buffers.params(),
        positions: &buffers.read(1),
        start: &buffers.read(2),
        blocks: &mut buffers.write(3),
    };
    bend(&buffers.read(0), elements);
}

/// The matrix of v -> a x v.
fn cross_matrix([x, y, z]: V3) -> M3 {
    [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
}

fn image(m: &M3, v: V3) -> V3 {
    added(added(scaled(m[0], v[0]), scaled(m[1], v[1])), scaled(m[2], v[2]))
}

fn product(a: &M3, b: &M3) -> M3 {
    b.map(|column| image(a, column))
}

fn transposed(a: &M3) -> M3 {
    [0, 1, 2].map(|k| [a[0][k], a[1][k], a[2][k]])
}

fn sum(a: M3, b: M3) -> M3 {
    [0, 1, 2].map(|k| added(a[k], b[k]))
}

fn times(a: &M3, factor: f32) -> M3 {
    a.map(|column| scaled(column, factor))
}

pub fn bend(bends: &[Bend], mut elements: Elements<'_>) {
    for (e, bend) in bends.iter().enumerate().take(elements.params.elements as usize) {
        let g = bend.gradients;
        let e1 = elements.way(bend.nodes[0], bend.nodes[1]);
        let e2 = elements.way(bend.nodes[0], bend.nodes[2]);
        let f1 = added(scaled(e1, g[0]), scaled(e2, g[2]));
        let f2 = added(scaled(e1, g[1]), scaled(e2, g[3]));
        let Normal { m, squared, scale } = normal_of(crossed(f1, f2), bend.crushed);
        let across: M3 = [0, 1, 2].map(|k| {
            let mut column = scaled(m, -m[k] / squared);
            column[k] += 1.0;
            scaled(column, scale)
        });
        let by_f1 = product(&across, &cross_matrix(f2.map(|x| -x)));
        let by_f2 = product(&across, &cross_matrix(f1));
        let first = sum(times(&by_f1, g[0]), times(&by_f2, g[1]));
        let second = sum(times(&by_f1, g[2]), times(&by_f2, g[3]));
        let turns = [times(&sum(first, second), -1.0), first, second];
        let factors = factors_of(bend);
        let mut block = 15 * e;
        for p in 0..6 {
            for q in p + 1..6 {
                let (mut both, mut left, mut right, mut none) = (0.0, 0.0, 0.0, 0.0);
                for i in 0..3 {
                    for j in 0..3 {
                        let g = bend.gram[3 * i + j];
                        let (ci, cj) = (bend.rest[3 * i + 2], bend.rest[3 * j + 2]);
                        both += g * factors[6 * i + p] * factors[6 * j + q];
                        left += g * factors[6 * i + p] * cj;
                        right += g * ci * factors[6 * j + q];
                        none += g * ci * cj;
                    }
                }
                let mut total = [[both, 0.0, 0.0], [0.0, both, 0.0], [0.0, 0.0, both]];
                if q < 3 {
                    let turned = times(&product(&transposed(&turns[p]), &turns[q]), none);
                    total = sum(total, sum(times(&turns[q], -left), turned));
                }
                if p < 3 {
                    total = sum(total, times(&transposed(&turns[p]), -right));
                }
                elements.put(block, total);
                block += 1;
            }
        }
    }
}
