//! What modeling tools say about faces: texture coordinates, normals, subsets of faces, materials.
//!
//! Sources: the schema pages of UsdGeom (Mesh, GeomSubset) and UsdShade (MaterialBindingAPI). Programs look
//! for texture coordinates in `primvars:st` and for the faces of a material in the family `materialBind`.

use super::names;
use super::text::{quoted, separator, write_list};
use crate::surface::{Labels, Surface};
use bowknot_geometry::Point;
use std::collections::HashMap;
use std::io::{Result, Write};

/// The materials of a stage, by name; empty ones, for an artist to fill or to replace.
#[derive(Debug, Default)]
pub(super) struct Materials {
    /// Name of the scope that they are in.
    scope: String,
    names: Vec<String>,
    identifiers: Vec<String>,
}

impl Materials {
    pub fn new<'a>(surfaces: impl Iterator<Item = &'a Surface>, scope: String) -> Self {
        let mut names: Vec<String> = Vec::new();
        for subset in surfaces.flat_map(|surface| subsets(surface, "")) {
            if subset.family == Family::Material && !names.iter().any(|name| name == subset.name) {
                names.push(subset.name.to_owned());
            }
        }
        let identifiers = names::children(names.iter().map(String::as_str));
        Self { scope, names, identifiers }
    }

    /// Writes them, if there are any.
    pub fn write(&self, out: &mut impl Write) -> Result<()> {
        if self.names.is_empty() {
            return Ok(());
        }
        write!(out, "    def Scope \"{}\"\n    {{\n", self.scope)?;
        for (name, id) in self.names.iter().zip(&self.identifiers) {
            let label = if name == id { String::new() } else { format!(" (\n{}        )", shown(name)) };
            write!(out, "        def Material \"{id}\"{label}\n        {{\n        }}\n\n")?;
        }
        out.write_all(b"    }\n\n")
    }

    fn path(&self, name: &str) -> String {
        let index = self.names.iter().position(|other| other == name).unwrap_or(0);
        format!("/World/{}/{}", self.scope, self.identifiers[index])
    }
}

/// Writes the texture coordinates of a mesh.
pub(super) fn write_texture_coordinates(out: &mut impl Write, surface: &Surface) -> Result<()> {
    let coordinates = surface.texture_coordinates();
    if !surface.corners().iter().any(|corner| corner.texture().is_some()) {
        return Ok(());
    }
    // Every corner needs one: those without get an additional one at the origin.
    let missing = surface.corners().iter().any(|corner| corner.texture().is_none());
    out.write_all(b"        texCoord2f[] primvars:st = [")?;
    for (k, [u, v]) in coordinates.iter().chain([[0.0; 2]].iter().filter(|_| missing)).enumerate() {
        write!(out, "{}({:?}, {:?})", separator(k), *u as f32, *v as f32)?;
    }
    out.write_all(b"] (\n            interpolation = \"faceVarying\"\n        )\n")?;
    let index = |texture: Option<u32>| texture.unwrap_or(coordinates.len() as u32);
    let indices = surface.corners().iter().map(|corner| index(corner.texture()));
    write_list(out, "int[] primvars:st:indices", indices)
}

/// Writes the normals of a mesh in `frames` frames, if it has any.
pub(super) fn write_normals(
    out: &mut impl Write,
    surface: &Surface,
    frames: usize,
    mut read: impl FnMut(usize) -> Result<Vec<Point>>,
) -> Result<()> {
    if surface.normal_count() == 0 {
        return Ok(());
    }
    out.write_all(b"        normal3f[] normals (\n            interpolation = \"faceVarying\"\n        )\n")?;
    out.write_all(b"        normal3f[] normals.timeSamples = {\n")?;
    for frame in 0..frames {
        write!(out, "            {frame}: [")?;
        for (k, normal) in surface.corner_normals(&read(frame)?).iter().enumerate() {
            let [x, y, z] = [normal.x as f32, normal.y as f32, normal.z as f32];
            write!(out, "{}({x:?}, {y:?}, {z:?})", separator(k))?;
        }
        out.write_all(b"],\n")?;
    }
    out.write_all(b"        }\n")
}

