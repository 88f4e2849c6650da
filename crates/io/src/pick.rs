//! Parts of a file, chosen by name or path.

use crate::animation::Animation;
use crate::error::{IoError, Place};
use crate::folder::ending;
use crate::frame_source::FrameSource;
use crate::import::Import;
use crate::mesh::Mesh;
use crate::read::read_mesh;
use crate::still::{is_still, open_still};
use std::collections::HashMap;
use std::path::Path;

/// Most parts that a message lists.
const LISTED: usize = 30;

/// Reads one part of a mesh file: a prim of a USD stage by its name or path, or all prims below that path; a
/// node of a glTF scene, an object of an OBJ or a body of a PLY by its name.
///
/// # Errors
/// As [`read_mesh`]; a part that is not there, or a name that several have, with the parts that there are.
pub fn read_mesh_part(path: &Path, import: &Import, part: &str) -> Result<Mesh, IoError> {
    let (mut mesh, paths) = match is_still(&ending(path)) {
        true => open_still(path, import)?,
        false => (read_mesh(path, import)?, Vec::new()),
    };
    mesh.name_parts(&stem(path));
    choose(&mut mesh, &paths, part).map_err(|message| IoError::content(path, Place::File, message))?;
    Ok(mesh)
}

impl FrameSource {
    /// One part of all frames, as [`read_mesh_part`] chooses it.
    ///
    /// # Errors
    /// As [`Self::read`]; a part that is not there, or a name that several have.
    pub fn part(self, part: &str) -> Result<Self, IoError> {
        let picked = Picked { source: self, part: part.to_owned() };
        picked.read(0)?;
        Ok(Self::of_animation(picked))
    }
}

/// A part of another source.
#[derive(Debug)]
struct Picked {
    source: FrameSource,
    part: String,
}

impl Animation for Picked {
    fn len(&self) -> usize {
        self.source.len()
    }

    fn times(&self) -> Option<&[f64]> {
        self.source.times()
    }

    fn codes(&self) -> Option<&[f64]> {
        self.source.codes()
    }

    fn names(&self) -> &[String] {
        // The meshes have them.
        &[]
    }

