//! Twin of `shader/damped_tetrahedron.wgsl`.

use super::elements::Elements;
use super::solid::{Singular, columns, curvatures_of, green_increment, law_stress, shape_of, singular_of};
use super::{added, scaled};
use crate::assembly::Tetrahedron;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    let elements = Elements {
        params: buffers.params(),
        positions: &buffers.read(1),
        start: &buffers.read(2),
        blocks: &mut buffers.write(3),
    };
    damped_tetrahedron(&buffers.read(0), elements);
}

/// The matrix with these columns times v.
fn image(m: [V3; 3], v: V3) -> V3 {
    added(added(scaled(m[0], v[0]), scaled(m[1], v[1])), scaled(m[2], v[2]))
}

pub fn damped_tetrahedron(tetrahedra: &[Tetrahedron], mut elements: Elements<'_>) {
    let params = elements.params;
    for (e, tet) in tetrahedra.iter().enumerate().take(params.elements as usize) {
        if !(tet.viscous_mu > 0.0 && params.rate > 0.0) {
            continue;
        }
        let f = columns(tet, |a, b| elements.way(a, b));
        let d = columns(tet, |a, b| elements.moved(a, b));
        let Singular { u, s, v } = singular_of(f);
        let (scaling, flip, twist) = curvatures_of(tet, s);
        let (lambda, mu) = (tet.viscous_lambda * params.rate, tet.viscous_mu * params.rate);
        let now = v.map(|axis| image(f, axis));
        let change = v.map(|axis| image(d, axis));
        let viscous = law_stress(green_increment(now, change), lambda, mu);
        let mut curvature = [[0.0; 9]; 9];
        for i in 0..3 {
            for j in 0..3 {
                curvature[4 * i][4 * j] += scaling[i][j] + lambda * s[i] * s[j];
                for k in 0..3 {
                    curvature[3 * i + j][3 * i + k] += viscous[j][k];
                }
            }
            curvature[4 * i][4 * i] += 2.0 * mu * s[i] * s[i];
        }
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (even, odd) = (0.5 * (flip[k] + twist[k]), 0.5 * (flip[k] - twist[k]));
            let (ij, ji) = (3 * i + j, 3 * j + i);
            curvature[ij][ij] += even + mu * s[i] * s[i];
            curvature[ji][ji] += even + mu * s[j] * s[j];
            curvature[ij][ji] += odd + mu * s[i] * s[j];
            curvature[ji][ij] += odd + mu * s[i] * s[j];
        }
        let curvature = elements.filtered_matrix(curvature);

        let shape = shape_of(tet, v);
        let mut block = 6 * e;
        for a in 0..4 {
            for b in a + 1..4 {
                let (g, h) = (shape[a], shape[b]);
                let mut columns = [[0.0; 3]; 3];
                for i in 0..3 {
                    let mut row = [0.0; 3];
                    for j in 0..3 {
                        let mut value = 0.0;
                        for k in 0..9 {
                            value += g[k / 3] * curvature[3 * i + k / 3][3 * j + k % 3] * h[k % 3];
                        }
                        row = added(row, scaled(u[j], value * tet.volume));
                    }
                    for (column, row) in columns.iter_mut().zip(row) {
                        *column = added(*column, scaled(u[i], row));
                    }
                }
                elements.put(block, columns);
                block += 1;
            }
        }
    }
}
