//! USD stages that are read.

use super::*;

/// Everything that counts, written as `usdcat` writes it.
const STAGE: &str = r#"#usda 1.0
(
    'a "quoted" # comment'
    defaultPrim = "World"
    subLayers = []
    timeCodesPerSecond = 10
    upAxis = "Z"
)

def Xform "World" (
    prepend apiSchemas = ["SomeAPI"]
    customData = {
        string note = "{ not a brace ("
    }
)
{
    double3 xformOp:translate = (0, 0, 10)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    rel material:binding = </World/Looks> (
        bindMaterialAs = "weaker"
    )
    color3f outputs:out
    asset file = @textures/a[1].png@

    def Mesh "cloth" (
        displayName = "The cloth"
    )
    {
        custom bool bowknot:obstacle = 0
        int[] faceVertexCounts = [3, 4]
        int[] faceVertexIndices = [0, 1, 2, 1, 3, 4, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
        point3f[] points.timeSamples = {
            5: [(0, 0, 3), (1, 0, 3), (0, 1, 3), (2, 0, 3), (2, 1, 3)],
            1: [(0, 0, 1), (1, 0, 1), (0, 1, 1), (2, 0, 1), (2, 1, 1)], # not in order
            7: None,
        }
        uniform token subdivisionScheme = "none"
    }

    def Xform "arm"
    {
        float xformOp:rotateZ.timeSamples = { 1: 0, 3: 90 }
        uniform token[] xformOpOrder = ["xformOp:rotateZ"]

        def Mesh "hand" {
            custom bool bowknot:obstacle = 1
            int[] faceVertexCounts = [3]
            int[] faceVertexIndices = [0, 1, 2]
            uniform token orientation = "leftHanded"
            point3f[] points = [(1, 0, 0), (2, 0, 0), (1, 1, 0)]
            uniform token subdivisionScheme = "none"
        }
    }

    def BasisCurves "hair"
    {
        int[] curveVertexCounts = [3, 3]
        point3f[] points = [(0, 0, 0), (0, 1, 0), (0, 2, 0), (5, 0, 0), (5, 1, 0), (5, 1, 1)]
        uniform token type = "linear"
        uniform token wrap = "periodic"
    }

    def Points "dots" { point3d[] points = [(0.1, 0, 0)] }

    def Mesh "off" (active = false) {}
    over "elsewhere" { point3f[] points = [(1, 1, 1)] }
    class "shape" { def Points "none" { point3f[] points = [(1, 1, 1)] } }
    def Points "hidden" { point3f[] points = [(1, 1, 1)]; token visibility = "invisible" }
}
"#;

fn open(folder: &TempDir, text: &str) -> Result<FrameSource, IoError> {
    FrameSource::open(&write(folder, "a.usda", text))
}

fn near(a: Point, b: [f64; 3]) -> bool {
    (a - Point::from(b)).norm() < 1e-12
}

#[test]
fn stages_are_animations_of_their_prims() {
    let folder = folder();
    let frames = open(&folder, STAGE).unwrap();
    assert_eq!(frames.names(), ["The cloth", "hand", "hair", "dots"]);
    assert_eq!(frames.times(), Some(&[0.1, 0.3, 0.5][..]));
    let mesh = frames.read(0).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 4], [1, 4, 2], [5, 7, 6]]);
    assert_eq!(mesh.surface.as_ref().map(Surface::len), Some(3));
    assert_eq!(mesh.strands, [[8, 9], [9, 10], [10, 8], [11, 12], [12, 13], [13, 11]]);
    assert_eq!(mesh.particles, [14]);
    assert_eq!(mesh.body.as_deref(), Some(&[0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2, 2, 2, 3][..]));
    assert_eq!(mesh.obstacle.map(|o| o.iter().position(|o| *o)), Some(Some(5)));
    // A double stays a double.
    assert_eq!(mesh.positions[14], Point::new(0.1, 0.0, 10.0));
    // Between its samples the cloth moves evenly, and the hand stays where its last sample puts it.
    let heights: Vec<f64> = (0..3).map(|k| frames.read(k).unwrap().positions[0].z).collect();
    assert_eq!(heights, [11.0, 12.0, 13.0]);
    assert!(near(frames.read(0).unwrap().positions[7], [1.0, 1.0, 10.0]));
    assert!(near(frames.read(1).unwrap().positions[7], [-1.0, 1.0, 10.0]));
    assert!(near(frames.read(2).unwrap().positions[7], [-1.0, 1.0, 10.0]));
    // Where nothing moves, default values count, and first samples where there are none.
    let still = read_mesh(&folder.path().join("a.usda"), &Import { up: Up::Z, scale: 2.0 }).unwrap();
    assert_eq!((still.positions[0].z, still.positions[5]), (20.0, Point::new(2.0, 0.0, 20.0)));
}

