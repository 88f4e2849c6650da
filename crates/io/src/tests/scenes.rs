//! glTF scenes, read and written.

use super::*;
use std::fmt::Write as _;

/// Builds the buffer of a scene as a uri, and accessors into it.
#[derive(Default)]
struct Builder {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Builder {
    fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let size = ["SCALAR", "VEC2", "VEC3", "VEC4"].iter().position(|name| *name == kind).unwrap_or(15) + 1;
        self.add(5126, kind, numbers.len() / size, numbers.iter().flat_map(|n| n.to_le_bytes()).collect())
    }

    fn add(&mut self, component: u32, kind: &str, count: usize, mut bytes: Vec<u8>) -> usize {
        let (offset, length) = (self.bytes.len(), bytes.len());
        bytes.resize(length.next_multiple_of(4), 0);
        self.bytes.extend(bytes);
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#));
        let view = self.views.len() - 1;
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{component},"count":{count},"type":"{kind}"}}"#
        ));
        self.accessors.len() - 1
    }

    fn json(&self, rest: &str) -> String {
        let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut uri = "data:application/octet-stream;base64,".to_owned();
        for group in self.bytes.chunks(3) {
            let mut word = 0_u32;
            (0..3).for_each(|k| word = word << 8 | u32::from(group.get(k).copied().unwrap_or(0)));
            for k in 0..=group.len() {
                uri.push(char::from(letters[(word >> (18 - 6 * k) & 63) as usize]));
            }
            (group.len()..3).for_each(|_| uri.push('='));
        }
        let mut text = format!("{{\n\"asset\":{{\"version\":\"2.0\"}},\n{rest},\n");
        let (views, accessors) = (self.views.join(","), self.accessors.join(","));
        write!(text, "\"bufferViews\":[{views}],\n\"accessors\":[{accessors}],\n").expect("a text");
        write!(text, "\"buffers\":[{{\"uri\":\"{uri}\",\"byteLength\":{}}}]\n}}", self.bytes.len())
            .expect("a text");
        text
    }
}

/// A quad of two triangles whose shared edge is parted, with a morph target that moves one vertex of it.
fn morphing() -> String {
    let mut b = Builder::default();
    let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 1., 0.], [1., 0., 0.], [1., 1., 0.]];
    let position = b.floats("VEC3", positions.as_flattened());
    // The parted vertices at (1, 0, 0) move alike, those at (0, 1, 0) do not.
    let moves = [[0.; 3], [0., 0., 1.], [0., 0., 0.], [0., 0., 2.], [0., 0., 1.], [0.; 3]];
    let target = b.floats("VEC3", moves.as_flattened());
    let indices = b.add(5121, "SCALAR", 6, vec![0, 1, 2, 3, 4, 5]);
    let times = b.floats("SCALAR", &[0.0, 1.0, 2.0]);
    let weights = b.floats("SCALAR", &[0.0, 1.0, 0.5]);
    let moved = b.floats("VEC3", &[0., 0., 0., 4., 0., 0.]);
    let key = b.floats("SCALAR", &[1.0, 3.0]);
    b.json(&format!(
        r#""scene":0,"scenes":[{{"nodes":[1]}}],
"nodes":[{{"mesh":0,"name":"cloth"}},{{"name":"root","translation":[0,0,10],"children":[0]}},{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{position}}},"indices":{indices},
  "targets":[{{"POSITION":{target}}}]}}]}}],
"animations":[{{"samplers":[{{"input":{times},"output":{weights}}},
  {{"input":{key},"output":{moved},"interpolation":"STEP"}}],
  "channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}},
  {{"sampler":1,"target":{{"node":0,"path":"translation"}}}}]}}]"#
    ))
}

