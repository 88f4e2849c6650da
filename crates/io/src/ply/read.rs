//! From the rows of a PLY file to a mesh.

use super::header::{Element, Header, PropertyKind};
use super::payload::{Payload, Row};
use crate::error::{IoError, Place};
use crate::import::{Import, read_bytes};
use crate::mesh::Mesh;
use crate::surface::{Corner, Labels, Surface};
use bowknot_errors::counted;
use std::path::Path;

/// Reads a PLY file: `vertex` (x y z, and `obstacle`, `body` if there), `face` (a list `vertex_indices` or
/// `vertex_index` of any integer type, as fans around the first vertex), `edge` (`vertex1`, `vertex2`); other
/// elements are skipped. Vertices of no face and no edge are particles. A number of a vertex that is neither
/// coordinate, normal, color nor texture coordinate is a group: its vertices are those where it is not 0.
/// Names of bodies are read as [`write_ply`](crate::write_ply) writes them.
///
/// # Errors
/// A missing, malformed or truncated file, coordinates that are not finite, indices of vertices that do not
/// exist, triangle strips; with the line of an ASCII file or the element of a binary one.
pub fn read_ply(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    parse_ply(path, &read_bytes(path, import)?, import)
}

/// As [`read_ply`], from the bytes of the file at `path`.
pub(crate) fn parse_ply(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    let mesh = parse(bytes, import).map_err(|(place, message)| IoError::content(path, place, message))?;
    if mesh.positions.is_empty() {
        return Err(IoError::Empty { path: path.to_owned(), message: "it has no vertices" });
    }
    Ok(mesh)
}

fn parse(bytes: &[u8], import: &Import) -> Result<Mesh, (Place, String)> {
    let header = Header::parse(bytes).map_err(|(line, message)| (Place::Line(line), message))?;
    let count = |name: &str| header.elements.iter().find(|e| e.name == name).map_or(0, |e| e.count);
    let vertices = count("vertex");
    if !header.elements.iter().any(|element| element.name == "vertex") {
        return Err((Place::File, "it has no vertices".to_owned()));
    }
    if vertices > u32::MAX as usize {
        return Err((Place::File, format!("{vertices} vertices; at most {} are possible", u32::MAX)));
    }
    if count("tristrips") > 0 {
        return Err((Place::File, "triangle strips are not read: export triangles or polygons".to_owned()));
    }

    let mut mesh = Mesh { names: header.names.clone(), ..Mesh::default() };
    let mut payload = Payload::new(bytes, &header);
    let mut row = Row::default();
    for element in header.elements.iter().filter(|e| !e.properties.is_empty()) {
        payload.expect(element)?;
        match element.name.as_str() {
            "vertex" => mesh.positions.reserve(element.count),
            "face" => mesh.triangles.reserve(element.count),
            _ => {}
        }
        let mut sink = Sink::new(element, vertices, import)?;
        let extra = if element.name == "vertex" { extra_properties(element) } else { Vec::new() };
        let mut groups = vec![Vec::new(); extra.len()];
        for index in 0..element.count {
            payload.read(element, index, &mut row)?;
            sink.take(&row, &mut mesh).map_err(|message| {
                (row.place.clone().unwrap_or_else(|| Place::Element(element.name.clone(), index)), message)
            })?;
            for (group, &property) in groups.iter_mut().zip(&extra) {
                // NaN says nothing.
                if row.values[property].abs() > 0.0 {
                    group.push(index as u32);
                }
            }
        }
        for (group, property) in groups.into_iter().zip(extra) {
            mesh.groups.add(&element.properties[property].name, group);
        }
    }
    if mesh.positions.len() < vertices {
        return Err((Place::File, "its vertices have no properties".to_owned()));
    }
    let used = mesh.used_by_elements();
    mesh.particles = (0..mesh.positions.len() as u32).filter(|&v| !used[v as usize]).collect();
    Ok(mesh)
}

/// The properties of a vertex that are groups, as their places in the row.
fn extra_properties(element: &Element) -> Vec<usize> {
    let is_extra = |&place: &usize| {
        let property = &element.properties[place];
        matches!(property.kind, PropertyKind::Scalar(_)) && !is_known(&property.name)
    };
    (0..element.properties.len()).filter(is_extra).collect()
}

