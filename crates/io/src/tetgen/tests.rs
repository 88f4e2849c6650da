use super::*;
use std::fs;

/// Two tetrahedra with a boundary marker for each point and a region for each element.
const NODE: &str = "# points\n5 3 1 1\n\n  1 0 0 0  0.5 0\n2 1. 0 0 0.5 2 # on the left\n3 0 1e0 0 0.5 2\n4 0 0 1 0.5 -1\n\
                    5 1 1 1 0.5 0\n# end\n";
const ELE: &str = "2  4  1\n1 1 2 3 4 1\n2 2 3 4 5 2\n";

fn read(node: &str, ele: &str, given: &str) -> Result<Mesh, String> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.1.node"), node).unwrap();
    fs::write(at("a.1.ele"), ele).unwrap();
    read_tetgen(&at(given), &Import::default()).map_err(|error| error.to_string())
}

fn refusal(node: &str, ele: &str) -> String {
    read(node, ele, "a.1.ele").unwrap_err()
}

#[test]
fn either_file_finds_the_other() {
    let mesh = read(NODE, ELE, "a.1.node").unwrap();
    assert_eq!((mesh.positions.len(), mesh.positions[1]), (5, Point::new(1.0, 0.0, 0.0)));
    assert_eq!(mesh.tets, [[0, 1, 2, 3], [1, 2, 3, 4]]);
    let groups: Vec<(&str, &[u32])> = mesh.groups.iter().collect();
    let expected = [
        ("marker--1", &[3][..]),
        ("marker-2", &[1, 2]),
        ("region-1", &[0, 1, 2, 3]),
        ("region-2", &[1, 2, 3, 4]),
    ];
    assert_eq!(groups, expected);
    assert_eq!(read(NODE, ELE, "a.1.ele").unwrap(), mesh);
    let windows = |text: &str| text.replace('\n', "\r\n");
    assert_eq!(read(&windows(NODE), &windows(ELE), "a.1.ele").unwrap(), mesh);
    assert_eq!(read(NODE.trim_end(), ELE.trim_end(), "a.1.ele").unwrap(), mesh);
}

#[test]
fn numbers_may_count_from_0() {
    let node = "4\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";
    assert_eq!(read(node, "1\n0 3 2 1 0\n", "a.1.ele").unwrap().tets, [[3, 2, 1, 0]]);
    let error = refusal(node, "1\n0 3 2 1 4\n");
    assert!(error.contains("a.1.ele:2: there is no point 4 in the .node file"), "{error}");
}

#[test]
fn elements_of_order_2_and_of_the_plane() {
    let points: String = (1..=10).map(|k| format!("{k} {k} {} {} 0\n", k * k, k % 3)).collect();
    let mesh = read(&format!("10 3 0 1\n{points}"), "1 10 0\n1 4 3 2 1 5 6 7 8 9 10\n", "a.1.ele").unwrap();
    assert_eq!(mesh.tets, [[3, 2, 1, 0]]);
    let mesh = read("3 2 0 1\n1 0 0 1\n2 1 0 1\n3 0 1 0\n", "1 3 0\n1 1 2 3\n", "a.1.node").unwrap();
    assert_eq!((mesh.triangles, mesh.positions[2]), (vec![[0, 1, 2]], Point::new(0.0, 1.0, 0.0)));
    assert_eq!(mesh.groups.get("marker-1"), Some(&[0, 1][..]));
}

#[test]
fn every_truncation_is_refused() {
    // Behind the last coordinate the marker of the last point, 0, may be missing.
    let needed = NODE.find(" 0.5 0\n# end").unwrap();
    for length in 0..needed {
        assert!(read(&NODE[..length], ELE, "a.1.ele").is_err(), "{length} of {needed} bytes");
    }
    let needed = ELE.find(" 2\n").map(|_| ELE.len() - 3).unwrap();
    for length in 0..needed {
        assert!(read(NODE, &ELE[..length], "a.1.ele").is_err(), "{length} of {needed} bytes");
    }
}

#[test]
fn faults_name_the_file_and_the_line() {
    for (from, to, words) in [
        ("5 3 1 1", "five 3 1 1", "a.1.node:2: 'five' is not the number of points"),
        ("5 3 1 1", "0 3 1 1", "a.1.node:2: its points are in another file"),
        ("5 3 1 1", "5 4 1 1", "a.1.node:2: dimension 4 must be 2 or 3"),
        ("5 3 1 1", "4000000000 3 1 1", "a.1.node:2: truncated: 4000000000 points are declared"),
        ("5 3 1 1", "40000000000000000 3 1 1", "a.1.node:2: 40000000000000000 points; at most"),
        ("5 3 1 1", "6 3 1 1", "a.1.node: truncated: the file ends where a point is expected"),
        ("2 1. 0 0", "3 1. 0 0", "a.1.node: point 3 is given twice"),
        ("1e0 0 0.5 2", "inf 0 0.5 2", "a.1.node:6: coordinates [0.0, inf, 0.0] are not finite"),
        ("1e0 0 0.5 2", "1e0", "a.1.node:6: the line ends before a coordinate"),
        ("0.5 -1", "0.5 left", "a.1.node:7: 'left' is not a boundary marker"),
    ] {
        assert!(NODE.contains(from), "{from:?}");
        let error = refusal(&NODE.replacen(from, to, 1), ELE);
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
    }
    for (from, to, words) in [
        ("2  4  1", "2 5 1", "a.1.ele:1: 5 nodes for each element; 4 or 10 make a tetrahedron"),
        ("2  4  1", "0 4 1", "a.1.ele:1: it has no elements"),
        ("2  4  1", "4000000000 4 1", "a.1.ele:1: truncated: 4000000000 elements are declared"),
        ("2 2 3 4 5", "2 2 3 4 6", "a.1.ele:3: there is no point 6"),
        ("2 2 3 4 5 2", "2 2 3 4", "a.1.ele:3: the line ends before a point's number"),
    ] {
        assert!(ELE.contains(from), "{from:?}");
        let error = refusal(NODE, &ELE.replacen(from, to, 1));
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("lone.node"), NODE).unwrap();
    let error = read_tetgen(&folder.path().join("lone.node"), &Import::default()).unwrap_err().to_string();
    assert!(error.contains("lone.ele: no such file"), "{error}");
}

#[test]
fn an_absurd_number_of_attributes_ends_with_the_line() {
    let mesh = read(&NODE.replacen("5 3 1 1", &format!("5 3 {} 1", usize::MAX), 1), ELE, "a.1.ele").unwrap();
    assert_eq!((mesh.tets.len(), mesh.groups.get("marker-2")), (2, None));
}