#[test]
fn morph_targets_and_nodes_move_meshes() {
    let folder = folder();
    let path = write(&folder, "a.gltf", morphing());
    let frames = FrameSource::open(&path).unwrap();
    assert_eq!(
        (frames.times(), frames.names()),
        (Some(&[0.0, 1.0, 2.0, 3.0][..]), &["cloth".to_owned()][..])
    );
    let mesh = frames.read(1).unwrap();
    // Only what moves alike is joined.
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 1, 4]]);
    let heights: Vec<f64> = mesh.positions.iter().map(|p| p.z).collect();
    assert_eq!(heights, [10.0, 11.0, 10.0, 12.0, 10.0]);
    assert_eq!(frames.read(3).unwrap().positions[1], Point::new(5.0, 0.0, 10.5));
    assert_eq!(frames.read(2).unwrap().positions[1], Point::new(1.0, 0.0, 10.5));
    let options = FrameOptions { keep_seams: true, rate: Some(2.0), ..FrameOptions::default() };
    let frames = FrameSource::open_with(&path, &options).unwrap();
    assert_eq!((frames.len(), frames.read(0).unwrap().positions.len()), (7, 6));
    assert_eq!(frames.read(1).unwrap().positions[3].z, 11.0);
    let still = read_mesh(&path, &Import { up: Up::Y, scale: 1.0 }).unwrap();
    assert_eq!(still.positions[1], Point::new(1.0, -10.0, 0.0));
}

#[test]
fn primitives_of_all_modes_are_read() {
    let folder = folder();
    let mut b = Builder::default();
    let points: Vec<f32> = (0..5).flat_map(|k| [k as f32, (k * k) as f32, 0.0]).collect();
    let position = b.floats("VEC3", &points);
    let of = |mode: u32| format!(r#"{{"attributes":{{"POSITION":{position}}},"mode":{mode}}}"#);
    let read = |mode: u32| {
        let text = b.json(&format!(r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{}]}}]"#, of(mode)));
        read_mesh(&write(&folder, "a.gltf", text), &Import::default())
    };
    assert_eq!(read(0).unwrap().particles, [0, 1, 2, 3, 4]);
    assert_eq!(read(1).unwrap().strands, [[0, 1], [2, 3]]);
    assert_eq!(read(2).unwrap().strands, [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]]);
    assert_eq!(read(3).unwrap().strands, [[0, 1], [1, 2], [2, 3], [3, 4]]);
    assert_eq!(read(4).unwrap().triangles, [[0, 1, 2]]);
    assert_eq!(read(5).unwrap().triangles, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    assert_eq!(read(6).unwrap().triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    assert!(message(read(7)).contains("mesh 0: mode 7 of a primitive is none of 0 to 6"));
}

#[test]
fn skins_move_vertices_by_their_joints() {
    let folder = folder();
    let mut b = Builder::default();
    let position = b.floats("VEC3", &[1., 0., 0., 2., 0., 0., 3., 0., 0.]);
    let joints = b.add(5121, "VEC4", 3, vec![0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0]);
    let weights = b.floats("VEC4", &[1., 0., 0., 0., 0.5, 0.5, 0., 0., 1., 0., 0., 0.]);
    let mut bind = [[0.0_f32; 16]; 2];
    bind.iter_mut().for_each(|m| (0..4).for_each(|k| m[5 * k] = 1.0));
    bind[1][12] = -2.0;
    let bind = b.floats("MAT4", bind.as_flattened());
    let times = b.floats("SCALAR", &[0.0, 1.0]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turned = b.floats("VEC4", &[0., 0., 0., 1., 0., 0., half, half]);
    let text = |joint: usize| {
        b.json(&format!(
        r#""nodes":[{{"mesh":0,"skin":0,"translation":[9,9,9]}},{{"children":[2]}},{{"translation":[2,0,0]}}],
"skins":[{{"joints":[1,{joint}],"inverseBindMatrices":{bind}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{position},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}],
"animations":[{{"samplers":[{{"input":{times},"output":{turned}}}],
  "channels":[{{"sampler":0,"target":{{"node":2,"path":"rotation"}}}}]}}]"#
    ))
    };
    let frames = FrameSource::open(&write(&folder, "a.gltf", text(2))).unwrap();
    // The node of a skinned mesh does not count.
    assert_eq!(frames.read(0).unwrap().positions[1], Point::new(2.0, 0.0, 0.0));
    let moved = frames.read(1).unwrap().positions;
    for (point, expected) in moved.iter().zip([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]) {
        assert!((point - Point::from(expected)).norm() < 1e-6, "{moved:?}");
    }
    assert!(
        message(FrameSource::open(&write(&folder, "a.gltf", text(3))))
            .contains("skin 0: its joint is node 3")
    );
}

#[test]
fn splines_and_sparse_numbers_are_those_of_the_specification() {
    let folder = folder();
    let mut b = Builder::default();
    let position = b.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let at = b.add(5123, "SCALAR", 1, vec![2, 0]);
    let by = b.floats("VEC3", &[0., 0., 8.]);
    b.accessors.push(format!(
        r#"{{"componentType":5126,"count":3,"type":"VEC3","sparse":{{"count":1,
"indices":{{"bufferView":{at},"componentType":5123}},"values":{{"bufferView":{by}}}}}}}"#
    ));
    let target = b.accessors.len() - 1;
    let times = b.floats("SCALAR", &[0.0, 2.0]);
    // In tangents, values, out tangents.
    let weights = b.floats("SCALAR", &[9.0, 0.0, 1.0, 1.0, 1.0, 9.0]);
    let text = b.json(&format!(
        r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{position}}},
