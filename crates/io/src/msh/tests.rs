use super::*;
use crate::groups::Groups;
use bowknot_geometry::Point;

/// One entry per element: its type, its node numbers.
type Element = (i64, Vec<i64>);

/// The forms of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Text2,
    Binary2,
    Text4,
    Binary4,
    /// Counts of four bytes.
    Binary4Short,
}

const FORMS: [Form; 5] = [Form::Text2, Form::Binary2, Form::Text4, Form::Binary4, Form::Binary4Short];

/// A tetrahedron beside a lone triangle, a lone line and a lone point, with the boundary elements that Gmsh
/// writes; numbers that are neither dense nor ascending.
fn nodes() -> Vec<(i64, [f64; 3])> {
    vec![
        (7, [0.1, 1.0 / 3.0, -2.5e-7]),
        (3, [1.0, 0.0, 0.0]),
        (50, [0.0, 1.0, 0.0]),
        (51, [0.0, 0.0, 1.0]),
        (2, [5.0, 0.0, 0.0]),
        (1, [6.0, 0.0, 0.0]),
        (90, [5.0, 1.0, 0.0]),
        (91, [9.0, 1.0, 0.0]),
    ]
}

fn elements() -> Vec<Element> {
    vec![
        (15, vec![7]),
        (15, vec![91]),
        (1, vec![3, 7]),
        (1, vec![90, 91]),
        (2, vec![50, 3, 7]),
        (2, vec![2, 1, 90]),
        (4, vec![7, 3, 50, 51]),
    ]
}

fn expected() -> Mesh {
    let mut groups = Groups::default();
    groups.add("caf\u{fffd} $Nodes", [0, 1, 2, 4, 5, 6]);
    groups.add("point-7", [0, 7]);
    Mesh {
        groups,
        positions: nodes().into_iter().map(|(_, p)| Point::from(p)).collect(),
        tets: vec![[0, 1, 2, 3]],
        triangles: vec![[4, 5, 6]],
        strands: vec![[6, 7]],
        ..Mesh::default()
    }
}

/// The physical group of the elements of a type, negative for a reversed orientation, and its dimension.
fn physical(kind: i64) -> (i64, i64) {
    match kind {
        15 => (7, 0),
        1 | 8 => (0, 1),
        2 | 9 => (-1, 2),
        _ => (0, 3),
    }
}

