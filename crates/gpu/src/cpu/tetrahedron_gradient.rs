//! Twin of `shader/tetrahedron_gradient.wgsl`.

use super::gradients::{Places, write};
use super::solid::{columns, green_increment, green_strain, law_stress};
use super::{added, crossed, dot, negated, scaled};
use crate::assembly::Tetrahedron;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, gradient);
}

fn gradient(tet: &Tetrahedron, places: &Places<'_>) -> [V3; 4] {
    let f = columns(tet, |a, b| places.way(a, b));
    let mut s = [[0.0; 3]; 3];
    let mut stress = [[0.0; 3]; 3];
    if tet.law == 0 {
        s = law_stress(green_strain(f), tet.lambda, tet.mu);
    } else {
        let invariant = dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]) + 1.0;
        let shear = tet.mu * (1.0 - 1.0 / invariant);
        let across = crossed(f[1], f[2]);
        let pressure = tet.lambda * (dot(f[0], across) - 1.0) - 0.75 * tet.mu;
        let cofactor = [across, crossed(f[2], f[0]), crossed(f[0], f[1])];
        stress = [0, 1, 2].map(|k| added(scaled(f[k], shear), scaled(cofactor[k], pressure)));
    }
    if tet.viscous_mu > 0.0 && places.params.rate > 0.0 {
        let rate = places.params.rate;
        let strain = green_increment(f, columns(tet, |a, b| places.moved(a, b)));
        let viscous = law_stress(strain, tet.viscous_lambda * rate, tet.viscous_mu * rate);
        s = [0, 1, 2].map(|k| added(s[k], viscous[k]));
    }
    for (stress, s) in stress.iter_mut().zip(s) {
        let product = added(added(scaled(f[0], s[0]), scaled(f[1], s[1])), scaled(f[2], s[2]));
        *stress = added(*stress, product);
    }
    let forces = [0, 1, 2].map(|a| {
        let g = &tet.gradients[3 * a..3 * a + 3];
        let sum = added(added(scaled(stress[0], g[0]), scaled(stress[1], g[1])), scaled(stress[2], g[2]));
        scaled(sum, tet.volume)
    });
    let rest = added(added(forces[0], forces[1]), forces[2]);
    [negated(rest), forces[0], forces[1], forces[2]]
}
