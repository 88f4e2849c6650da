//! Checks of the input of a model.

use super::measures::{area, longest_edge, volume};
use crate::body::{Body, BodyShape};
use crate::error::ModelError;
use bowknot_errors::{Errors, ParamError, Parameters};
use bowknot_geometry::{Point, TETRAHEDRON_EDGES, Vector, VertexOutOfRange};
use std::collections::HashMap;

/// Areas, volumes and lengths count as zero up to this share of the longest edge squared, of the longest edge
/// cubed and of the largest coordinate.
const ZERO: f64 = 1e-12;

/// Farthest that a vertex may be from the middle of its edge, and a frame point from its place, over the length of the
/// edge.
const MIDDLE: f64 = 1e-6;

/// Smallest angle between the warp and a triangle's normal [rad], below which the warp has no direction in
/// the triangle.
const MIN_WARP_ANGLE: f64 = 1e-6;

/// Checks indices and materials first and then, if there is no error, sizes.
///
/// # Errors
/// Every error that was found.
pub(super) fn check(positions: &[Point], bodies: &[Body]) -> Result<(), Errors<ModelError>> {
    let mut errors = Vec::new();
    if let Some(vertex) = positions.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
        errors.push(ModelError::NonFinitePosition { vertex });
    }
    for body in bodies {
        if body.gravity.is_some_and(|g| !g.iter().all(|c| c.is_finite())) {
            errors.push(ModelError::Gravity { body: body.name.clone() });
        }
        for error in check_material(&body.shape).err().into_iter().flatten() {
            errors.push(ModelError::Material { body: body.name.clone(), error });
        }
        if let BodyShape::Strands { material, .. } = &body.shape
            && material.twist_stiffness > 0.0
        {
            errors.push(ModelError::NoFramePoints { body: body.name.clone() });
        }
        check_indices(body, positions.len(), &mut errors);
    }
    check_shared(bodies, &mut errors);
    if errors.is_empty() {
        bodies.iter().for_each(|body| check_sizes(positions, body, &mut errors));
    }
    Errors::check(errors)
}

fn check_material(shape: &BodyShape) -> Result<(), Errors<ParamError>> {
    match shape {
        BodyShape::Cloth { material, .. } => material.validate(),
        BodyShape::Solid { material, .. } | BodyShape::QuadraticSolid { material, .. } => material.validate(),
        BodyShape::Strands { material, .. } | BodyShape::Rods { material, .. } => material.validate(),
        BodyShape::Particles { material, .. } => material.validate(),
        BodyShape::Obstacle { .. } => Ok(()),
    }
}

fn element_name(shape: &BodyShape) -> &'static str {
    match shape {
        BodyShape::Cloth { .. } => "triangle",
        BodyShape::Solid { .. } | BodyShape::QuadraticSolid { .. } => "tet",
        BodyShape::Strands { .. } | BodyShape::Rods { .. } => "edge",
        BodyShape::Particles { .. } => "particle",
        BodyShape::Obstacle { .. } => "vertex",
    }
}

fn check_indices(body: &Body, vertex_count: usize, errors: &mut Vec<ModelError>) {
    let element = element_name(&body.shape);
    let name = || body.name.clone();
    let mut seen: HashMap<[u32; 10], usize> = HashMap::new();
    let mut index = 0;
    body.shape.for_each_element(|vertices| {
        for (k, &vertex) in vertices.iter().enumerate() {
            for error in VertexOutOfRange::of(element, index, &[vertex], vertex_count) {
                errors.push(ModelError::VertexOutOfRange { body: name(), error });
            }
            if vertices[..k].contains(&vertex) {
                errors.push(ModelError::RepeatedVertex { body: name(), element, index, vertex });
            }
        }
        let mut sorted = [u32::MAX; 10];
        sorted[..vertices.len()].copy_from_slice(vertices);
        sorted.sort_unstable();
        // An obstacle may name a vertex more than once.
        if !body.shape.is_obstacle()
            && let Some(first) = seen.insert(sorted, index)
        {
            errors.push(ModelError::RepeatedElement { body: name(), element, first, second: index });
        }
        index += 1;
    });
}

