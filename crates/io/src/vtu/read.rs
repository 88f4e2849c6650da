//! Meshes from `.vtu` files.

use super::cells::Cells;
use super::data::{Fault, Storage, line, offset};
use crate::error::{IoError, Place};
use crate::import::{Import, without_mark};
use crate::mesh::Mesh;
use roxmltree::{Document, Node};
use std::path::Path;

/// Reads an unstructured grid: tetrahedra, triangles, quadrilaterals, polygons, lines as strands, vertices as
/// particles; of cells of higher order their corners. Elements that are the boundary of others are left out, as
/// of a Gmsh file; the number of cells of other types is logged as a warning. Pieces are joined. The point
/// arrays `body` and `obstacle` are those of [`write_vtu`](super::write_vtu); each other one of a single
/// component is a group of the vertices where it is not 0.
///
/// # Errors
/// A malformed or truncated file, other grids, compressors than that of zlib, coordinates that are not
/// finite, vertices that do not exist; with the line or the cell. A grid without points is [`IoError::Empty`].
pub(crate) fn read_vtu(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    let (mesh, notes) =
        parse(bytes, import).map_err(|(place, message)| IoError::content(path, place, message))?;
    if mesh.positions.is_empty() {
        return Err(IoError::Empty { path: path.to_owned(), message: "it has no vertices" });
    }
    for note in notes {
        tracing::warn!("{}: {note}", path.display());
    }
    Ok(mesh)
}

/// The mesh, and what was skipped, in words.
pub(super) fn parse(bytes: &[u8], import: &Import) -> Result<(Mesh, Vec<String>), Fault> {
    let (text, appended) = split_appended(without_mark(bytes))?;
    let document = Document::parse(&text).map_err(|error| {
        let message = format!("not a file of VTK, or a truncated one: {error}");
        (Place::Line(error.pos().row as usize), message)
    })?;
    let (storage, grid) = grid(&document, appended)?;
    let mut reader = Reader { storage, import, mesh: Mesh::default(), cells: Cells::default() };
    grid.children().filter(|node| node.has_tag_name("Piece")).try_for_each(|piece| reader.piece(piece))?;
    reader.finish()
}

/// The elements as text, with the ends that are missing before what is appended, and that, which is no XML if it
/// is raw.
fn split_appended(bytes: &[u8]) -> Result<(String, &[u8]), Fault> {
    let find = |bytes: &[u8], word: &[u8]| bytes.windows(word.len()).position(|window| window == word);
    let Some(tag) = find(bytes, b"<AppendedData") else {
        return Ok((String::from_utf8_lossy(bytes).into_owned(), &[]));
    };
    let truncated = || (Place::File, "truncated: the element AppendedData has no end".to_owned());
    let end = tag + find(&bytes[tag..], b">").ok_or_else(truncated)? + 1;
    let (head, rest) = bytes.split_at(end);
    let closing = b"</AppendedData>";
    // From the end: what is raw may hold anything.
    let content = rest.windows(closing.len()).rposition(|window| window == closing).ok_or_else(truncated)?;
    let content = rest[..content].trim_ascii_start().strip_prefix(b"_");
    let content =
        content.ok_or_else(|| (Place::File, "an underscore must stand before appended data".to_owned()))?;
    Ok((String::from_utf8_lossy(head).into_owned() + "</AppendedData></VTKFile>", content))
}

