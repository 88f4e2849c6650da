use super::read::parse;
use super::*;
use crate::import::Import;
use crate::mesh::Mesh;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bowknot_geometry::Point;
use flate2::{Compression, write::ZlibEncoder};
use std::io::Write;

/// Where and how the content of arrays stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Text,
    Inline,
    AppendedRaw,
    AppendedBase64,
}

#[derive(Clone, Copy, Debug)]
struct Encoding {
    form: Form,
    is_big_endian: bool,
    /// Lengths of eight bytes.
    is_long: bool,
    is_compressed: bool,
}

fn encodings() -> Vec<Encoding> {
    let mut all = Vec::new();
    for form in [Form::Text, Form::Inline, Form::AppendedRaw, Form::AppendedBase64] {
        for flags in 0..8 {
            let [is_big_endian, is_long, is_compressed] = [1, 2, 4].map(|bit| flags & bit > 0);
            all.push(Encoding { form, is_big_endian, is_long, is_compressed });
        }
    }
    all
}

/// An array of a type; its numbers.
type Array = (&'static str, &'static str, Vec<f64>);

/// Number of points and of cells, and the arrays by the element that they stand in.
type Piece = (usize, usize, [(&'static str, Vec<Array>); 3]);

/// Numbers of the type as bytes.
fn bytes_of(kind: &str, numbers: &[f64], is_big_endian: bool) -> Vec<u8> {
    let bytes = |number: &f64| -> Vec<u8> {
        let mut bytes = match kind {
            "UInt8" => vec![*number as u8],
            "Int16" => (*number as i16).to_le_bytes().to_vec(),
            "Int32" => (*number as i32).to_le_bytes().to_vec(),
            "Int64" => (*number as i64).to_le_bytes().to_vec(),
            "Float32" => (*number as f32).to_le_bytes().to_vec(),
            _ => number.to_le_bytes().to_vec(),
        };
        if is_big_endian {
            bytes.reverse();
        }
        bytes
    };
    numbers.iter().flat_map(bytes).collect()
}

impl Encoding {
    fn length(self, length: usize) -> Vec<u8> {
        let mut bytes = (length as u64).to_le_bytes()[..if self.is_long { 8 } else { 4 }].to_vec();
        if self.is_big_endian {
            bytes.reverse();
        }
        bytes
    }

    /// The lengths before the content, and the content in blocks of 16 bytes if it is compressed.
    fn content(self, kind: &str, numbers: &[f64]) -> [Vec<u8>; 2] {
        let bytes = bytes_of(kind, numbers, self.is_big_endian);
        if !self.is_compressed {
            return [self.length(bytes.len()), bytes];
        }
        let mut lengths = Vec::new();
        lengths.extend(self.length(bytes.len().div_ceil(16)));
        lengths.extend(self.length(16));
        lengths.extend(self.length(bytes.len() % 16));
        let mut content = Vec::new();
        for block in bytes.chunks(16) {
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(block).unwrap();
            let block = encoder.finish().unwrap();
            lengths.extend(self.length(block.len()));
            content.extend(block);
        }
        [lengths, content]
    }

    /// A file of pieces.
    fn file(self, pieces: &[Piece]) -> Vec<u8> {
        let endian = if self.is_big_endian { "BigEndian" } else { "LittleEndian" };
        let header = if self.is_long { " header_type=\"UInt64\"" } else { "" };
        let compressor = if self.is_compressed { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let mut out = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"{endian}\"{header}{compressor}>\n\
             <UnstructuredGrid>\n<FieldData><DataArray type=\"String\" Name=\"by\" format=\"ascii\">65 \
             0</DataArray></FieldData>\n"
        )
        .into_bytes();
        let mut appended: Vec<u8> = Vec::new();
        for (points, cells, elements) in pieces {
            out.extend(format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n").bytes());
            for (element, arrays) in elements {
                out.extend(format!("<{element}>\n").bytes());
                for (kind, name, numbers) in arrays {
                    let components = if *name == "x" || *name == "velocity" { 3 } else { 1 };
                    let start = format!(
                        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
                    );
                    let [lengths, content] = self.content(kind, numbers);
                    let base64 = STANDARD.encode(&lengths) + &STANDARD.encode(&content);
                    let text: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
                    let offset = appended.len();
                    out.extend(
                        match self.form {
                            Form::Text => {
                                format!("{start} format=\"ascii\">\n{}\n</DataArray>\n", text.join(" "))
                            }
                            Form::Inline => format!("{start} format=\"binary\">\n  {base64}\n</DataArray>\n"),
                            _ => format!("{start} format=\"appended\" offset=\"{offset}\"/>\n"),
                        }
                        .bytes(),
                    );
                    match self.form {
                        Form::AppendedRaw => appended.extend([lengths, content].concat()),
                        Form::AppendedBase64 => appended.extend(base64.bytes()),
                        _ => {}
                    }
                }
                out.extend(format!("</{element}>\n").bytes());
            }
            out.extend(b"</Piece>\n");
        }
        out.extend(b"</UnstructuredGrid>\n");
        if matches!(self.form, Form::AppendedRaw | Form::AppendedBase64) {
            let encoding = if self.form == Form::AppendedRaw { "raw" } else { "base64" };
            out.extend(format!("<AppendedData encoding=\"{encoding}\">\n  _").bytes());
            out.extend(appended);
            out.extend(b"\n</AppendedData>\n");
        }
        out.extend(b"</VTKFile>\n");
        out
    }
}

/// The arrays of a piece: coordinates, cells as types and vertices, arrays of points.
fn piece(x: &[f64], cells: &[(u8, &[u32])], data: Vec<Array>) -> Piece {
    let mut end = 0;
    let ends = cells.iter().map(|(_, vertices)| {
        end += vertices.len();
        end as f64
    });
    let arrays = vec![
        (
            "Int32",
            "connectivity",
            cells.iter().flat_map(|(_, vertices)| vertices.iter().map(|&v| f64::from(v))).collect(),
        ),
        ("Int64", "offsets", ends.collect()),
        ("UInt8", "types", cells.iter().map(|(kind, _)| f64::from(*kind)).collect()),
    ];
    let points = vec![("Float64", "x", x.to_vec())];
    (x.len() / 3, cells.len(), [("PointData", data), ("Points", points), ("Cells", arrays)])
}

/// Coordinates of so many points that no careless print keeps.
fn points(count: usize) -> Vec<f64> {
    (0..3 * count).map(|k| (k * k) as f64 / 3.0).collect()
}

const PLAIN: Encoding =
    Encoding { form: Form::Text, is_big_endian: false, is_long: false, is_compressed: false };

/// A tetrahedron with a face and an edge of its own, and a quadrilateral; then a line and a vertex.
fn sample(encoding: Encoding) -> Vec<u8> {
    let cells: [(u8, &[u32]); 4] = [(10, &[0, 1, 2, 3]), (5, &[0, 2, 1]), (3, &[0, 1]), (9, &[4, 5, 6, 3])];
    let data = vec![
        ("Int16", "hem", vec![0.0, 1.0, 0.0, -3.0, 0.0, 0.0, 2.0]),
        ("Float32", "velocity", vec![1.0; 21]),
        ("UInt8", "obstacle", vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
    ];
    let second = vec![("Float32", "heat", vec![0.0, 0.25, -0.0]), ("Int64", "body", vec![7.0; 3])];
    encoding.file(&[piece(&points(7), &cells, data), piece(&points(3), &[(3, &[0, 1]), (1, &[2])], second)])
}

fn expected() -> Mesh {
    let positions = [points(7), points(3)].concat();
    let mut mesh = Mesh {
        positions: positions.as_chunks::<3>().0.iter().map(|p| Point::from(*p)).collect(),
        tets: vec![[0, 1, 2, 3]],
        triangles: vec![[4, 5, 6], [4, 6, 3]],
        strands: vec![[7, 8]],
        particles: vec![9],
        obstacle: Some((0..10).map(|v| (4..7).contains(&v)).collect()),
        body: Some((0..10).map(|v| if v < 7 { 0 } else { 7 }).collect()),
        ..Mesh::default()
    };
    mesh.groups.add("hem", [1, 3, 6]);
    mesh.groups.add("heat", [8]);
    mesh
}

fn read(bytes: &[u8]) -> Result<(Mesh, Vec<String>), String> {
    parse(bytes, &Import::default()).map_err(|(place, message)| format!("a.vtu{place}: {message}"))
}

#[test]
fn every_encoding_gives_the_same_mesh() {
    for encoding in encodings() {
        let (mesh, notes) = read(&sample(encoding)).unwrap_or_else(|error| panic!("{encoding:?}: {error}"));
        assert_eq!(mesh.surface.as_ref().map(|surface| surface.len()), Some(1), "{encoding:?}");
        assert_eq!(Mesh { surface: None, ..mesh }, expected(), "{encoding:?}");
        assert_eq!(notes, [""; 0]);
    }
    let windows = String::from_utf8(sample(PLAIN)).unwrap().replace('\n', "\r\n");
    assert_eq!(read(windows.as_bytes()).unwrap().0.groups, expected().groups);
}

#[test]
fn what_is_written_comes_back() {
    let mesh = Mesh {
        tets: vec![],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        obstacle: Some((0..10).map(|v| v > 6).collect()),
        body: Some((0..10).collect()),
        groups: crate::Groups::default(),
        ..expected()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    write_vtu(&path, &mesh.view()).unwrap();
    let read = || read_vtu(&path, &std::fs::read(&path).unwrap(), &Import::default());
    assert_eq!(read().unwrap(), mesh);
    write_vtu(&path, &Mesh::default().view()).unwrap();
    assert!(matches!(read(), Err(crate::IoError::Empty { .. })));
}

#[test]
fn other_cells_give_their_elements_or_are_counted() {
    let cells: [(u8, &[u32]); 11] = [
        (2, &[0, 1]),
        (4, &[2, 3, 4]),
        (6, &[5, 6, 7, 8]),
        (7, &[5, 6, 7, 8, 9]),
        (8, &[5, 6, 8, 7]),
        (22, &[5, 7, 9, 0, 1, 2]),
        (24, &[6, 8, 9, 4, 0, 1, 2, 3, 5, 7]),
        (36, &[5, 6, 7, 1, 2, 3]),
        (12, &[0, 1, 2, 3, 4, 5, 6, 7]),
        (12, &[0, 1, 2, 3, 4, 5, 6, 7]),
        (99, &[]),
    ];
    let (mesh, notes) = read(&PLAIN.file(&[piece(&points(10), &cells, vec![])])).unwrap();
    assert_eq!(mesh.tets, [[6, 8, 9, 4]]);
    assert_eq!(mesh.strands, [[2, 3], [3, 4]]);
    assert_eq!(mesh.particles, [0, 1]);
    let strip = [[5, 6, 7], [7, 6, 8]];
    let fan = [[5, 6, 7], [5, 7, 8], [5, 8, 9]];
    let rest = [[5, 6, 7], [5, 7, 8], [5, 7, 9], [5, 6, 7]];
    assert_eq!(mesh.triangles, [&strip[..], &fan, &rest].concat());
    let expected = [
        "skipped 2 hexahedra",
        "took the corners only of 1 quadratic triangles",
        "took the corners only of 1 quadratic tetrahedra",
        "took the corners only of 1 quadratic polygons",
        "skipped 1 of the cell type 99",
    ];
    assert_eq!(notes, expected);
}

#[test]
fn every_truncation_is_refused() {
    for encoding in encodings() {
        let whole = sample(encoding);
        // What is appended must be whole, with its end; elements all have theirs.
        let needed = match encoding.form {
            Form::Text | Form::Inline => whole.len() - 1,
            _ => whole.len() - "\n</VTKFile>\n".len(),
        };
        for length in 0..needed {
            assert!(read(&whole[..length]).is_err(), "{encoding:?}: {length} of {needed} bytes");
        }
        assert!(read(&whole[..needed]).is_ok());
    }
}

#[test]
fn damaged_files_are_read_or_refused_but_never_panic() {
    let mut random = fastrand::Rng::with_seed(1);
    for encoding in encodings() {
        let whole = sample(encoding);
        for _ in 0..60 {
            let mut bytes = whole.clone();
            for _ in 0..1 + random.usize(..4) {
                let at = random.usize(..bytes.len());
                bytes[at] = if random.bool() { random.u8(..) } else { b'0' + random.u8(..10) };
            }
            // Lengths that are absurd, of four and of eight bytes.
            if random.bool() {
                let at = random.usize(..bytes.len() - 8);
                bytes[at..at + random.usize(4..9)].fill(0xff);
            }
            let _ = read(&bytes);
        }
    }
}

#[test]
fn elements_may_be_nested_deeply() {
    let nested = "<a>".repeat(100_000);
    assert!(read(nested.as_bytes()).is_err());
}

#[test]
fn faults_name_the_line_or_the_cell() {
    let text = String::from_utf8(sample(PLAIN)).unwrap();
    for (from, to, words) in [
        ("<?xml", "xml", "a.vtu:1: not a file of VTK, or a truncated one"),
        ("VTKFile", "Collection", "a.vtu:2: not a file of VTK: it holds Collection"),
        ("UnstructuredGrid", "PolyData", "a.vtu:2: it holds PolyData, only UnstructuredGrid is read"),
        ("LittleEndian", "Middle", "a.vtu:2: byte_order Middle must be"),
        ("LittleEndian\"", "LittleEndian\" header_type=\"Int\"", "a.vtu:2: header_type Int must be"),
        (
            "NumberOfPoints=\"7\"",
            "NumberOfPoints=\"8\"",
            "a.vtu:18: array x: 21 numbers where 8 times 3 are declared",
        ),
        (
            "NumberOfPoints=\"7\"",
            "NumberOfPoints=\"9999999999999999\"",
            "a.vtu:5: more than 4294967295 vertices",
        ),
        (
            "NumberOfPoints=\"7\"",
            "NumberOfPoints=\"-1\"",
            "a.vtu:5: NumberOfPoints '-1' is no number from 0 on",
        ),
        ("NumberOfCells=\"4\"", "NumberOfCells=\"5\"", "array offsets: 4 numbers where 5 are declared"),
        ("Name=\"types\"", "Name=\"kinds\"", "a.vtu:5: its Cells have no array types"),
        (
            "format=\"ascii\">\n0.0 1.0 0.0 -3.0",
            "format=\"text\">\n0.0 1.0 0.0 -3.0",
            "a.vtu:7: array hem: format text must be ascii",
        ),
        ("0.0 1.0 0.0 -3.0", "0.0 one 0.0 -3.0", "a.vtu:7: array hem: 'one' is not a number"),
        ("0.0 1.0 0.0 -3.0", "0.0 1.0 0.0", "a.vtu:7: array hem: 6 numbers where 7 are declared"),
        ("0.0 0.3333333333333333 ", "0.0 inf ", "a.vtu: point 0: coordinates [0.0, inf,"),
        (
            "0.0 1.0 2.0 3.0 0.0 2.0 1.0",
            "0.0 1.0 2.0 3.0 0.0 7.0 1.0",
            "a.vtu: cell 1: vertex 7, but the piece has 7",
        ),
        ("0.0 1.0 2.0 3.0 0.0 2.0 1.0", "0.0 1.0 2.0 3.0 0.0 -1.0 1.0", "a.vtu: cell 1: vertex -1"),
        (
            "4.0 7.0 9.0 13.0",
            "4.0 3.0 9.0 13.0",
            "a.vtu: cell 1: it ends at 3, the one before at 4, all at 13",
        ),
        ("4.0 7.0 9.0 13.0", "4.0 6.0 9.0 13.0", "a.vtu: cell 1: 2 vertices; triangles have 3 at least"),
        ("4.0 7.0 9.0 13.0", "4.0 7.0 9.0 14.0", "a.vtu: cell 3: it ends at 14"),
        ("7.0 7.0 7.0", "7.0 0.5 7.0", "a.vtu: point 8: body 0.5 must be a whole number"),
    ] {
        assert!(text.contains(from), "{from:?} is not in the file:\n{text}");
        let all = matches!(from, "VTKFile" | "UnstructuredGrid");
        let changed = if all { text.replace(from, to) } else { text.replacen(from, to, 1) };
        let error = read(changed.as_bytes()).unwrap_err();
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
    }
    let empty = PLAIN.file(&[piece(&points(8), &[(12, &[0, 1, 2, 3, 4, 5, 6, 7])], vec![])]);
    let error = read(&empty).unwrap_err();
    assert!(
        error.contains("no tetrahedra, polygons, lines or vertices in it (skipped 1 hexahedra)"),
        "{error}"
    );

    // Text is not compressed, whatever the file says.
    let foreign = |form| {
        let text = String::from_utf8(sample(Encoding { form, ..PLAIN })).unwrap();
        text.replace("LittleEndian\"", "LittleEndian\" compressor=\"vtkLZ4DataCompressor\"")
    };
    assert_eq!(read(foreign(Form::Text).as_bytes()).unwrap().0.groups, expected().groups);
    let error = read(foreign(Form::Inline).as_bytes()).unwrap_err();
    assert!(error.contains("a.vtu:18: array x: compressor vtkLZ4DataCompressor is not read"), "{error}");

    let compressed = Encoding { form: Form::AppendedRaw, is_compressed: true, ..PLAIN };
    let mut bytes = sample(compressed);
    let start = bytes.windows(3).rposition(|window| window == b"  _").unwrap() + 3;
    bytes[start + 16] ^= 0x55;
    let error = read(&bytes).unwrap_err();
    assert!(error.contains("a.vtu:7: array hem: block 0 is no stream of zlib"), "{error}");
    bytes[start..start + 4].fill(0xff);
    let error = read(&bytes).unwrap_err();
    assert!(error.contains("a.vtu:7: array hem: truncated: 4294967295 blocks are declared"), "{error}");
}
