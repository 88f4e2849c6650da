//! Frames of any file or folder.

use super::*;

fn at(vertex: usize, frame: usize) -> Point {
    Point::new(vertex as f64, if vertex == 2 { 1.0 } else { 0.0 }, frame as f64 * 0.5)
}

fn triangle(frame: usize) -> Vec<Point> {
    (0..3).map(|vertex| at(vertex, frame)).collect()
}

/// A point cache of three frames and its mesh.
fn cached(folder: &TempDir, name: &str) -> PathBuf {
    let cache = folder.path().join(format!("{name}.pc2"));
    for frame in 0..3 {
        write_pc2_frame(&cache, frame, &triangle(frame)).expect("a writable folder");
    }
    write(folder, &format!("{name}.obj"), "v 0 0 0\nv 1 0 0\nv 2 1 0\nf 1 2 3\n");
    cache
}

#[test]
fn a_mesh_is_one_frame() {
    let folder = folder();
    let path = write(&folder, "a.obj", "v 1 2 3\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let frames = FrameSource::open(&path).unwrap();
    assert_eq!((frames.len(), frames.times(), frames.names().len()), (1, None, 0));
    assert_eq!(frames.read(0).unwrap().positions[0], Point::new(1.0, 2.0, 3.0));
    let options = FrameOptions { import: Import { up: Up::Y, scale: 2.0 }, ..FrameOptions::default() };
    let frames = FrameSource::open_with(&path, &options).unwrap();
    assert_eq!(frames.read(0).unwrap().positions[0], Point::new(2.0, -6.0, 4.0));
    let options = FrameOptions { rate: Some(0.0), ..options };
    assert!(
        message(FrameSource::open_with(&path, &options)).contains("per second must be finite and above 0")
    );
}

#[test]
fn point_caches_move_their_meshes() {
    let folder = folder();
    let cache = cached(&folder, "cloth");
    let frames = FrameSource::open(&cache).unwrap();
    assert_eq!(
        (frames.len(), frames.names(), frames.ending().as_str()),
        (3, &["cloth".to_owned()][..], "pc2")
    );
    for frame in [2, 0, 1] {
        let mesh = frames.read(frame).unwrap();
        assert_eq!((mesh.positions, mesh.triangles), (triangle(frame), vec![[0, 1, 2]]));
    }
    // All caches of a folder are parts of the same frames.
    cached(&folder, "lid");
    let frames = FrameSource::open(folder.path()).unwrap();
    let mesh = frames.read(2).unwrap();
    assert_eq!(frames.names(), ["cloth", "lid"]);
    assert_eq!((mesh.body, mesh.triangles), (Some(vec![0, 0, 0, 1, 1, 1]), vec![[0, 1, 2], [3, 4, 5]]));
    assert_eq!(mesh.positions, [triangle(2), triangle(2)].concat());
}

#[test]
fn point_caches_without_what_they_need_are_refused() {
    let folder = folder();
    let cache = cached(&folder, "cloth");
    let whole = fs::read(&cache).unwrap();
    for length in 0..whole.len() {
        let path = write(&folder, "cloth.pc2", &whole[..length]);
        assert!(message(FrameSource::open(&path)).contains("cloth.pc2"));
    }
    let mut not_finite = whole.clone();
    not_finite[32 + 12..36 + 12].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = message(FrameSource::open(&write(&folder, "cloth.pc2", not_finite)));
    assert!(error.contains("sample 0: point 1 is not finite"), "{error}");
    // Sizes that overflow are not believed.
    let mut huge = whole.clone();
    huge[16..20].copy_from_slice(&i32::MAX.to_le_bytes());
    huge[28..32].copy_from_slice(&i32::MAX.to_le_bytes());
    assert!(message(FrameSource::open(&write(&folder, "cloth.pc2", huge))).contains("it has 140 bytes"));
    let alone = write(&folder, "alone.pc2", &whole);
    assert!(message(FrameSource::open(&alone)).contains("alone.obj nor"));
    write(&folder, "alone.obj", "v 0 0 0\n");
    assert!(message(FrameSource::open(&alone)).contains("it moves 3 points, but"));
}

#[test]
fn collections_have_times() {
    let folder = folder();
    for (name, z) in [("a", 0.0), ("b", 1.0), ("c", 2.0)] {
        let points = [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]].map(Point::from);
        let view = MeshView { positions: &points, triangles: &[[0, 1, 2]], ..MeshView::default() };
        write_ply(&folder.path().join(format!("{name}.ply")), &view).unwrap();
    }
    let text = |entries: &str| format!("<VTKFile type=\"Collection\">\n<Collection>\n{entries}</Collection>");
    let entry = |time: &str, file: &str| format!("<DataSet part='0' timestep=\"{time}\"\n file='{file}'/>\n");
    let entries = entry("0.5", "b.ply") + &entry("0.25", "a.ply") + &entry("0.5", "c.ply");
    let frames = FrameSource::open(&write(&folder, "a.pvd", text(&entries))).unwrap();
    assert_eq!(frames.times(), Some(&[0.25, 0.5][..]));
    assert_eq!(frames.read(0).unwrap().triangles.len(), 1);
    let both = frames.read(1).unwrap();
    assert_eq!(
        (both.names, both.triangles),
        (vec!["b".to_owned(), "c".to_owned()], vec![[0, 1, 2], [3, 4, 5]])
    );
    for (content, expected) in [
        (text(""), "a.pvd: it has no DataSet"),
        (text("<DataSet timestep='1'/>"), "a.pvd:3: DataSet has no file"),
        (text("<DataSet timestep='x' file='a.ply'/>"), "a.pvd:3: timestep is not a number"),
        (text("<DataSet file='a.ply'"), "a.pvd:3: the tag has no end"),
        ("<VTKFile/>".to_owned(), "not a collection"),
    ] {
        let error = message(FrameSource::open(&write(&folder, "a.pvd", &content)));
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn folders_of_runs_are_opened() {
    let folder = folder();
    assert!(message(FrameSource::open(folder.path())).contains("no frames in it"));
    assert!(message(FrameSource::open(&folder.path().join("none"))).contains("no such file or folder"));
    stack().write(&folder.path().join("frames.npz")).unwrap();
    let frames = FrameSource::open(folder.path()).unwrap();
    assert_eq!((frames.len(), frames.ending().as_str()), (2, "npz"));
    fs::create_dir(folder.path().join("frames")).unwrap();
    write_ply(&folder.path().join("frames/000007.ply"), &sample().view()).unwrap();
    let frames = FrameSource::open(folder.path()).unwrap();
    assert_eq!((frames.numbers(), frames.read(0).unwrap()), (vec![7], sample()));
}