"targets":[{{"POSITION":{target}}}]}}]}}],
"animations":[{{"samplers":[{{"input":{times},"output":{weights},"interpolation":"CUBICSPLINE"}}],
  "channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}]}}]"#
    ));
    let options = FrameOptions { rate: Some(1.0), ..FrameOptions::default() };
    let frames = FrameSource::open_with(&write(&folder, "a.gltf", text), &options).unwrap();
    let heights: Vec<f64> = (0..3).map(|k| frames.read(k).unwrap().positions[2].z).collect();
    // At the middle 1/2 of both values, 2 (1/8) of the first tangent, -2 (1/8) of the second.
    assert_eq!(heights, [0.0, 4.0, 8.0]);
}

#[test]
fn scenes_that_we_write_come_back() {
    let folder = folder();
    let path = folder.path().join("a.glb");
    let cloth = Mesh { positions: Vec::new(), ..sample() };
    let at = |x: f64, y: f64, z: f64| Point::new(x, y, z);
    let first = [
        at(0.1, 0.0, 0.0),
        at(1.0, 0.0, 0.3),
        at(0.0, 1.0, 0.0),
        at(1.0, 1.0, 0.0),
        at(2.0, 1.0, 0.0),
        at(3.0, 1.0, 0.7),
    ];
    let frames: Vec<Vec<Point>> = (0..3)
        .map(|k| first.iter().map(|p| p + Vector::new(0.0, 0.0, f64::from(k) * p.x * 0.1)).collect())
        .collect();
    let quads = [[0, 1, 3, 2]];
    let bodies = [
        GltfBody { name: "2 \"cloths\"", elements: cloth.view(), obstacle: false },
        GltfBody { name: "lid", elements: MeshView { quads: &quads, ..MeshView::default() }, obstacle: true },
    ];
    write_glb(&path, &bodies, 3, 0.5, |body, frame| {
        Ok(if body == 0 { frames[frame].clone() } else { first[..4].to_vec() })
    })
    .unwrap();
    let options = FrameOptions { import: Import { up: Up::Y, scale: 1.0 }, ..FrameOptions::default() };
    let source = FrameSource::open_with(&path, &options).unwrap();
    assert_eq!(source.times(), Some(&[0.0, 0.5, 1.0][..]));
    assert_eq!(source.names(), ["2 \"cloths\"", "lid"]);
    for (index, positions) in frames.iter().enumerate() {
        let mesh = source.read(index).unwrap();
        for (point, expected) in mesh.positions.iter().zip(positions.iter().chain(&first[..4])) {
            assert!((point - expected).norm() < 2e-7, "{point} {expected}");
        }
        assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [6, 7, 9], [6, 9, 8]]);
        assert_eq!((mesh.strands, mesh.particles), (vec![[3, 4]], vec![5]));
        assert_eq!(mesh.obstacle, Some([vec![false; 6], vec![true; 4]].concat()));
    }
    let lid = read_mesh_part(&path, &options.import, "lid").unwrap();
    assert_eq!((lid.triangles, lid.strands), (vec![[0, 1, 3], [0, 3, 2]], Vec::new()));
    let error = message(read_mesh_part(&path, &options.import, "box"));
    assert!(error.contains("no part \"box\"; it has 2 \"cloths\", lid"), "{error}");
    // Nothing that moves, and nothing at all.
    write_glb(&path, &bodies[1..], 2, 0.5, |_, _| Ok(first[..4].to_vec())).unwrap();
    assert_eq!(FrameSource::open(&path).unwrap().times(), None);
    write_glb(&path, &[], 1, 0.5, |_, _| Ok(Vec::new())).unwrap();
    assert!(message(FrameSource::open(&path)).contains("no meshes in its scene"));
}