/// A file of these nodes and elements, each element in a block of its own, with sections that are to be
/// skipped.
fn file(form: Form, nodes: &[(i64, [f64; 3])], elements: &[Element]) -> Vec<u8> {
    let binary = matches!(form, Form::Binary2 | Form::Binary4 | Form::Binary4Short);
    let v2 = matches!(form, Form::Text2 | Form::Binary2);
    let mut out = Vec::new();
    let size = if form == Form::Binary4Short { 4 } else { 8 };
    let version = if v2 { "2.2" } else { "4.1" };
    out.extend(format!("$MeshFormat\n{version} {} {size}\n", u8::from(binary)).bytes());
    if binary {
        out.extend(1_i32.to_le_bytes());
        out.push(b'\n');
    }
    out.extend(b"$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"caf\xe9 $Nodes\"\n$EndPhysicalNames\n");
    let int = |out: &mut Vec<u8>, value: i64| match binary {
        true => out.extend((value as i32).to_le_bytes()),
        false => out.extend(format!("{value} ").bytes()),
    };
    let count = |out: &mut Vec<u8>, value: i64| match form {
        Form::Binary4 => out.extend(value.to_le_bytes()),
        Form::Binary4Short => out.extend((value as u32).to_le_bytes()),
        _ => out.extend(format!("{value} ").bytes()),
    };
    let number = |out: &mut Vec<u8>, value: f64| match binary {
        true => out.extend(value.to_le_bytes()),
        false => out.extend(format!("{value:?} ").bytes()),
    };
    let newline = |out: &mut Vec<u8>| {
        if !binary {
            out.push(b'\n')
        }
    };

    if !v2 {
        // One entity of each dimension, number 1, the last three with two entities as their boundary.
        out.extend(b"$Entities\n");
        (0..4).for_each(|_| count(&mut out, 1));
        newline(&mut out);
        for (dimension, groups) in [(0, &[7][..]), (1, &[]), (2, &[-1]), (3, &[])] {
            int(&mut out, 1);
            (0..if dimension == 0 { 3 } else { 6 }).for_each(|_| number(&mut out, 0.5));
            count(&mut out, groups.len() as i64);
            groups.iter().for_each(|group| int(&mut out, *group));
            if dimension > 0 {
                count(&mut out, 2);
                [1, -1].iter().for_each(|n| int(&mut out, *n));
            }
            newline(&mut out);
        }
        out.extend(if binary { &b"\n$EndEntities\n"[..] } else { b"$EndEntities\n" });
    }
    out.extend(b"$Nodes\n");
    if v2 {
        out.extend(format!("{}\n", nodes.len()).bytes());
        for (tag, p) in nodes {
            int(&mut out, *tag);
            p.iter().for_each(|x| number(&mut out, *x));
            newline(&mut out);
        }
    } else {
        [2, nodes.len() as i64, 1, 99].iter().for_each(|n| count(&mut out, *n));
        newline(&mut out);
        // The second block lies on a surface, with two parameters a node.
        for (block, parametric) in [(&nodes[..1], false), (&nodes[1..], true)] {
            [2, 1, i64::from(parametric)].iter().for_each(|n| int(&mut out, *n));
            count(&mut out, block.len() as i64);
            newline(&mut out);
            block.iter().for_each(|(tag, _)| count(&mut out, *tag));
            newline(&mut out);
            for (_, p) in block {
                p.iter().for_each(|x| number(&mut out, *x));
                (0..if parametric { 2 } else { 0 }).for_each(|_| number(&mut out, 0.5));
                newline(&mut out);
            }
        }
    }
    out.extend(if binary { &b"\n$EndNodes\n$Elements\n"[..] } else { b"$EndNodes\n$Elements\n" });
    if v2 {
        out.extend(format!("{}\n", elements.len()).bytes());
    } else {
        [elements.len(), elements.len(), 1, 99].iter().for_each(|n| count(&mut out, *n as i64));
        newline(&mut out);
    }
    for (index, (kind, corners)) in elements.iter().enumerate() {
        let tag = index as i64 + 1;
        let (group, dimension) = physical(*kind);
        match form {
            Form::Text2 => [tag, *kind, 2, group, 5].iter().for_each(|n| int(&mut out, *n)),
            Form::Binary2 => [*kind, 1, 2, tag, group, 5].iter().for_each(|n| int(&mut out, *n)),
            _ => {
                [dimension, 1, *kind].iter().for_each(|n| int(&mut out, *n));
                count(&mut out, 1);
                newline(&mut out);
                count(&mut out, tag);
            }
        }
        corners.iter().for_each(|n| if v2 { int(&mut out, *n) } else { count(&mut out, *n) });
        newline(&mut out);
    }
    out.extend(if binary { &b"\n$EndElements\n"[..] } else { b"$EndElements\n" });
    out.extend(b"$Surface\n1\n1 2 3\n$EndSurface\n");
    out
}

fn read(bytes: &[u8]) -> Result<(Mesh, Vec<String>), String> {
    parse(bytes, &Import::default()).map_err(|(place, message)| format!("mesh.msh{place}: {message}"))
}

#[test]
fn every_form_gives_the_same_mesh() {
    for form in FORMS {
        assert_eq!(read(&file(form, &nodes(), &elements())), Ok((expected(), vec![])), "{form:?}");
    }
    let windows = String::from_utf8(file(Form::Text4, &nodes(), &elements()).replace_crlf()).unwrap();
    assert_eq!(read(windows.as_bytes()).unwrap().0, expected());
}

/// Line ends as Windows has them; the name that is no text goes.
trait ReplaceCrlf {
    fn replace_crlf(&self) -> Vec<u8>;
}

impl ReplaceCrlf for Vec<u8> {
    fn replace_crlf(&self) -> Vec<u8> {
        String::from_utf8_lossy(self).replace('\n', "\r\n").into_bytes()
    }
}