/// The grid, and how its arrays are stored.
fn grid<'d, 'i>(
    document: &'d Document<'i>,
    appended: &'d [u8],
) -> Result<(Storage<'d>, Node<'d, 'i>), Fault> {
    let file = document.root_element();
    let fault = |message: String| (line(document, file), message);
    if !file.has_tag_name("VTKFile") {
        return Err(fault(format!("not a file of VTK: it holds {}", file.tag_name().name())));
    }
    let attribute = |name: &str, default| file.attribute(name).unwrap_or(default);
    let kind = attribute("type", "nothing");
    let grid = file.children().find(|node| node.has_tag_name("UnstructuredGrid"));
    let Some(grid) = grid.filter(|_| kind == "UnstructuredGrid") else {
        return Err(fault(format!("it holds {kind}, only UnstructuredGrid is read: save it as such")));
    };
    let is_big_endian = match attribute("byte_order", "LittleEndian") {
        "LittleEndian" => false,
        "BigEndian" => true,
        other => return Err(fault(format!("byte_order {other} must be LittleEndian or BigEndian"))),
    };
    let length_size = match attribute("header_type", "UInt32") {
        "UInt32" => 4,
        "UInt64" => 8,
        other => return Err(fault(format!("header_type {other} must be UInt32 or UInt64"))),
    };
    let compressor = file.attribute("compressor").filter(|name| !name.is_empty());
    let element = file.children().find(|node| node.has_tag_name("AppendedData"));
    let is_appended_raw = match element.and_then(|element| element.attribute("encoding")).unwrap_or("base64")
    {
        "raw" => true,
        "base64" => false,
        other => return Err(fault(format!("encoding {other} of appended data must be raw or base64"))),
    };
    let mut offsets: Vec<usize> = grid.descendants().filter_map(offset).collect();
    offsets.sort_unstable();
    let storage = Storage { is_big_endian, length_size, compressor, appended, is_appended_raw, offsets };
    Ok((storage, grid))
}

struct Reader<'a> {
    storage: Storage<'a>,
    import: &'a Import,
    mesh: Mesh,
    cells: Cells,
}

