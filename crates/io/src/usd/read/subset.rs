//! Subsets of a mesh as groups of its vertices.
//!
//! Source: the schema page of UsdGeom, GeomSubset.

use super::layer::{Attribute, Prim, Value};
use super::text::Arrays;
use crate::error::IoError;
use crate::groups::Groups;

/// Adds the subsets of a prim of `points` points as groups: of points, and the vertices of faces, tetrahedra and
/// edges. Whether all of them are such.
///
/// # Errors
/// A file that cannot be read again.
pub(super) fn add_subsets(
    arrays: &Arrays,
    prim: &Prim,
    groups: &mut Groups,
    points: usize,
) -> Result<bool, IoError> {
    let mut all = true;
    for subset in &prim.children {
        let numbers = |prim: &Prim, name: &str| match prim.attributes.get(name).and_then(Attribute::first) {
            Some(Value::Array(place)) => arrays.read(place),
            _ => Ok(Vec::new()),
        };
        // Each once: a short list may name a large face many times.
        let mut indices = numbers(subset, "indices")?;
        indices.sort_unstable_by(f64::total_cmp);
        indices.dedup();
        let of_elements = |corners: Vec<f64>, ends: Vec<usize>| -> Option<Vec<f64>> {
            let element = |index: &f64| {
                let index = whole(*index, ends.len())?;
                let start = if index == 0 { 0 } else { ends[index - 1] };
                corners.get(start..ends[index])
            };
            Some(indices.iter().map(element).collect::<Option<Vec<_>>>()?.concat())
        };
        let vertices = match subset.text("elementType").unwrap_or("face") {
            "point" | "edge" => Some(indices),
            "face" if prim.kind == "Mesh" => {
                let mut end = 0;
                let counts = numbers(prim, "faceVertexCounts")?;
                let ends = counts.iter().map(|count| {
                    end += *count as usize;
                    end
                });
                of_elements(numbers(prim, "faceVertexIndices")?, ends.collect())
            }
            "tetrahedron" if prim.kind == "TetMesh" => {
                let corners = numbers(prim, "tetVertexIndices")?;
                let ends = (1..=corners.len() / 4).map(|tet| 4 * tet).collect();
                of_elements(corners, ends)
            }
            _ => None,
        };
        let vertices = vertices.and_then(|vertices| vertices.iter().map(|v| whole(*v, points)).collect());
        let Some(vertices): Option<Vec<usize>> = vertices else {
            all = false;
            continue;
        };
        let name = subset.display_name.as_deref().unwrap_or(&subset.name);
        groups.add(name, vertices.into_iter().map(|v| v as u32));
    }
    Ok(all)
}

/// An index below a count.
fn whole(number: f64, count: usize) -> Option<usize> {
    (number.fract() == 0.0 && (0.0..count as f64).contains(&number)).then_some(number as usize)
}
