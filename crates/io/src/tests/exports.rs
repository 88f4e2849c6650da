//! Formats that are written only: point caches, VTK grids, USD stages.

use super::*;

#[test]
fn point_caches_grow_and_shrink_by_whole_samples() {
    let folder = folder();
    let path = folder.path().join("a.pc2");
    let frame = |k: usize| vec![Point::new(k as f64, 0.5, -1.0 / 3.0), Point::new(0.1, 0.2, 0.3)];
    for k in 0..3 {
        write_pc2_frame(&path, k, &frame(k)).unwrap();
    }
    let bytes = fs::read(&path).unwrap();
    assert_eq!(bytes.len(), 32 + 3 * 24);
    assert_eq!(&bytes[..12], b"POINTCACHE2\0");
    let word = |at: usize| i32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let real = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!((word(12), word(16), real(20), real(24), word(28)), (1, 2, 0.0, 1.0, 3));
    assert_eq!((real(32 + 48), real(32 + 52), real(32 + 56)), (2.0, 0.5, -1.0 / 3.0));
    // Frame 1 again: what a resumed run does.
    write_pc2_frame(&path, 1, &frame(1)).unwrap();
    write_pc2_frame(&path, 2, &frame(2)).unwrap();
    assert_eq!(fs::read(&path).unwrap(), bytes);
    truncate_pc2(&path, 1, 2).unwrap();
    assert_eq!(fs::read(&path).unwrap().len(), 32 + 24);
    assert!(message(truncate_pc2(&path, 2, 2)).contains("it has 1 samples, 2 are needed"));
    assert!(message(truncate_pc2(&path, 1, 3)).contains("a point cache of 2 points, not of 3"));
    assert!(message(write_pc2_frame(&path, 2, &frame(2))).contains("1 samples"));
    assert!(message(truncate_pc2(&write(&folder, "b.pc2", "no"), 1, 3)).contains("b.pc2: not a point cache"));
}

#[test]
fn grids_say_where_their_arrays_are() {
    let folder = folder();
    let path = folder.path().join("a.vtu");
    let mesh = sample();
    write_vtu(&path, &MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() }).unwrap();
    let bytes = fs::read(&path).unwrap();
    let start = bytes.windows(2).position(|w| w == b"\n_").unwrap() + 2;
    let head = String::from_utf8(bytes[..start].to_vec()).unwrap();
    assert!(head.contains("NumberOfPoints=\"6\" NumberOfCells=\"5\""), "{head}");
    // Every array's offset leads to its length, which leads to the next array.
    let mut at = 0;
    for part in head.split("offset=\"").skip(1) {
        assert_eq!(part.split('"').next().unwrap().parse(), Ok(at));
        let length = bytes[start + at..start + at + 8].try_into().unwrap();
        at += 8 + u64::from_le_bytes(length) as usize;
    }
    assert_eq!(&bytes[start + at..], b"\n</AppendedData>\n</VTKFile>\n");
    assert_eq!(&bytes[start + 8..start + 16], 0.1_f64.to_le_bytes());
    let types = &bytes[start + at - (8 + 6) - (8 + 24) - 5..][..5];
    assert_eq!(types, [5, 5, 9, 3, 1]);
}

