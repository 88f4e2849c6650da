//! A character of cartoon proportions: 1.2 m tall, a big head, hands of three fingers and a thumb.
//!
//! It stands at the origin on the xy plane, looks along x and has its left along y. Fingers are three edges
//! thick and at least an edge apart, so that the mesh resolves each of them.

use crate::parts::{bar, pair, part};
use crate::remesh::Remesh;
use bowknot_scene::io::Mesh;
use bowknot_scene::shapes::{RoundCone, RoundCones, TriangleMesh};
use std::collections::BTreeMap;

/// Length of the edges [m].
const EDGE: f64 = 0.013;

/// Left shoulder, elbow and wrist [m].
pub const ARM: [[f64; 3]; 3] = [[0.0, 0.125, 0.735], [0.0, 0.265, 0.64], [0.0, 0.385, 0.56]];
/// Radii of the arm at these [m].
pub const ARM_RADII: [f64; 3] = [0.052, 0.042, 0.036];

/// The trunk: hips, belly, chest, shoulders.
fn trunk() -> Vec<RoundCone> {
    vec![
        bar([0.0, 0.045, 0.49], 0.11, 0.01),
        part([[0.01, 0.0, 0.56], [0.015, 0.0, 0.60]], [0.135, 0.13], 0.06),
        bar([0.0, 0.05, 0.69], 0.095, 0.06),
    ]
}

/// The arms without their hands.
fn arms() -> Vec<RoundCone> {
    let [shoulder, elbow, wrist] = ARM;
    let [at_shoulder, at_elbow, at_wrist] = ARM_RADII;
    let upper = pair([shoulder, elbow], [at_shoulder, at_elbow], 0.04);
    let lower = pair([elbow, wrist], [at_elbow, at_wrist], 0.006);
    upper.into_iter().chain(lower).collect()
}

/// The surface of the character: closed.
pub fn surface() -> Mesh {
    let solid = solid();
    let mut surface = Remesh::new(&solid, &[], solid.mesh(EDGE), BTreeMap::new());
    surface.run(EDGE);
    let TriangleMesh { positions, triangles } = surface.mesh;
    let mut mesh = Mesh { positions, triangles, ..Mesh::default() };
    mesh.drop_unused_vertices();
    mesh
}

fn solid() -> RoundCones {
    let mut parts = trunk();
    parts.extend(arms());
    parts.extend(hands());
    parts.extend(legs());
    parts.extend(head());
    RoundCones { parts }
}

/// Palms and fingers. The palms look down, the fingers point outwards.
fn hands() -> Vec<RoundCone> {
    // Small blends: fingers are not to grow together.
    const WEB: f64 = 0.012;
    let palm = [[-0.036, 0.435, 0.543], [0.036, 0.435, 0.543]];
    let finger = |from: [f64; 2], to: [f64; 2], drop: f64| {
        let ends = [[from[0], from[1], 0.54], [to[0], to[1], 0.54 - drop]];
        pair(ends, [0.0205, 0.0195], WEB)
    };
    let hands = [
        pair(palm, [0.031, 0.031], 0.03),
        finger([-0.046, 0.455], [-0.082, 0.552], 0.016),
        finger([0.0, 0.465], [-0.004, 0.58], 0.018),
        finger([0.046, 0.455], [0.072, 0.557], 0.016),
        finger([0.05, 0.425], [0.118, 0.455], 0.012),
    ];
    hands.into_iter().flatten().collect()
}

fn legs() -> Vec<RoundCone> {
    let legs = [
        pair([[0.0, 0.082, 0.45], [0.005, 0.092, 0.26]], [0.078, 0.062], 0.03),
        pair([[0.005, 0.092, 0.26], [-0.005, 0.096, 0.09]], [0.062, 0.05], 0.008),
        pair([[-0.02, 0.098, 0.052], [0.095, 0.118, 0.048]], [0.052, 0.048], 0.03),
    ];
    legs.into_iter().flatten().collect()
}

/// Neck, head, nose, eyes and ears.
fn head() -> Vec<RoundCone> {
    let mut parts = vec![
        part([[0.0, 0.0, 0.74], [0.0, 0.0, 0.87]], [0.055, 0.05], 0.05),
        part([[0.01, 0.0, 1.0], [0.0, 0.0, 1.06]], [0.145, 0.14], 0.03),
        part([[0.14, 0.0, 1.0], [0.165, 0.0, 0.995]], [0.026, 0.026], 0.02),
    ];
    // Eyes.
    parts.extend(pair([[0.115, 0.05, 1.055], [0.125, 0.052, 1.055]], [0.027, 0.027], 0.006));
    // Ears.
    parts.extend(pair([[0.0, 0.145, 1.03], [-0.01, 0.165, 1.035]], [0.034, 0.034], 0.02));
    parts
}