#[test]
fn stages_are_sampled_at_a_rate() {
    let folder = folder();
    let path = write(&folder, "a.usda", STAGE);
    let options = FrameOptions { rate: Some(20.0), ..FrameOptions::default() };
    let frames = FrameSource::open_with(&path, &options).unwrap();
    assert_eq!(frames.len(), 9);
    assert!((frames.times().unwrap()[8] - 0.5).abs() < 1e-12);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert!(near(frames.read(2).unwrap().positions[5], [half, half, 10.0]));
}

#[test]
fn operations_are_those_of_usd() {
    let folder = folder();
    let placed = |operations: &str, order: &str| {
        let text = format!(
            "#usda 1.0\ndef Points \"a\" {{\n{operations}\nuniform token[] xformOpOrder = [{order}]\n\
             point3f[] points = [(1, 2, 3)] }}"
        );
        open(&folder, &text).and_then(|frames| frames.read(0)).map(|mesh| mesh.positions[0])
    };
    let quarter = "float3 xformOp:rotateXYZ = (90, 0, 90)\nfloat3 xformOp:rotateZYX = (90, 0, 90)";
    // About x first: (1, -3, 2), then about z.
    assert!(near(placed(quarter, "\"xformOp:rotateXYZ\"").unwrap(), [3.0, 1.0, 2.0]));
    // About z first: (-2, 1, 3), then about x.
    assert!(near(placed(quarter, "\"xformOp:rotateZYX\"").unwrap(), [-2.0, -3.0, 1.0]));
    let pivot = "double3 xformOp:translate:pivot = (1, 2, 0)\nfloat3 xformOp:scale = (2, 2, 2)";
    let order = "\"xformOp:translate:pivot\", \"xformOp:scale\", \"!invert!xformOp:translate:pivot\"";
    assert!(near(placed(pivot, order).unwrap(), [1.0, 2.0, 6.0]));
    let orient = "quatd xformOp:orient = (0.5, 0.5, 0.5, 0.5)";
    assert!(near(placed(orient, "\"xformOp:orient\"").unwrap(), [3.0, 1.0, 2.0]));
    let matrix = "matrix4d xformOp:transform = ((0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 1, 0), (7, 8, 9, 1))";
    assert!(near(placed(matrix, "\"xformOp:transform\"").unwrap(), [5.0, 9.0, 12.0]));
    // What is not in the order does not count.
    assert!(near(placed(matrix, "").unwrap(), [1.0, 2.0, 3.0]));
    for (operations, order, expected) in [
        ("", "\"xformOp:spin\"", "/a: xformOp:spin is not a known operation"),
        ("", "\"xformOp:scale\"", "/a: xformOp:scale is missing"),
        ("float3 xformOp:scale = (0, 1)", "\"xformOp:scale\"", "must be 3 finite numbers"),
        ("float3 xformOp:scale = (0, 1, 1)", "\"!invert!xformOp:scale\"", "cannot be inverted"),
    ] {
        let error = message(placed(operations, order));
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn one_part_of_a_stage_is_chosen_by_name_or_path() {
    let folder = folder();
    let path = write(&folder, "a.usda", STAGE);
    let import = Import { up: Up::Z, scale: 2.0 };
    let part = |part: &str| read_mesh_part(&path, &import, part);
    // By its name for people, its name and its path.
    let cloth = part("The cloth").unwrap();
    assert_eq!((part("cloth").unwrap(), part("/World/cloth").unwrap()), (cloth.clone(), cloth.clone()));
    assert_eq!((cloth.positions.len(), cloth.surface.as_ref().map(Surface::len)), (5, Some(2)));
    let hand = part("hand").unwrap();
    assert_eq!((hand.positions[0], &hand.triangles[..]), (Point::new(2.0, 0.0, 20.0), &[[0, 2, 1]][..]));
    assert_eq!(
        (hand.body, hand.names, hand.obstacle),
        (Some(vec![0; 3]), vec!["hand".to_owned()], Some(vec![true; 3]))
    );
    // All below a path.
    assert_eq!(part("/World/arm").unwrap().triangles, [[0, 2, 1]]);
    assert_eq!(part("/World/").unwrap(), {
        let mut whole = read_mesh(&path, &import).unwrap();
        whole.groups.drop_empty();
        whole
    });
    let error = message(part("/World/ar"));
    let there = "no part \"/World/ar\"; it has /World/cloth, /World/arm/hand, /World/hair, /World/dots";
    assert!(error.ends_with(there), "{error}");
    // Frames of one part.
    let frames = FrameSource::open(&path).unwrap().part("hand").unwrap();
    assert_eq!(frames.times(), Some(&[0.1, 0.3, 0.5][..]));
    assert!(near(frames.read(1).unwrap().positions[2], [-1.0, 1.0, 10.0]));
    assert!(message(FrameSource::open(&path).unwrap().part("foot")).contains("no part \"foot\""));
    // Names that several parts have.
    let twice = "#usda 1.0\ndef \"a\" { def Points \"p\" { point3f[] points = [(1, 0, 0)] } }\n\
                 def \"b\" { def Points \"p\" { point3f[] points = [(2, 0, 0)] } }\n";
    let path = write(&folder, "b.usda", twice);
    assert_eq!(read_mesh_part(&path, &import, "/b").unwrap().positions, [Point::new(4.0, 0.0, 0.0)]);
    let error = message(read_mesh_part(&path, &import, "p"));
    assert!(error.contains("2 parts are called \"p\": /a/p, /b/p; give the path of one"), "{error}");
}

#[test]
fn objects_of_other_files_are_parts() {
    let folder = folder();
    let two = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\no a\nf 1 2 3\no b\ng hem\nf 4 5 6\n";
    let path = write(&folder, "two.obj", two);
    let part = read_mesh_part(&path, &Import::default(), "b").unwrap();
    assert_eq!((part.positions[0].z, &part.triangles[..]), (1.0, &[[0, 1, 2]][..]));
    assert_eq!(part.groups.get("hem"), Some(&[0, 1, 2][..]));
    let error = message(read_mesh_part(&path, &Import::default(), "c"));
    assert!(error.ends_with("two.obj: no part \"c\"; it has a, b"), "{error}");
    // Lines and points are of no object.
    let more = write(&folder, "more.obj", format!("{two}v 5 0 0\nv 6 0 0\nv 7 0 0\nl 7 8\np 9\n"));
    assert_eq!(read_mesh_part(&more, &Import::default(), "a").unwrap().positions.len(), 3);
    let rest = read_mesh_part(&more, &Import::default(), "more").unwrap();
    assert_eq!((rest.triangles, rest.strands, rest.particles), (vec![], vec![[0, 1]], vec![2]));
    let sewn = write(&folder, "sewn.obj", two.replace("f 4 5 6", "f 3 4 5"));
    let error = message(read_mesh_part(&sewn, &Import::default(), "a"));
    assert!(error.contains("an element joins part \"a\" to \"b\""), "{error}");
}

#[test]
fn subsets_of_a_stage_are_groups() {
    let folder = folder();
    let points = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]";
    let faces = "int[] faceVertexCounts = [3, 4]\nint[] faceVertexIndices = [0, 1, 2, 1, 3, 4, 2]";
    let subset = |name: &str, content: &str| format!("def GeomSubset \"{name}\" {{ {content} }}\n");
    let subsets = [
        subset("hem", "uniform token elementType = \"point\"\nint[] indices = [4, 0]"),
        subset("front", "uniform token elementType = \"face\"\nint[] indices = [1]"),
        // The element type of the schema's fallback.
        subset("back", "int[] indices = [0]"),
        subset("edge", "uniform token elementType = \"edge\"\nint[] indices = [0, 1, 1, 3]"),
        subset("lost", "int[] indices = [2]"),
        subset("far", "uniform token elementType = \"point\"\nint[] indices = [5]"),
    ];
    let mesh = |name: &str| format!("def Mesh \"{name}\" {{\n{points}\n{faces}\n{}}}\n", subsets.concat());
    let path = write(&folder, "a.usda", format!("#usda 1.0\n{}", mesh("m")));
    let read = read_mesh(&path, &Import::default()).unwrap();
    let groups: Vec<(&str, &[u32])> = read.groups.iter().collect();
    let expected: [(&str, &[u32]); 4] =
        [("back", &[0, 1, 2]), ("edge", &[0, 1, 3]), ("front", &[1, 2, 3, 4]), ("hem", &[0, 4])];
    assert_eq!(groups, expected);
    // Of tetrahedra, and of one part of two.
    let tets =
        "def TetMesh \"t\" {\npoint3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]\n\
                int4[] tetVertexIndices = [(0, 1, 2, 3), (1, 2, 3, 4)]\n"
            .to_owned()
            + &subset("top", "uniform token elementType = \"tetrahedron\"\nint[] indices = [1]")
            + "}\n";
    let path = write(&folder, "b.usda", format!("#usda 1.0\n{}{tets}", mesh("m")));
    let both = read_mesh(&path, &Import::default()).unwrap();
    assert_eq!(both.groups.get("top"), Some(&[6, 7, 8, 9][..]));
    let part = read_mesh_part(&path, &Import::default(), "t").unwrap();
    assert_eq!(part.groups.iter().collect::<Vec<_>>(), [("top", &[1, 2, 3, 4][..])]);
}

#[test]
fn our_stages_come_back() {
    let folder = folder();
    let path = folder.path().join("a.usda");
    let cloth = Mesh { strands: Vec::new(), particles: Vec::new(), ..sample() };
    let frames = [cloth.positions[..4].to_vec(), cloth.positions[..4].iter().map(|p| p * 2.0).collect()];
    let body = |name, obstacle| UsdBody {
        name,
        elements: MeshView { positions: &[], ..cloth.view() },
        obstacle,
        width: 0.25,
    };
    write_usda(&path, &[body("2 cloths", false), body("lid", true)], 2, 50.0, |_, frame| {
        Ok(frames[frame].clone())
    })
    .unwrap();
    let source = FrameSource::open(&path).unwrap();
    assert_eq!(
        (source.names(), source.times()),
        (&["2 cloths".to_owned(), "lid".to_owned()][..], Some(&[0.0, 0.02][..]))
    );
    let single = |p: &Point| p.map(|c| f64::from(c as f32));
    for (index, positions) in frames.iter().enumerate() {
        let mesh = source.read(index).unwrap();
        let expected: Vec<Point> = positions.iter().chain(positions).map(single).collect();
        assert_eq!(mesh.positions, expected);
        assert_eq!(mesh.obstacle, Some([[false; 4], [true; 4]].concat()));
        assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]]);
    }
}

