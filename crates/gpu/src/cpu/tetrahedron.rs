//! Twin of `shader/tetrahedron.wgsl`.

use super::elements::Elements;
use super::solid::{Singular, columns, curvatures_of, shape_of, singular_of};
use super::{added, scaled};
use crate::assembly::Tetrahedron;
use crate::bound::Bound;

pub fn bound(buffers: Bound<'_>) {
    let elements = Elements {
        params: buffers.params(),
        positions: &buffers.read(1),
        start: &buffers.read(2),
        blocks: &mut buffers.write(3),
    };
    tetrahedron(&buffers.read(0), elements);
}

pub fn tetrahedron(tetrahedra: &[Tetrahedron], mut elements: Elements<'_>) {
    for (e, tet) in tetrahedra.iter().enumerate().take(elements.params.elements as usize) {
        if tet.viscous_mu > 0.0 && elements.params.rate > 0.0 {
            continue;
        }
        let Singular { u, s, v } = singular_of(columns(tet, |a, b| elements.way(a, b)));
        let (scaling, flip, twist) = curvatures_of(tet, s);
        let scaling = elements.filtered_matrix(scaling);
        let (mut even, mut odd) = ([0.0; 3], [0.0; 3]);
        for k in 0..3 {
            let (a, b) = (elements.filtered(flip[k]), elements.filtered(twist[k]));
            (even[k], odd[k]) = (0.5 * (a + b), 0.5 * (a - b));
        }

        let shape = shape_of(tet, v);
        let mut block = 6 * e;
        for a in 0..4 {
            for b in a + 1..4 {
                let (g, h) = (shape[a], shape[b]);
                let mut columns = [[0.0; 3]; 3];
                for i in 0..3 {
                    let mut row = [0.0; 3];
                    for j in 0..3 {
                        let mut value = scaling[i][j] * g[i] * h[j];
                        if i == j {
                            let (x, y) = ((i + 1) % 3, (i + 2) % 3);
                            value += even[y] * g[x] * h[x] + even[x] * g[y] * h[y];
                        } else {
                            value += odd[3 - i - j] * h[i] * g[j];
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