#[test]
fn fields_stand_beside_the_positions() {
    let folder = folder();
    let mesh = sample();
    let velocities: Vec<Vector> = (0..6).map(|k| Vector::new(f64::from(k), 0.5, -1.0 / 3.0)).collect();
    let forces: Vec<Vector> = (0..6).map(|k| Vector::new(0.0, f64::from(k * k), 7.0)).collect();
    let fields = [
        FieldValues { field: Field::Velocity, values: &velocities },
        FieldValues { field: Field::ContactForce, values: &forces },
    ];
    let path = folder.path().join("a.vtu");
    write_vtu_with_fields(&path, &mesh.view(), &fields).unwrap();
    let bytes = fs::read(&path).unwrap();
    let start = bytes.windows(2).position(|w| w == b"\n_").unwrap() + 2;
    let head = String::from_utf8_lossy(&bytes[..start]).into_owned();
    for (name, values) in [("velocity", &velocities), ("contact_force", &forces)] {
        let tag =
            head.split(&format!("type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\"")).nth(1).unwrap();
        let at: usize = tag.split('"').nth(3).unwrap().parse().unwrap();
        let numbers = &bytes[start + at..][..8 + 24 * 6];
        assert_eq!(numbers[..8], 144_u64.to_le_bytes());
        let expected: Vec<u8> =
            values.iter().flat_map(|v| [v.x, v.y, v.z]).flat_map(f64::to_le_bytes).collect();
        assert!(numbers[8..] == expected, "{name}");
    }
    assert!(head.contains("</PointData>\n</Piece>") && bytes.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));

    let of = |field: Option<Field>, frame: usize| -> Vec<Point> {
        let shift = Vector::new(0.0, 0.0, frame as f64);
        match field {
            None => mesh.positions.iter().map(|p| p + shift).collect(),
            Some(Field::Velocity) => velocities.iter().map(|v| Point::from(v + shift)).collect(),
            Some(Field::ContactForce) => forces.iter().map(|v| Point::from(v + shift)).collect(),
        }
    };
    let path = folder.path().join("a.npz");
    write_frame_stack_with_fields(&path, &mesh.view(), 2, &Field::ALL, |field, frame, bytes| {
        bytes.extend(of(field, frame).iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(f64::to_le_bytes));
        Ok(())
    })
    .unwrap();
    let stack = FrameStack::read(&path).unwrap();
    assert_eq!((stack.len(), stack.frame(1)), (2, Some(of(None, 1))));
    let mut archive = npz::Archive::open(&path).unwrap();
    let (numbers, shape) = archive.array("C").unwrap().unwrap();
    assert_eq!(shape, [2, 6, 3]);
    assert_eq!(numbers[18 + 15..18 + 18], [0.0, 25.0, 8.0]);
    assert_eq!(archive.array("V").unwrap().unwrap().0[15..18], [5.0, 0.5, -1.0 / 3.0]);

    let path = folder.path().join("a.usda");
    let body = UsdBody { name: "a", elements: mesh.view(), obstacle: false, width: 0.25 };
    write_usda_with_fields(&path, &[body], 2, 50.0, &Field::ALL, |field, _, frame| Ok(of(field, frame)))
        .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for line in
        ["        vector3f[] velocities.timeSamples = {", "        vector3f[] primvars:contactForce ("]
    {
        assert_eq!(text.lines().filter(|l| *l == line).count(), 3, "mesh, strands, particles: {line}");
    }
    assert!(text.contains("            1: [(0.0, 25.0, 8.0)],\n"), "{text}");
    assert_eq!(FrameSource::open(&path).unwrap().len(), 2);
}

#[test]
fn stages_name_everything_once() {
    let folder = folder();
    let path = folder.path().join("a.usda");
    let mesh = sample();
    let body = |name| UsdBody { name, elements: mesh.view(), obstacle: false, width: 0.25 };
    let bodies = [body("2 cloths"), body("cloth"), body("cloth_strands"), body("cloth")];
    write_usda(&path, &bodies, 2, 50.0, |_, frame| {
        Ok(mesh.positions.iter().map(|p| p + Vector::new(frame as f64, 0.0, 0.0)).collect())
    })
    .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for line in [
        "    upAxis = \"Z\"",
        "    metersPerUnit = 1",
        "    timeCodesPerSecond = 50",
        "    endTimeCode = 1",
        "    def Mesh \"_2_cloths\" (",
        "        displayName = \"2 cloths\"",
        "        custom bool bowknot:obstacle = 0",
        "    def Points \"cloth_particles\"",
        "    def Mesh \"cloth_strands_2\" (",
        "    def Mesh \"cloth_2\" (",
        "            1: [(2.0, 2.0, 3.0), (0.0, -2.0, -3.0)],",
        "            0: [(-1.125, -2.125, -3.125), (1.125, 2.125, 3.125)],",
    ] {
        assert!(text.lines().any(|l| l == line), "{line:?} is missing in\n{text}");
    }
    let mut prims: Vec<&str> = text.lines().filter(|line| line.starts_with("    def ")).collect();
    let count = prims.len();
    prims.sort_unstable();
    prims.dedup_by_key(|line| line.split('"').nth(1));
    assert_eq!((count, prims.len()), (12, 12));
}