#[test]
fn faults_of_stages_have_their_place() {
    let folder = folder();
    let points = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]";
    let mesh = |body: &str| format!("#usda 1.0\ndef Mesh \"m\"\n{{\n{body}\n}}\n");
    let faces = |counts: &str, indices: &str| {
        mesh(&format!("{points}\nint[] faceVertexCounts = [{counts}]\nint[] faceVertexIndices = [{indices}]"))
    };
    let samples = "point3f[] points.timeSamples = { 0: [(0, 0, 0)], 1: [(0, 0, 0), (1, 1, 1)] }";
    let moving = format!("#usda 1.0\ndef Points \"m\" {{ {samples} }}");
    let changing =
        "int[] faceVertexCounts = [3]\nint[] faceVertexIndices.timeSamples = { 0: [0, 1, 2], 4: [0, 2, 1] }";
    for (text, expected) in [
        ("PXR-USDC\0".to_owned(), "a.usda: a binary stage, which is not read: `usdcat --flatten"),
        ("#usd".to_owned(), "a.usda:1: it does not begin with #usda"),
        ("#usda 1.0\n".to_owned(), "a.usda: no meshes, curves or points in it"),
        (mesh("int ="), "a.usda:4: a word is missing before '='"),
        (mesh("point3f[] points = [(0, 0, 0)"), "a.usda:5: ']' is missing before '}'"),
        (mesh("point3f[] points = [(0, 0, 0)").replace('}', ""), "a.usda:6: the file ends within brackets"),
        (mesh("token visibility = \"invisible"), "a.usda:4: a text in single quotes has no end"),
        (faces("3", "0, 1, 3"), "/m: faceVertexIndices has 3, but there are 3 points"),
        (faces("3", "0, 1, -1"), "/m: faceVertexIndices has -1"),
        (faces("3", "0, 1, 0.5"), "0.5, which is no 32-bit whole number"),
        (faces("4", "0, 1, 2"), "/m: face 0 has 4 points, 3 are left"),
        (faces("3", "0, 1, 2, 0"), "/m: 1 of faceVertexIndices belong to no face"),
        (faces("2", "0, 1"), "/m: faceVertexCounts has 2, at least 3 are needed"),
        (mesh(points), "/m: faceVertexCounts is missing"),
        (mesh(&format!("{points}\n{changing}")), "faceVertexIndices changes at time code 4"),
        (mesh("point3f[] points = [(0, 0,\n inf)]"), "a.usda:5: 'inf' is not a finite number"),
        (mesh("point3f[] points = [(0, 0)]").replace("Mesh", "Points"), "/m: points has 2 numbers"),
        ("#usda 1.0\n".to_owned() + &"def \"a\" {".repeat(5000), "prims more than 200 deep"),
        (format!("#usda 1.0\ndef \"{}\"", "a".repeat(2 << 20)), "a word of more than 1048576 bytes"),
    ] {
        let error = message(open(&folder, &text));
        assert!(error.contains(expected), "{expected:?} is not in {error}");
    }
    let error = message(open(&folder, &moving).unwrap().read(1));
    assert!(error.contains("/m: points has 6 numbers; 3 for each of 1 point are needed"), "{error}");
}

#[test]
fn damaged_stages_are_read_or_refused_but_never_panic() {
    let folder = folder();
    let read = |bytes: &[u8]| {
        if let Ok(frames) = FrameSource::open(&write(&folder, "d.usda", bytes)) {
            (0..frames.len().min(4)).for_each(|k| drop(frames.read(k)));
        }
    };
    for length in (0..STAGE.len()).step_by(3) {
        read(&STAGE.as_bytes()[..length]);
    }
    let mut random = fastrand::Rng::with_seed(2);
    for _ in 0..1000 {
        let mut bytes = STAGE.as_bytes().to_vec();
        for _ in 0..1 + random.usize(..4) {
            let at = random.usize(..bytes.len());
            bytes[at] =
                if random.bool() { random.u8(..) } else { *random.choice(b"()[]{}\"'@<>#:,.-19 ").unwrap() };
        }
        read(&bytes);
    }
}
