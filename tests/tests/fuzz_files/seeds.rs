//! Small sound files of every kind.

use bowknot::io::{MeshView, write_obj, write_ply, write_vtu};
use bowknot::recording::States;
use bowknot_geometry::Point;
use bowknot_tests::fuzz;
use bowknot_tests::states::GENERATORS;
use std::fs;
use std::path::Path;

/// Meshes behind the byte that chooses their format.
pub fn meshes() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("file");
    let mut files = Vec::new();
    let mut add = |choice: u8, content: &[u8]| files.push([&[choice], content].concat());
    for generator in GENERATORS {
        let case = generator(0);
        let topology = case.model.topology();
        let strands: Vec<[u32; 2]> =
            topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect();
        let mesh = MeshView {
            positions: &case.positions,
            triangles: &topology.triangles,
            strands: &strands,
            particles: &topology.particles,
            body: case.model.vertex_body(),
            ..MeshView::default()
        };
        if case.positions.len() < 200 {
            write_obj(&path, &mesh).expect("written");
            add(0, &fs::read(&path).expect("just written"));
            write_ply(&path, &mesh).expect("written");
            add(1, &fs::read(&path).expect("just written"));
        }
    }
    add(0, TAILORED.as_bytes());
    for text in [PLY_TEXT, PLY_LISTS] {
        add(1, text.as_bytes());
    }
    add(1, &binary_ply());
    add(4, MSH_2.as_bytes());
    add(4, MSH_4.as_bytes());
    for size in [4, 8] {
        add(4, &fuzz::binary_msh_4(size));
    }
    add(4, &binary_msh_2());
    add(
        5,
        b"Vertex 0 0 0 0\nVertex 1 1 0 0 {rgb=(1 0 0)}\nVertex 2 0 1 0\nVertex 3 0 0 1\nTet 0 0 1 2 3\nFace \
             1 0 1 2\n# end\n",
    );
    add(7, STL.as_bytes());
    add(7, &binary_stl());
    add(8, MEDIT.as_bytes());
    add(9, VTU.as_bytes());
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
    let mesh = MeshView {
        positions: &positions,
        triangles: &[[0, 1, 2]],
        body: &[0, 0, 1, 1],
        ..MeshView::default()
    };
    write_vtu(&path, &mesh).expect("written");
    add(9, &fs::read(&path).expect("just written"));
    add(10, TETGEN.as_bytes());
    add(6, b"v 0 0 0\nv 1 0 0\nv 0 1 0\ns 1 2\ns 2 3\n");
    add(11, USD.as_bytes());
    add(12, GLTF.as_bytes());
    files
}

/// A mesh that moves.
const USD: &str = "#usda 1.0\n(\n    upAxis = \"Z\"\n    timeCodesPerSecond = 24\n)\ndef Xform \"World\"\n{\n    \
                   def Mesh \"a\"\n    {\n        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n        \
                   point3f[] points.timeSamples = {\n            0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)],\n            \
                   1: [(0, 0, 1), (1, 0, 1), (0, 1, 1)],\n        }\n        int[] faceVertexCounts = [3]\n        \
                   int[] faceVertexIndices = [0, 1, 2]\n    }\n}\n";

/// A triangle in a buffer of base64.
const GLTF: &str = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\
                    \"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\
                    \"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\
                    \"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\
                    \"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

/// What modeling tools say about faces, polygons, negative indices, lines and points.
const TAILORED: &str = "mtllib shirt.mtl\no shirt\ng front left\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1. 0\nv 0 \
                        1e0 0\n\
                        v .5 .5 1\nvt 0 0\nvt 1 0\nvt 1 1 0\nvn 0 0 1\nvn 0 1 0\nusemtl red\ns 1\nf 1/1/1 \
                        2/2/1 3/3/1 4/1/2\ns off\n\
                        f -1//1 -2//2 -5//1\nusemtl blue\nf 1/1 5/2 2/3\nl 1 2 3 4\np 5 \\\n 1\n";