/// Obstacles must not share vertices with deformable bodies.
fn check_shared(bodies: &[Body], errors: &mut Vec<ModelError>) {
    let mut obstacle_of: HashMap<u32, usize> = HashMap::new();
    for (index, body) in bodies.iter().enumerate() {
        if let BodyShape::Obstacle { vertices } = &body.shape {
            obstacle_of.extend(vertices.iter().map(|v| (*v, index)));
        }
    }
    for body in bodies.iter().filter(|body| !body.shape.is_obstacle()) {
        let mut shared = None;
        body.shape.for_each_element(|vertices| {
            shared = shared.or_else(|| vertices.iter().find_map(|v| Some((*v, *obstacle_of.get(v)?))));
        });
        if let Some((vertex, obstacle)) = shared {
            let obstacle = bodies[obstacle].name.clone();
            errors.push(ModelError::SharedVertex { obstacle, body: body.name.clone(), vertex });
        }
    }
}

/// Elements must have an area, a volume or a length at rest.
fn check_sizes(positions: &[Point], body: &Body, errors: &mut Vec<ModelError>) {
    let at = |v: u32| positions[v as usize].coords;
    match &body.shape {
        BodyShape::Cloth { triangles, material } => {
            let warp = material.warp_direction.normalize();
            let mut normal = Vec::new();
            for (index, t) in triangles.iter().enumerate() {
                let corners = t.map(at);
                let area = area(&corners);
                let across = warp.cross(&(corners[1] - corners[0]).cross(&(corners[2] - corners[0]))).norm();
                if material.is_woven() && area > 0.0 && across < 2.0 * area * MIN_WARP_ANGLE {
                    normal.push(index);
                }
                if area <= ZERO * longest_edge(&corners).powi(2) {
                    errors.push(ModelError::ZeroArea { body: body.name.clone(), index, area });
                }
            }
            if !normal.is_empty() {
                errors.push(ModelError::WarpDirection { body: body.name.clone(), triangles: normal });
            }
        }
        BodyShape::Solid { tets, .. } => {
            check_tets(body, tets.iter().map(|t| t.map(at)), errors);
        }
        BodyShape::QuadraticSolid { tets, .. } => {
            check_tets(body, tets.iter().map(|t| [0, 1, 2, 3].map(|k| at(t[k]))), errors);
            for (index, tet) in tets.iter().enumerate() {
                for (&middle, [i, j]) in tet[4..].iter().zip(TETRAHEDRON_EDGES) {
                    let (a, b) = (at(tet[i]), at(tet[j]));
                    let off = (at(middle) - (a + b) * 0.5).norm();
                    if off > MIDDLE * (a - b).norm() {
                        let name = body.name.clone();
                        errors.push(ModelError::OffMiddle { body: name, index, vertex: middle, off });
                    }
                }
            }
        }
        BodyShape::Strands { edges, .. } => {
            check_edges(body, positions, edges.iter().copied(), errors);
        }
        BodyShape::Rods { edges, .. } => {
            check_edges(body, positions, edges.iter().map(|&[a, b, _]| [a, b]), errors);
            for (index, &[a, b, p]) in edges.iter().enumerate() {
                let (a, b, p_at) = (at(a), at(b), at(p));
                let (edge, from_middle) = (b - a, p_at - (a + b) * 0.5);
                let off = (from_middle.dot(&edge) / edge.norm())
                    .abs()
                    .max((from_middle.norm() - 0.5 * edge.norm()).abs());
                if off > MIDDLE * edge.norm() {
                    let name = body.name.clone();
                    errors.push(ModelError::OffFrame { body: name, index, vertex: p, off });
                }
            }
        }
        BodyShape::Particles { .. } | BodyShape::Obstacle { .. } => {}
    }
}

/// Edges must have a length.
fn check_edges(
    body: &Body,
    positions: &[Point],
    edges: impl Iterator<Item = [u32; 2]>,
    errors: &mut Vec<ModelError>,
) {
    let at = |v: u32| positions[v as usize].coords;
    for (index, [a, b]) in edges.enumerate() {
        if (at(a) - at(b)).norm() <= ZERO * at(a).amax().max(at(b).amax()) {
            errors.push(ModelError::ZeroLength { body: body.name.clone(), index, a, b });
        }
    }
}

/// Tetrahedra with these corners must have a positive volume.
fn check_tets(body: &Body, tets: impl ExactSizeIterator<Item = [Vector; 4]>, errors: &mut Vec<ModelError>) {
    let count = tets.len();
    let (mut inverted, mut flat) = (Vec::new(), Vec::new());
    for (index, corners) in tets.enumerate() {
        let volume = volume(&corners);
        let zero = ZERO * longest_edge(&corners).powi(3);
        if volume.abs() <= zero {
            flat.push(index);
        } else if volume < 0.0 {
            inverted.push(index);
        }
    }
    if !inverted.is_empty() || !flat.is_empty() {
        errors.push(ModelError::BadTets { body: body.name.clone(), tets: count, inverted, flat });
    }
}