impl Reader<'_> {
    fn piece(&mut self, piece: Node<'_, '_>) -> Result<(), Fault> {
        let fault = |message: String| (line(piece.document(), piece), message);
        let count = |name: &str| -> Result<usize, Fault> {
            let text = piece.attribute(name).unwrap_or("");
            text.trim().parse().map_err(|_| fault(format!("{name} '{text}' is no number from 0 on")))
        };
        let (points, cells) = (count("NumberOfPoints")?, count("NumberOfCells")?);
        let first = self.mesh.positions.len();
        if points > u32::MAX as usize - first {
            return Err(fault(format!("more than {} vertices", u32::MAX)));
        }
        if points > 0 {
            let array = child(piece, "Points").and_then(|points| child(points, "DataArray"));
            let array = array.ok_or_else(|| fault("the piece has no Points".to_owned()))?;
            let coordinates = self.array(array, points, 3)?;
            for (index, raw) in coordinates.as_chunks::<3>().0.iter().enumerate() {
                let point = self.import.finite_point(*raw);
                let at = |message| (Place::Element("point".to_owned(), first + index), message);
                self.mesh.positions.push(point.map_err(at)?);
            }
        }
        self.point_data(piece, first)?;
        if cells > 0 { self.cells(piece, cells, first) } else { Ok(()) }
    }

    /// The numbers of an array of so many entries.
    fn array(&self, array: Node<'_, '_>, entries: usize, components: usize) -> Result<Vec<f64>, Fault> {
        let numbers = self.storage.numbers(array)?;
        if Some(numbers.len()) == entries.checked_mul(components) {
            return Ok(numbers);
        }
        let name = array.attribute("Name").unwrap_or("without a name");
        let each = if components == 1 { String::new() } else { format!(" times {components}") };
        let message = format!("array {name}: {} numbers where {entries}{each} are declared", numbers.len());
        Err((line(array.document(), array), message))
    }

    fn cells(&mut self, piece: Node<'_, '_>, count: usize, first: usize) -> Result<(), Fault> {
        let named = |name: &str| {
            let array = child(piece, "Cells")
                .and_then(|cells| cells.children().find(|array| array.attribute("Name") == Some(name)));
            array.ok_or_else(|| (line(piece.document(), piece), format!("its Cells have no array {name}")))
        };
        let connectivity = self.storage.numbers(named("connectivity")?)?;
        let offsets = self.array(named("offsets")?, count, 1)?;
        let types = self.array(named("types")?, count, 1)?;
        let points = self.mesh.positions.len() - first;
        let (mut start, mut vertices) = (0, Vec::new());
        for (index, (&end, &kind)) in offsets.iter().zip(&types).enumerate() {
            let fault = |message: String| (Place::Element("cell".to_owned(), index), message);
            // Not by `<`, which is false for NaN.
            if !(start as f64 <= end && end <= connectivity.len() as f64) {
                let message =
                    format!("it ends at {end}, the one before at {start}, all at {}", connectivity.len());
                return Err(fault(message));
            }
            vertices.clear();
            for &number in &connectivity[start..end as usize] {
                if !(0.0..points as f64).contains(&number) {
                    return Err(fault(format!(
                        "vertex {number}, but the piece has {points}, counted from 0"
                    )));
                }
                vertices.push((first + number as usize) as u32);
            }
            start = end as usize;
            self.cells.add(kind as u8, &vertices).map_err(fault)?;
        }
        Ok(())
    }

    /// Arrays with one number for each point, the first of which is vertex `first`.
    fn point_data(&mut self, piece: Node<'_, '_>, first: usize) -> Result<(), Fault> {
        let count = self.mesh.positions.len() - first;
        let arrays = child(piece, "PointData").into_iter().flat_map(|data| data.children());
        for array in arrays.filter(|array| array.has_tag_name("DataArray")) {
            let components = array.attribute("NumberOfComponents").unwrap_or("1").trim();
            let name = array.attribute("Name").unwrap_or("");
            if components != "1" || name.is_empty() || array.attribute("type") == Some("String") {
                continue;
            }
            let numbers = self.array(array, count, 1)?;
            match name {
                "obstacle" => {
                    // Of pieces that do not say it, nothing is.
                    let obstacle = self.mesh.obstacle.get_or_insert_default();
                    obstacle.resize(first, false);
                    obstacle.extend(numbers.iter().map(|&number| number != 0.0));
                }
                "body" => {
                    let is_body =
                        |number: &f64| (0.0..=f64::from(i32::MAX)).contains(number) && number.fract() == 0.0;
                    if let Some((index, number)) =
                        numbers.iter().enumerate().find(|(_, number)| !is_body(number))
                    {
                        let message = format!("body {number} must be a whole number from 0 to {}", i32::MAX);
                        return Err((Place::Element("point".to_owned(), first + index), message));
                    }
                    let body = self.mesh.body.get_or_insert_default();
                    body.resize(first, 0);
                    body.extend(numbers.iter().map(|&number| number as u32));
                }
                _ => {
                    // NaN says nothing.
                    let members = numbers.iter().enumerate().filter(|(_, number)| number.abs() > 0.0);
                    self.mesh.groups.add(name, members.map(|(index, _)| (first + index) as u32));
                }
            }
        }
        Ok(())
    }

    fn finish(self) -> Result<(Mesh, Vec<String>), Fault> {
        let Self { mesh, cells, .. } = self;
        let notes = cells.notes();
        let count = mesh.positions.len();
        if count > 0 && cells.elements.is_empty() {
            let notes = if notes.is_empty() { String::new() } else { format!(" ({})", notes.join("; ")) };
            return Err((Place::File, format!("no tetrahedra, polygons, lines or vertices in it{notes}")));
        }
        let Mesh { positions, obstacle, body, groups, .. } = mesh;
        let mut mesh = Mesh { obstacle, body, ..cells.elements.into_mesh(positions, groups) };
        mesh.obstacle.iter_mut().for_each(|obstacle| obstacle.resize(count, false));
        mesh.body.iter_mut().for_each(|body| body.resize(count, 0));
        Ok((mesh, notes))
    }
}

fn child<'d, 'i>(node: Node<'d, 'i>, name: &str) -> Option<Node<'d, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}