#[test]
fn faults_of_scenes_have_their_place() {
    let folder = folder();
    let good = morphing();
    for (from, to, expected) in [
        ("{\n", "", "a.gltf:1: not glTF"),
        ("\"2.0\"", "\"1.0\"", "version '1.0' of glTF is not read"),
        ("\"scene\":0,", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],", "without compression"),
        ("\"children\":[0]", "\"children\":[1]", "node 1: it has two parents, or is one of its own"),
        ("\"children\":[0]", "\"children\":[7]", "node 7: there is no such node"),
        ("\"mesh\":0,", "\"mesh\":4,", "node 0: there is no mesh 4"),
        ("\"POSITION\":0}", "\"NORMAL\":0}", "mesh 0: a primitive has no POSITION"),
        ("\"POSITION\":0}", "\"POSITION\":2}", "accessor 2: its type is \"SCALAR\"; 3 components"),
        ("\"POSITION\":0}", "\"POSITION\":99}", "accessor 99: there is no such accessor"),
        ("\"POSITION\":1}", "\"POSITION\":5}", "accessor 5: a morph target of 6 vertices"),
        ("\"count\":6,", "\"count\":7,", "accessor 0: its bufferView or its range is not in a buffer"),
        ("\"count\":6,", "\"count\":18446744073709551615,", "is not in a buffer"),
        (
            "\"byteLength\":72}",
            "\"byteLength\":72,\"byteStride\":4}",
            "byteStride 4 is less than its 12 bytes",
        ),
        ("base64,", "base64,*", "buffer 0: its data are not base64"),
        ("data:application", "http://example.org/data:application", "buffer 0: it is not on this machine"),
        ("\"input\":3", "\"input\":4", "accessor 4: key times must ascend"),
        ("\"output\":4", "\"output\":6", "accessor 6: it has 2 elements; 3 keys need 1 each"),
        ("\"sampler\":1", "\"sampler\":3", "there is no sampler 3"),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        let path = write(&folder, "a.gltf", text);
        let error = message(FrameSource::open(&path).and_then(|frames| frames.read(0)));
        assert!(error.contains(expected), "{expected:?} is not in {error}");
    }
}

#[test]
fn damaged_scenes_are_read_or_refused_but_never_panic() {
    let folder = folder();
    let read = |name: &str, bytes: &[u8]| {
        if let Ok(frames) = FrameSource::open(&write(&folder, name, bytes)) {
            (0..frames.len().min(4)).for_each(|k| drop(frames.read(k)));
        }
    };
    let points = [Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.5)];
    let body = GltfBody {
        name: "a",
        elements: MeshView { triangles: &[[0, 1, 2]], ..MeshView::default() },
        obstacle: false,
    };
    let path = folder.path().join("whole.glb");
    write_glb(&path, &[body], 3, 0.5, |_, k| Ok(points.iter().map(|p| p * (1.0 + k as f64)).collect()))
        .unwrap();
    let sources = [("d.glb", fs::read(&path).unwrap()), ("d.gltf", morphing().into_bytes())];
    let mut random = fastrand::Rng::with_seed(3);
    for (name, whole) in &sources {
        for length in (0..whole.len()).step_by(7) {
            assert!(
                FrameSource::open(&write(&folder, name, &whole[..length])).and_then(|f| f.read(0)).is_err()
                    || length + 200 > whole.len()
            );
        }
        for _ in 0..1000 {
            let mut bytes = whole.clone();
            for _ in 0..1 + random.usize(..4) {
                let at = random.usize(..bytes.len());
                bytes[at] = if random.bool() {
                    random.u8(..)
                } else {
                    *random.choice(b"0123456789-,:[]{}\"").unwrap()
                };
            }
            read(name, &bytes);
        }
    }
}