const PLY_TEXT: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n\
    property double y\nproperty float z\nproperty uchar red\nproperty int body\nelement face 2\n\
    property list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\nproperty int \
    vertex2\nend_header\n\
    0 0 0 255 0\n1 0 0 255 0\n0 1 0 0 1\n1 1 1. 0 1\n3 0 1 2\n4 0 1 3 2\n0 3\n";

/// Elements and properties that no reader needs, before those that it does.
const PLY_LISTS: &str = "ply\nformat ascii 1.0\nelement material 2\nproperty list int float weights\n\
    property short id\nelement vertex 3\nproperty list uchar uchar tags\nproperty float x\nproperty float y\n\
    property float z\nproperty uchar obstacle\nelement face 1\nproperty list ushort uint \
    vertex_index\nend_header\n\
    2 0.5 0.5 1\n0 2\n1 9 0 0 0 1\n0 1 0 0 1\n0 0 1 0 0\n3 0 1 2\n";

fn binary_ply() -> Vec<u8> {
    let mut file =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            .to_vec();
    for number in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        file.extend(number.to_be_bytes());
    }
    file.push(3);
    (0..3_i32).for_each(|v| file.extend(v.to_be_bytes()));
    file
}

const MSH_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 \
                     1 \"body\"\n$EndPhysicalNames\n$Nodes\n5\n\
                     1 0 0 0\n2 1 0 0\n3 0 1 0\n9 0 0 1\n4 2 2 2\n$EndNodes\n$Elements\n5\n1 15 2 0 1 1\n2 2 \
                     2 0 1 1 2 3\n\
                     3 4 2 0 1 1 2 3 9\n4 1 2 0 1 9 4\n5 3 2 0 1 1 2 4 3\n$EndElements\n";

const MSH_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 \
                     0\n$EndEntities\n$Nodes\n\
                     1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n2 2 1 \
                     2\n3 1 4 1\n1 1 2 3 4\n\
                     2 1 2 1\n2 1 2 3\n$EndElements\n";

fn binary_msh_2() -> Vec<u8> {
    let mut file = b"$MeshFormat\n2.2 1 8\n".to_vec();
    file.extend(1_i32.to_le_bytes());
    file.extend(b"\n$EndMeshFormat\n$Nodes\n4\n");
    for k in 0..4 {
        file.extend((k + 1_i32).to_le_bytes());
        (1..4).for_each(|axis| file.extend(f64::from(u8::from(k == axis)).to_le_bytes()));
    }
    file.extend(b"\n$EndNodes\n$Elements\n1\n");
    [4, 1, 2, 1, 0, 1, 1, 2, 3, 4].iter().for_each(|n: &i32| file.extend(n.to_le_bytes()));
    file.extend(b"\n$EndElements\n");
    file
}

const STL: &str = "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\n\
                   endloop\nendfacet\nendsolid\nsolid\nendsolid\n";

fn binary_stl() -> Vec<u8> {
    let mut file = b"solid of eighty bytes".to_vec();
    file.resize(80, 0);
    file.extend(2_u32.to_le_bytes());
    for triangle in
        [[0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5]]
    {
        file.extend([0; 12]);
        triangle.iter().for_each(|number| file.extend(number.to_le_bytes()));
        file.extend([0; 2]);
    }
    file
}

const MEDIT: &str = "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n2 2 2 0\n\
                     Tetrahedra 1\n1 2 3 4 7\nTriangles 1\n1 2 3 2\nQuadrilaterals 1\n2 3 4 5 0\nEdges 1\n4 5 3\n\
                     Corners 1\n1\nEnd\n";