/// Whether a property of a vertex is a coordinate, a normal, a color or a texture coordinate, or one of our own.
fn is_known(name: &str) -> bool {
    let prefixes = ["normal_", "diffuse_", "ambient_", "specular_", "texture_"];
    let plain = prefixes.iter().find_map(|prefix| name.strip_prefix(prefix)).unwrap_or(name);
    let is_place =
        matches!(plain, "x" | "y" | "z" | "nx" | "ny" | "nz" | "s" | "t" | "u" | "v" | "s0" | "t0");
    let is_color = matches!(plain, "red" | "green" | "blue" | "alpha" | "r" | "g" | "b" | "a");
    is_place || is_color || matches!(name, "obstacle" | "body")
}

/// What becomes of the rows of an element.
enum Sink<'a> {
    Vertex { xyz: [usize; 3], obstacle: Option<usize>, body: Option<usize>, import: &'a Import },
    Face { list: usize, vertices: usize },
    Edge { ends: [usize; 2], vertices: usize },
    Skip,
}

impl<'a> Sink<'a> {
    fn new(element: &Element, vertices: usize, import: &'a Import) -> Result<Self, (Place, String)> {
        let fault = |message: String| (Place::File, message);
        let scalar = |name: &str, integer: bool| {
            let index = element.property(name)?;
            match element.properties[index].kind {
                PropertyKind::Scalar(kind) if kind.is_integer() || !integer => Some(index),
                _ => None,
            }
        };
        let needed = |name: &str, integer: bool| {
            let what = if integer { "integer" } else { "number" };
            scalar(name, integer)
                .ok_or_else(|| fault(format!("element {} has no {what} {name}", element.name)))
        };
        Ok(match element.name.as_str() {
            "vertex" => Self::Vertex {
                xyz: [needed("x", false)?, needed("y", false)?, needed("z", false)?],
                obstacle: scalar("obstacle", true),
                body: scalar("body", true),
                import,
            },
            "face" => {
                let list = ["vertex_indices", "vertex_index"].iter().find_map(|name| {
                    let index = element.property(name)?;
                    matches!(element.properties[index].kind, PropertyKind::List { item, .. } if item.is_integer())
                        .then_some(index)
                });
                let list =
                    list.ok_or_else(|| fault("element face has no integer list vertex_indices".to_owned()))?;
                Self::Face { list, vertices }
            }
            "edge" => Self::Edge { ends: [needed("vertex1", true)?, needed("vertex2", true)?], vertices },
            _ => Self::Skip,
        })
    }

    fn take(&mut self, row: &Row, mesh: &mut Mesh) -> Result<(), String> {
        match self {
            Self::Vertex { xyz, obstacle, body, import } => {
                let raw = xyz.map(|property| row.values[property]);
                let point = import.point(raw);
                if !point.iter().all(|c| c.is_finite()) {
                    return Err(format!("coordinates {raw:?} are not finite"));
                }
                mesh.positions.push(point);
                if let Some(property) = obstacle {
                    mesh.obstacle.get_or_insert_default().push(row.values[*property] != 0.0);
                }
                if let Some(property) = body {
                    let value = row.values[*property];
                    // Bodies are written as `int`.
                    if !(0.0..=f64::from(i32::MAX)).contains(&value) {
                        return Err(format!("body {value} must be a whole number from 0 to {}", i32::MAX));
                    }
                    mesh.body.get_or_insert_default().push(value as u32);
                }
                Ok(())
            }
            Self::Face { list, vertices } => {
                let corners = row.list(*list);
                if corners.len() < 3 {
                    return Err(format!("a face needs 3 vertices, this one has {}", corners.len()));
                }
                let corners = corners.iter().map(|&value| vertex(value, *vertices));
                let corners: Vec<u32> = corners.collect::<Result<_, _>>()?;
                let Mesh { triangles, surface, .. } = mesh;
                if corners.len() > 3 {
                    surface.get_or_insert_with(|| Surface::of_triangles(triangles));
                }
                if let Some(surface) = surface {
                    let corners = corners.iter().map(|&vertex| Corner::new(vertex, None, None));
                    surface.push(corners, &Labels::default());
                }
                triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
                Ok(())
            }
            Self::Edge { ends, vertices } => {
                let [a, b] = ends.map(|property| vertex(row.values[property], *vertices));
                mesh.strands.push([a?, b?]);
                Ok(())
            }
            Self::Skip => Ok(()),
        }
    }
}

/// A checked vertex index. The value is whole: it comes from an integer type, or was checked to be.
fn vertex(value: f64, vertices: usize) -> Result<u32, String> {
    if value >= 0.0 && value < vertices as f64 {
        Ok(value as u32)
    } else {
        let vertices = counted(vertices, "vertex", "vertices");
        Err(format!("vertex index {value}, but the file has {vertices}, counted from 0"))
    }
}