/// Writes the faces of materials, groups and objects of a body.
pub(super) fn write_subsets(
    out: &mut impl Write,
    surface: &Surface,
    body: &str,
    materials: &Materials,
) -> Result<()> {
    let subsets = subsets(surface, body);
    for family in [Family::Material, Family::Group, Family::Object] {
        if subsets.iter().any(|subset| subset.family == family) {
            let (name, kind) = (family.name(), family.kind());
            writeln!(out, "        uniform token subsetFamily:{name}:familyType = \"{kind}\"")?;
        }
    }
    let identifiers = names::children(subsets.iter().map(|subset| subset.name));
    for (subset, id) in subsets.iter().zip(&identifiers) {
        let mut metadata = String::new();
        if subset.family == Family::Material {
            metadata += "            prepend apiSchemas = [\"MaterialBindingAPI\"]\n";
        }
        if subset.name != id {
            metadata += &shown(subset.name);
        }
        let metadata = if metadata.is_empty() { metadata } else { format!(" (\n{metadata}        )") };
        write!(out, "\n        def GeomSubset \"{id}\"{metadata}\n        {{\n")?;
        out.write_all(b"            uniform token elementType = \"face\"\n")?;
        writeln!(out, "            uniform token familyName = \"{}\"", subset.family.name())?;
        out.write_all(b"    ")?;
        write_list(out, "int[] indices", &subset.faces)?;
        if subset.family == Family::Material {
            writeln!(out, "            rel material:binding = <{}>", materials.path(subset.name))?;
        }
        out.write_all(b"        }\n")?;
    }
    Ok(())
}

/// Faces of one name.
struct Subset<'a> {
    family: Family,
    name: &'a str,
    faces: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Family {
    Material,
    Group,
    Object,
}

impl Family {
    fn name(self) -> &'static str {
        match self {
            Self::Material => "materialBind",
            Self::Group => "group",
            Self::Object => "object",
        }
    }

    /// A face has one material and one object at most, but may be in several groups.
    fn kind(self) -> &'static str {
        if self == Self::Group { "unrestricted" } else { "nonOverlapping" }
    }

    /// The names of this family that hold for a polygon.
    fn of(self, labels: &Labels) -> Vec<&str> {
        match self {
            Self::Material => labels.material.as_deref().into_iter().collect(),
            Self::Group => labels.group.as_deref().unwrap_or("").split_whitespace().collect(),
            Self::Object => labels.object.as_deref().into_iter().collect(),
        }
    }
}

/// The subsets of a surface, by families and then in the order of their first faces. If all of it is the
/// object `body`, that goes without saying.
fn subsets<'a>(surface: &'a Surface, body: &str) -> Vec<Subset<'a>> {
    let mut subsets: Vec<Subset<'a>> = Vec::new();
    let mut known: HashMap<(Family, &str), usize> = HashMap::new();
    let mut current: Option<(&Labels, Vec<usize>)> = None;
    for (face, polygon) in (0..).zip(surface.polygons()) {
        let is_current = |(labels, _): &(&Labels, Vec<usize>)| std::ptr::eq(*labels, polygon.labels);
        let (_, members) = match current.take().filter(is_current) {
            Some(same) => current.insert(same),
            None => {
                let names = [Family::Material, Family::Group, Family::Object]
                    .into_iter()
                    .flat_map(|family| family.of(polygon.labels).into_iter().map(move |name| (family, name)));
                let mut members: Vec<usize> = names
                    .map(|(family, name)| {
                        *known.entry((family, name)).or_insert_with(|| {
                            subsets.push(Subset { family, name, faces: Vec::new() });
                            subsets.len() - 1
                        })
                    })
                    .collect();
                // A group may be named twice.
                members.sort_unstable();
                members.dedup();
                current.insert((polygon.labels, members))
            }
        };
        members.iter().for_each(|&index| subsets[index].faces.push(face));
    }
    subsets.retain(|subset| {
        let all = subset.faces.len() == surface.len();
        !(subset.family == Family::Object && subset.name == body && all)
    });
    subsets.sort_by_key(|subset| subset.family);
    subsets
}

/// Metadata that show a name as it is.
fn shown(name: &str) -> String {
    format!("            displayName = {}\n", quoted(name))
}
