//! Which vertices pins hold.

use super::part::element_of;
use super::roots::{Surroundings, roots};
use super::{Pin, WorldBody, bounds};
use crate::description::Scene;
use crate::error::SceneError;
use crate::kind::BodyKind;
use crate::pin::PinSpec;
use crate::validate::unknown;
use bowknot_errors::counted;
use bowknot_geometry::Point;

/// The pins of a scene, given its bodies, its obstacles and the positions at time 0.
pub(super) fn pins(
    scene: &Scene,
    bodies: &[WorldBody],
    surroundings: &Surroundings<'_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Pin>, SceneError> {
    let mut pins: Vec<Pin> = Vec::new();
    for (index, spec) in scene.pins.iter().enumerate() {
        let key = format!("pin[{index}]");
        let fault_of = |selector: &str, message: String| {
            SceneError::Body { body: format!("{key} of {}", spec.body), message }
                .at(scene.origins.of([&format!("{key}.{selector}"), &key]))
        };
        let fault = |message: String| fault_of("vertices", message);
        let Some(body) = bodies.iter().find(|b| b.kind.is_some() && b.name == spec.body) else {
            return Err(fault(format!("no body {:?}", spec.body)));
        };
        let mut vertices = numbered(spec, body).map_err(fault)?;
        vertices.extend(grouped(spec, body).map_err(|message| fault_of("group", message))?);
        add_middles(body, &mut vertices);
        vertices.extend(placed(spec, body, surroundings.positions));
        if spec.roots > 0 && body.kind == Some(BodyKind::Strands) {
            let (held, warning) = roots(body, spec.roots, spec.root_end, surroundings);
            vertices.extend(held);
            warnings.extend(warning.map(|warning| format!("{key} of {}: {warning}", spec.body)));
        }
        vertices.extend(body.frame_points_between(vertices.clone()));
        vertices.sort_unstable();
        vertices.dedup();
        if vertices.is_empty() {
            return Err(fault("it selects no vertex of the body".to_owned()));
        }
        for (other, pin) in pins.iter().enumerate() {
            let apart = pin.end < spec.start || spec.end < pin.start;
            let shared = vertices.iter().find(|v| pin.vertices.binary_search(v).is_ok());
            if let (false, Some(&vertex)) = (apart, shared) {
                return Err(fault(format!(
                    "vertex {} of body {} is held by pin[{other}] at the same time",
                    body.mesh_number(vertex),
                    spec.body
                )));
            }
        }
        let (motion, start, end) = (spec.motion.clone(), spec.start, spec.end);
        let name = format!("pin[{index}] of {}", spec.body);
        // Names of bodies and obstacles differ.
        let obstacle = |name: &String| bodies.iter().position(|b| b.name == *name);
        let follow = spec.follow.as_ref().and_then(obstacle).map(|body| body as u32);
        pins.push(Pin { name, vertices, motion, follow, start, end });
    }
    Ok(pins)
}

/// The vertices with the numbers of the pin.
fn numbered(spec: &PinSpec, body: &WorldBody) -> Result<Vec<u32>, String> {
    if spec.vertices.is_empty() {
        return Ok(Vec::new());
    }
    let by_number = body.mesh_order();
    let vertex = |&v: &u32| match by_number.get(v as usize) {
        Some(Some(vertex)) => Ok(*vertex),
        Some(None) => {
            let element = body.kind.map_or("element", |kind| element_of(kind).0);
            Err(format!("vertex {v} belongs to no {element} of body {}", spec.body))
        }
        None => {
            let count = counted(body.mesh_vertices, "vertex", "vertices");
            Err(format!("vertex {v}, but body {} has {count}, counted from 0", spec.body))
        }
    };
    spec.vertices.iter().map(vertex).collect()
}

/// The vertices of the groups of the pin, but those that belong to no element.
fn grouped(spec: &PinSpec, body: &WorldBody) -> Result<Vec<u32>, String> {
    if spec.group.is_empty() {
        return Ok(Vec::new());
    }
    let by_number = body.mesh_order();
    let mut vertices = Vec::new();
    for name in &spec.group {
        let group = body.groups.get(name).ok_or_else(|| match body.groups.is_empty() {
            true => format!("no group {name:?}: the mesh of body {} has no groups", spec.body),
            false => unknown("group", name, body.groups.iter().map(|(name, _)| name)),
        })?;
        vertices.extend(group.iter().filter_map(|&v| by_number[v as usize]));
    }
    Ok(vertices)
}

/// Adds the middles of edges whose ends are both among the vertices: in the mesh they have no numbers.
fn add_middles(body: &WorldBody, vertices: &mut Vec<u32>) {
    vertices.sort_unstable();
    let is_named = |v: &u32| vertices.binary_search(v).is_ok();
    let middles = body.middles().filter(|(ends, _)| ends.iter().all(is_named)).map(|(_, middle)| middle);
    let middles: Vec<u32> = middles.collect();
    vertices.extend(middles);
}

/// The vertices in the box and on the side of the pin.
fn placed(spec: &PinSpec, body: &WorldBody, positions: &[Point]) -> Vec<u32> {
    let at = |v: u32| &positions[v as usize];
    let mut vertices = Vec::new();
    if let Some(region) = &spec.region {
        vertices.extend(body.own_vertices().filter(|&v| region.contains(at(v))));
    }
    if let Some(side) = spec.side {
        let own: Vec<Point> = body.own_vertices().map(|v| *at(v)).collect();
        let (low, high) = bounds(&own);
        let (axis, upper) = side.axis();
        // Vertices that rounding, by a rotation for instance, moved off the side belong to it.
        let tolerance = 1e-9 * (high - low).norm();
        let on = |v: &u32| {
            let x = at(*v)[axis];
            if upper { x >= high[axis] - tolerance } else { x <= low[axis] + tolerance }
        };
        vertices.extend(body.own_vertices().filter(on));
    }
    vertices
}