#[test]
fn a_file_of_a_volume_has_no_strands_on_its_surface() {
    let mesh = read(&file(Form::Binary4, &nodes(), &elements())).unwrap().0;
    let surface = mesh.into_surface();
    assert_eq!(surface.triangles.len(), 5);
    assert_eq!(surface.triangles[4], [4, 5, 6]);
    assert!(surface.tets.is_empty());
}

#[test]
fn higher_orders_give_their_corners_and_quads_two_triangles() {
    let nodes: Vec<(i64, [f64; 3])> = (1..=10).map(|n| (n, [n as f64, (n * n) as f64, 0.0])).collect();
    let elements = vec![
        (11, (1..=10).collect()),
        (9, vec![8, 9, 10, 1, 2, 3]),
        (8, vec![5, 9, 1]),
        (3, vec![5, 6, 7, 8]),
        (5, (1..=8).collect()),
    ];
    for form in FORMS {
        let (mesh, notes) = read(&file(form, &nodes, &elements)).unwrap();
        assert_eq!(mesh.tets, [[0, 1, 2, 3]], "{form:?}");
        assert_eq!(mesh.triangles, [[7, 8, 9], [4, 5, 6], [4, 6, 7]]);
        assert_eq!(mesh.strands, [[4, 8]]);
        assert_eq!(
            notes,
            [
                "skipped 1 hexahedra",
                "took the corners only of 1 lines of order 2",
                "took the corners only of 1 triangles of order 2",
                "took the corners only of 1 tetrahedra of order 2"
            ]
        );
    }
}

#[test]
fn unknown_types_are_skipped_in_text_and_refused_in_binary() {
    let mut elements = elements();
    elements.insert(1, (777, vec![1, 2, 3]));
    for form in FORMS {
        let result = read(&file(form, &nodes(), &elements));
        if matches!(form, Form::Text2 | Form::Text4) {
            let note = "skipped 1 element of the unknown type 777".to_owned();
            assert_eq!(result, Ok((expected(), vec![note])));
        } else {
            assert!(result.as_ref().unwrap_err().contains("element type 777 is unknown"), "{result:?}");
        }
    }
}

#[test]
fn every_truncation_is_refused() {
    for form in FORMS {
        let whole = file(form, &nodes(), &elements());
        let needed = whole.windows(12).position(|w| w == b"$EndElements").unwrap() + 12;
        for length in 0..needed {
            assert!(read(&whole[..length]).is_err(), "{form:?}: {length} of {needed} bytes");
        }
        assert_eq!(read(&whole[..needed]).unwrap().0, expected(), "{form:?}");
    }
}

