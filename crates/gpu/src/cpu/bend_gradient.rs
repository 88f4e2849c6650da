//! Twin of `shader/bend_gradient.wgsl`.

use super::gradients::{Places, write};
use super::normal::{factors_of, normal_of};
use super::triangle::columns;
use super::{added, crossed, dot, negated, scaled, subtracted};
use crate::assembly::Bend;
use crate::bound::Bound;
use crate::layout::NONE;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, gradient);
}

fn gradient(bend: &Bend, places: &Places<'_>) -> [V3; 6] {
    let ways = bend.nodes.map(|node| if node == NONE { [0.0; 3] } else { places.way(bend.nodes[0], node) });
    let g = bend.gradients;
    let [f1, f2] = columns(g, ways[1], ways[2]);
    let normal = normal_of(crossed(f1, f2), bend.crushed);
    let factors = factors_of(bend);
    let residuals = [0, 1, 2].map(|i| {
        let sum = scaled(normal.m, -bend.rest[3 * i + 2] * normal.scale);
        (1..6).fold(sum, |sum, p| added(sum, scaled(ways[p], factors[6 * i + p])))
    });
    let stresses = [0, 1, 2].map(|i| {
        let row = &bend.gram[3 * i..3 * i + 3];
        added(added(scaled(residuals[0], row[0]), scaled(residuals[1], row[1])), scaled(residuals[2], row[2]))
    });
    let turning = (0..3).fold([0.0; 3], |sum, i| added(sum, scaled(stresses[i], bend.rest[3 * i + 2])));
    let along = scaled(normal.m, dot(normal.m, turning) / normal.squared);
    let across = scaled(subtracted(turning, along), normal.scale);
    let (by_f1, by_f2) = (crossed(f2, across), crossed(across, f1));
    let mut out = [[0.0; 3]; 6];
    let mut rest = [0.0; 3];
    for p in 1..6 {
        let mut sum = added(
            added(scaled(stresses[0], factors[p]), scaled(stresses[1], factors[6 + p])),
            scaled(stresses[2], factors[12 + p]),
        );
        if p < 3 {
            sum = subtracted(sum, added(scaled(by_f1, g[2 * p - 2]), scaled(by_f2, g[2 * p - 1])));
        }
        out[p] = sum;
        rest = added(rest, sum);
    }
    out[0] = negated(rest);
    out
}