/// Text, a piece in base64, and cells that become nothing.
const VTU: &str = "<VTKFile type=\"UnstructuredGrid\" byte_order=\"BigEndian\"><UnstructuredGrid>\n\
    <Piece NumberOfPoints=\"4\" NumberOfCells=\"3\"><Points><DataArray type=\"Float32\" format=\"ascii\">0 0 0 1 0 0 0 1 0 \
    0 0 1</DataArray></Points>\n<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 0 1 2 3 0 \
    </DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8 9</DataArray>\n\
    <DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">AAAAAwoJDA==</DataArray></Cells>\n\
    <PointData><DataArray type=\"Int8\" Name=\"hem\" format=\"ascii\">0 1 1 0</DataArray></PointData></Piece>\n\
    </UnstructuredGrid></VTKFile>\n";

/// The two files of TetGen.
const TETGEN: &str =
    "4 3 1 1\n1 0 0 0 0.5 2\n2 1 0 0 0.5 0\n3 0 1 0 0.5 2\n4 0 0 1 0.5 0\n--\n1 4 1\n1 1 2 3 4 9\n";

/// Scenes that use most keys, small enough to be built.
pub fn scenes() -> Vec<Vec<u8>> {
    SCENES.iter().map(|text| text.as_bytes().to_vec()).collect()
}

const SCENES: [&str; 4] = [
    r#"
[simulation]
name = "pins"
dt = 0.01
frames = 3
gravity = [0.0, 0.0, -9.81]
wind = [1.0, 0.0, 0.0]
air_density = 1.2

[contact]
delta = 0.002
preset = "fast"
friction_model = "coulomb"

[[body]]
name = "sling"
shape = { type = "sheet", size = [0.4, 0.4], edge = 0.1 }
material = "cotton"
translate = [0.0, 0.0, 0.4]
velocity = [0.0, 0.0, -1.0]
angular_velocity = [0.0, 0.0, 90.0]
friction = 0.4
thickness = 0.001
delta = 0.003
stretch_limit = 1.1
groups = [0, 3]
collides_with = [0, 1]
self_collision = false

[[body]]
name = "gravel"
kind = "particles"
shape = { type = "grains", count = [2, 2, 2], spacing = 0.05, jitter = 0.1 }
material = { base = "gravel", radius = 0.01 }
translate = [0.0, 0.0, 0.6]

[[obstacle]]
name = "ball"
shape = { type = "ball", radius = 0.06, edge = 0.03 }
rotate = [10.0, 20.0, 30.0]
scale = 1.5
translate = [0.4, 0.0, 0.8]
motion = { keyframes = [{ time = 0.1 }, { time = 0.3, translate = [0.0, 0.1, 0.0], angle = 45.0 }], axis = [0, 1, 0], spin = 10 }

[[obstacle]]
name = "ground"
shape = { type = "half-space" }
friction = 0.3

[[pin]]
body = "sling"
box = { min = [-0.21, -0.21, 0.39], max = [-0.19, -0.19, 0.41] }
start = 0.01
end = 0.4
motion = { keyframes = [{ time = 0.2 }, { time = 0.6, translate = [0.08, 0.08, 0.12] }] }

[[contact.friction_pairs]]
bodies = ["sling", "ball"]
friction = 0.5

[output]
formats = ["ply", "npz"]
checkpoint_every = 5
"#,
    r#"
[simulation]
dt = 0.005
frames = 2
collision_every = "newton"
newton_iterations = 4

[contact]
preset = "paper"
min_separation = 1e-5
contacts_only = true

[solver.forward]
damping = 0.9
trust_region_max = 3.0

[solver.stop]
max_steps = 100

[solver.newton]
step_tolerance = 1e-3
cg_tolerance = 1e-4

[solver.repulsion]
stiffness = 2.0

[[body]]
kind = "solid"
shape = { type = "block", size = [0.1, 0.1, 0.1], edge = 0.05 }
material = { base = "jelly", density = 900.0 }
translate = [0.0, 0.0, 0.2]

[[body]]
kind = "strands"
shape = { type = "strands", count = 3, length = 0.1, segments = 5, radius = 0.02, curl = 0.01, turns = 1.0 }
material = "hair"
translate = [0.0, 0.0, 0.5]
"#,
    r#"
[[body]]
shape = { type = "tube", radius = 0.1, length = 0.2, edge = 0.06 }
material = { density = 0.2, stretch_limit = 1.2 }
translate = [0.0, 0.0, 1.0]
[[body]]
name = "two"
shape = { type = "ribbon", width = 0.05, edge = 0.02, points = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.1], [0.2, 0.1, 0.0]] }
translate = [0.0, 0.0, 2.0]
[[body]]
kind = "solid"
shape = { type = "tet-ball", radius = 0.05, edge = 0.03 }
[[obstacle]]
shape = { type = "box", size = [0.2, 0.2, 0.2], edge = 0.1 }
translate = [0.0, 0.0, -1.0]
[[obstacle]]
shape = { type = "cone", radius = 0.1, height = 0.2, edge = 0.05 }
translate = [1.0, 0.0, -1.0]
[[obstacle]]
shape = { type = "wedge", length = 0.2, height = 0.1, thickness = 0.05, edge = 0.05 }
translate = [2.0, 0.0, -1.0]
"#,
    r#"