#[test]
fn faults_name_the_line_and_the_remedy() {
    for (form, from, to, words) in [
        (Form::Text4, "$MeshFormat\n4.1", "$MeshFromat\n4.1", "mesh.msh: not a Gmsh file"),
        (Form::Text4, "4.1 0 8", "4.0 0 8", "mesh.msh:2: version 4.0 is not read, only 2.2 and 4.1: convert"),
        (Form::Text4, "4.1 0 8", "4.1 7 8", "mesh.msh:2: the line must say 0 (text) or 1 (binary)"),
        (
            Form::Text4,
            "2 1 \"",
            "2 x \"",
            "mesh.msh:6: '2 x \"caf\u{fffd} $Nodes\"' is not a dimension, a number",
        ),
        (Form::Text4, "$Entities\n1 ", "$Entities\n2 ", "'0.5' is not the number of physical groups"),
        (
            Form::Text4,
            "0.5 1 7 ",
            "0.5 99999999 7 ",
            "mesh.msh:10: truncated: 99999999 physical groups are declared",
        ),
        (Form::Text4, "$Nodes\n2 ", "$Nodes\n-2 ", "mesh.msh:16: '-2' is not the number of blocks"),
        (Form::Text4, "2 8 1 99", "2 8000000 1 99", "mesh.msh:16: truncated: 8000000 nodes are declared"),
        (Form::Text4, "2 8 1 99", "2 99999999999 1 99", "mesh.msh:16: 99999999999 nodes; at most"),
        (Form::Text4, "2 8 1 99", "2 7 1 99", "more nodes than the 7 declared"),
        (Form::Text4, "2 8 1 99", "2 9 1 99", "8 of the 9 declared nodes"),
        (Form::Text4, "2 8 1 99", "3 8 1 99", "the section ends where an entity's dimension is expected"),
        (Form::Text4, "3 50 51", "3 50 50", "node 50 is given twice"),
        (
            Form::Text4,
            "1.0 0.0 0.0",
            "1.0 inf 0.0",
            "mesh.msh:22: coordinates [1.0, inf, 0.0] of node 3 are not",
        ),
        (Form::Text4, "1.0 0.0 0.0", "1.0 x 0.0", "mesh.msh:22: 'x' is not a coordinate"),
        (Form::Text4, "7 7 1 99", "7 8 1 99", "7 of the 8 declared elements"),
        (Form::Text4, "7 7 1 99", "7 6 1 99", "more elements than the 6 declared"),
        (Form::Text4, "7 7 3 50 51", "7 7 3 50 52", "names node 52, which $Nodes does not have"),
        (Form::Text4, "$EndElements", "$EndElement", "$EndElements is expected"),
        (Form::Text4, "$EndNodes\n", "$EndNodes\n$Nodes\n", "a second section $Nodes"),
        (Form::Text4, "$EndSurface", "", "section $Surface has no end"),
        (Form::Text2, "$Nodes\n8", "$Nodes\neight", "mesh.msh:9: 'eight' is not the number of nodes"),
        (
            Form::Text2,
            "$Elements\n7",
            "$Elements\n8",
            "the section ends where an element's number is expected",
        ),
        (Form::Text2, "$Elements\n7", "$Elements\n6", "$EndElements is expected"),
        (Form::Text2, "7 4 2 0 5 ", "7 4 -2 0 5 ", "-2 tags"),
        (Form::Text2, "7 4 2 0 5 ", "7 4 999999999 0 5 ", "999999999 tags"),
    ] {
        let text = String::from_utf8_lossy(&file(form, &nodes(), &elements())).into_owned();
        assert!(text.contains(from), "{from:?} is not in the file:\n{text}");
        let error = read(text.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
        assert_eq!(error.lines().count(), 1);
    }
    let only = |elements: &[Element]| read(&file(Form::Text4, &nodes(), elements)).unwrap_err();
    assert!(only(&[]).contains("no tetrahedra, triangles, lines or points in it: mesh it"));
    assert!(only(&[(5, vec![7, 3, 50, 51, 2, 1, 90, 91])]).contains("(skipped 1 hexahedra)"));
}

#[test]
fn the_marker_of_size_and_byte_order_is_checked() {
    let whole = file(Form::Binary4, &nodes(), &elements());
    let marker = whole.windows(4).position(|w| w == 1_i32.to_le_bytes()).unwrap();
    let mut foreign = whole.clone();
    foreign[marker..marker + 4].reverse();
    let error = read(&foreign).unwrap_err();
    assert!(error.contains("byte 20: it is big-endian, only little-endian is read"), "{error}");
    foreign[marker] = 9;
    assert!(read(&foreign).unwrap_err().contains("byte order is not 1"));
    for size in [b'2', b'x'] {
        let mut other = whole.clone();
        other[marker - 2] = size;
        assert!(read(&other).unwrap_err().contains("the size of numbers must be 4 or 8"));
    }
}

/// A count of a binary file replaced by the largest there is.
#[test]
fn absurd_counts_are_refused_before_memory_is_asked_for() {
    for form in [Form::Binary2, Form::Binary4, Form::Binary4Short] {
        let whole = file(form, &nodes(), &elements());
        let start = whole.windows(7).position(|w| w == b"$Nodes\n").unwrap() + 7;
        for at in start..whole.len() - 8 {
            for width in [4, 8] {
                let mut bytes = whole.clone();
                bytes[at..at + width].fill(0xff);
                bytes[at + width - 1] = 0x0f;
                // Most are refused, and coordinates are only strange.
                let _ = read(&bytes);
            }
        }
    }
}