    fn path(&self, index: usize) -> &Path {
        self.source.path(index)
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        let mut mesh = self.source.read(index)?;
        let path = self.path(index);
        mesh.name_parts(&stem(path));
        choose(&mut mesh, self.source.paths(), &self.part)
            .map_err(|message| IoError::content(path, Place::File, message))?;
        Ok(mesh)
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Keeps one part of a mesh whose parts have names.
fn choose(mesh: &mut Mesh, paths: &[String], part: &str) -> Result<(), String> {
    let found = find(&mesh.names, paths, part)?;
    mesh.keep_parts(&found).map_err(|other| {
        let other = mesh.names.get(other).map_or("", String::as_str);
        format!(
            "an element joins part {part:?} to {other:?}, so that it is no part by itself; leave \
             out `part`, or separate them in the file"
        )
    })
}

/// The parts that a name or path means.
fn find(names: &[String], paths: &[String], wanted: &str) -> Result<Vec<usize>, String> {
    let all = |fits: &dyn Fn(usize) -> bool| (0..names.len()).filter(|&k| fits(k)).collect::<Vec<_>>();
    let path = |k: usize| paths.get(k).map_or("", String::as_str);
    let below = |k: usize| {
        let rest = path(k).strip_prefix(wanted.trim_end_matches('/'));
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    if wanted.starts_with('/') && !paths.is_empty() {
        let found = all(&below);
        return if found.is_empty() { Err(unknown(names, paths, wanted)) } else { Ok(found) };
    }
    let found = all(&|k| names[k] == wanted);
    // Parts whose names are not unique are named by their paths.
    let found = if found.is_empty() { all(&|k| path(k).rsplit('/').next() == Some(wanted)) } else { found };
    match found.as_slice() {
        [] => Err(unknown(names, paths, wanted)),
        [_] => Ok(found),
        several => {
            let paths: Vec<&str> = several.iter().map(|&k| path(k)).filter(|path| !path.is_empty()).collect();
            let remedy = match paths.is_empty() {
                true => "; give them different names in the file".to_owned(),
                false => format!(": {}; give the path of one", paths.join(", ")),
            };
            Err(format!("{} parts are called {wanted:?}{remedy}", several.len()))
        }
    }
}

fn unknown(names: &[String], paths: &[String], wanted: &str) -> String {
    let parts = if paths.is_empty() { names } else { paths };
    let listed = parts.iter().take(LISTED).cloned().collect::<Vec<_>>().join(", ");
    let more = match parts.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("no part {wanted:?}; it has {listed}{more}")
}

impl Mesh {
    /// Gives each vertex a part and each part a name, as the mesh's bodies: those that the file tells, else the
    /// objects of an OBJ. What has no name has that of the `whole`.
    pub fn name_parts(&mut self, whole: &str) {
        if self.body.is_some() {
            return self.name_bodies(|number| format!("body {number}"));
        }
        let mut body = vec![u32::MAX; self.positions.len()];
        let mut names: Vec<String> = Vec::new();
        let mut known: HashMap<&str, u32> = HashMap::new();
        let mut number_of = |name| {
            *known.entry(name).or_insert_with(|| {
                names.push(str::to_owned(name));
                names.len() as u32 - 1
            })
        };
        for polygon in self.surface.iter().flat_map(|surface| surface.polygons()) {
            let number = number_of(polygon.labels.object.as_deref().unwrap_or(whole));
            polygon.corners.iter().for_each(|corner| body[corner.vertex as usize] = number);
        }
        // Lines and points, which have no labels.
        for &vertex in self.strands.iter().flatten().chain(&self.particles) {
            if body[vertex as usize] == u32::MAX {
                body[vertex as usize] = number_of(whole);
            }
        }
        // Vertices of no element belong to the first part.
        body.iter_mut().filter(|number| **number == u32::MAX).for_each(|number| *number = 0);
        if names.is_empty() {
            names.push(whole.to_owned());
        }
        (self.body, self.names) = (Some(body), names);
    }

    /// Names the bodies without a name by their numbers, and numbers them anew, in order, behind those that have one:
    /// any numbers may stand in a file, and there must not be a name for each below the largest.
    pub(crate) fn name_bodies(&mut self, name: impl Fn(u32) -> String) {
        let Some(body) = &mut self.body else { return };
        let named = self.names.len() as u32;
        let mut nameless: Vec<u32> = body.iter().copied().filter(|&number| number >= named).collect();
        nameless.sort_unstable();
        nameless.dedup();
        for number in body.iter_mut().filter(|number| **number >= named) {
            *number = named + nameless.partition_point(|other| *other < *number) as u32;
        }
        self.names.extend(nameless.into_iter().map(name));
    }

    /// Keeps the vertices of some bodies, with what is made of them; they are numbered anew, in order.
    ///
    /// # Errors
    /// The number of another body, if an element has vertices of both. The mesh is then as it was.
    fn keep_parts(&mut self, bodies: &[usize]) -> Result<(), usize> {
        let Some(body) = &self.body else { return Ok(()) };
        let mut new: Vec<Option<u32>> = vec![None; self.names.len()];
        (0..).zip(bodies).for_each(|(index, &number)| new[number] = Some(index));
        let number = |v: u32| new[body[v as usize] as usize];
        let elements = self.triangles.iter().map(|t| &t[..]).chain(self.tets.iter().map(|t| &t[..]));
        for element in elements.chain(self.strands.iter().map(|e| &e[..])) {
            if element.iter().any(|&v| number(v).is_some())
                && let Some(&other) = element.iter().find(|&&v| number(v).is_none())
            {
                return Err(body[other as usize] as usize);
            }
        }
        let keep: Vec<bool> = body.iter().map(|&number| new[number as usize].is_some()).collect();
        let mut next = 0;
        let local: Vec<u32> = keep
            .iter()
            .map(|&keep| {
                next += u32::from(keep);
                next.saturating_sub(1)
            })
            .collect();
        let stays = |v: u32| keep[v as usize];
        self.triangles.retain(|t| stays(t[0]));
        self.tets.retain(|t| stays(t[0]));
        self.strands.retain(|e| stays(e[0]));
        self.particles.retain(|&v| stays(v));
        let renumber = |v: &mut u32| *v = local[*v as usize];
        self.triangles.iter_mut().flatten().for_each(renumber);
        self.tets.iter_mut().flatten().for_each(renumber);
        self.strands.iter_mut().flatten().for_each(renumber);
        self.particles.iter_mut().for_each(renumber);
        let part_of: Vec<u32> = keep.iter().map(|&keep| u32::from(!keep)).collect();
        self.surface =
            self.surface.take().and_then(|surface| surface.split(&part_of, &local, 2).swap_remove(0));
        self.groups.renumber(|v| stays(v).then(|| local[v as usize]));
        self.groups.drop_empty();
        let body: Vec<u32> = body.iter().filter_map(|&number| new[number as usize]).collect();
        self.body = Some(body);
        self.positions = filtered(&self.positions, &keep);
        self.obstacle = self.obstacle.as_ref().map(|obstacle| filtered(obstacle, &keep));
        self.names = bodies.iter().map(|&number| self.names[number].clone()).collect();
        Ok(())
    }
}

fn filtered<T: Copy>(values: &[T], keep: &[bool]) -> Vec<T> {
    values.iter().zip(keep).filter(|(_, keep)| **keep).map(|(value, _)| *value).collect()
}