simulation.frames = 1
body = [{ shape = { type = "sheet", size = [1, 1], edge = 0.5 } }]
obstacle = [{ shape = { type = "half-space", normal = [0, 0.1, 1] }, translate = [0, 0, -1] }]
pin = [{ vertices = [0, 1] }, { side = "y-max", start = 0.1 }]
"#,
];

/// A collision problem with every array, and a stack of frames.
fn archives() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("file");
    let run = folder.path().join("run");
    let mut archives = Vec::new();
    for generator in GENERATORS {
        let case = generator(0);
        let topology = case.model.topology();
        let count = case.positions.len();
        if count >= 120 {
            continue;
        }
        let states = States {
            x: case.positions.clone(),
            y: case.positions.clone(),
            triangles: topology.triangles.clone(),
            strands: topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect(),
            particles: topology.particles.clone(),
            rest: case.positions.clone(),
            masses: vec![1.0; count],
            fixed: vec![true; count],
            obstacle: vec![false; count],
            body: case.model.vertex_body().to_vec(),
            half_spaces: case.model.half_spaces().to_vec(),
            time_step: Some(0.01),
            groups: vec![0; count],
            start: case.positions.iter().map(|p| p * 0.5).collect(),
            filters: vec![
                bowknot_geometry::BodyFilter { mask: 5, ..bowknot_geometry::BodyFilter::DEFORMABLE };
                case.model.bodies().len()
            ],
            ..States::default()
        };
        states.write(&path).expect("written");
        archives.push(fs::read(&path).expect("just written"));
    }
    fuzz::write_run(&run);
    archives.push(fs::read(run.join("frames.npz")).expect("the run wrote it"));
    archives
}

/// Archives as their arrays.
pub fn arrays() -> Vec<Vec<u8>> {
    archives().iter().map(|archive| fuzz::arrays_of(archive)).collect()
}

/// A checkpoint as it is, and as its arrays, behind the byte that says which.
pub fn checkpoints() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("state.npz");
    fuzz::sound_checkpoint().write(&path).expect("written");
    let bytes = fs::read(&path).expect("just written");
    let arrays = fuzz::arrays_of(&bytes);
    vec![[vec![0], bytes].concat(), [&[1], &arrays[1..]].concat()]
}

/// Folders of runs, in PLY and as an archive alone.
pub fn run_folders(folder: &Path) -> Vec<Vec<u8>> {
    let run = folder.join("run");
    fuzz::write_run(&run);
    let stack = fs::read(run.join("frames.npz")).expect("the run wrote it");
    fs::remove_file(run.join("frames.npz")).expect("just read");
    let ply = fuzz::files_of(&run);
    fs::remove_dir_all(run.join("frames")).expect("just read");
    fs::write(run.join("frames.npz"), stack).expect("the folder is ours");
    vec![ply, fuzz::files_of(&run)]
}
