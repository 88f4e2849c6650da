//! Damaged, missing and unwritable files.

use super::*;

#[test]
fn every_truncation_of_a_binary_file_is_refused() {
    let folder = folder();
    let path = folder.path().join("whole.ply");
    write_ply(&path, &sample().view()).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        let path = write(&folder, "cut.ply", &whole[..length]);
        let text = message(read_ply(&path, &Import::default()));
        assert!(text.contains("cut.ply"), "{text}");
    }
    let path = folder.path().join("whole.npz");
    stack().write(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in (0..whole.len()).step_by(11) {
        let path = write(&folder, "cut.npz", &whole[..length]);
        assert!(FrameStack::read(&path).is_err(), "{length} of {} bytes", whole.len());
    }
}

#[test]
fn damaged_files_are_read_or_refused_but_never_panic() {
    let folder = folder();
    let ply = folder.path().join("whole.ply");
    write_ply(&ply, &sample().view()).unwrap();
    let npz = folder.path().join("whole.npz");
    stack().write(&npz).unwrap();
    let sources = [fs::read(&ply).unwrap(), fs::read(&npz).unwrap(), ply::ASCII.as_bytes().to_vec()];
    let mut random = fastrand::Rng::with_seed(1);
    for round in 0..900 {
        let mut bytes = sources[round % 3].clone();
        for _ in 0..1 + random.usize(..4) {
            let at = random.usize(..bytes.len());
            bytes[at] = random.u8(..);
        }
        let (name, is_npz) = [("d.ply", false), ("d.npz", true), ("d.ply", false)][round % 3];
        let path = write(&folder, name, &bytes);
        if is_npz {
            let _ = FrameStack::read(&path);
        } else {
            let _ = read_ply(&path, &Import::default());
            let _ = read_obj(&path, &Import::default());
        }
    }
}

#[test]
fn a_failed_write_keeps_the_old_file() {
    let folder = folder();
    let path = write(&folder, "a.txt", "old");
    let result = write_atomic(&path, |out| {
        use std::io::Write;
        out.write_all(b"half of the new")?;
        Err(std::io::ErrorKind::StorageFull.into())
    });
    assert!(message(result).contains("the disk is full"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let below = path.join("b.txt");
    assert!(message(write_text(&below, "")).contains("not a folder"));
}

#[test]
fn missing_files_and_wrong_endings() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    for path in [at("none.obj"), at("none.ply")] {
        let text = message(read_mesh(&path, &Import::default()));
        assert!(text.starts_with("cannot read") && text.contains("no such file"), "{text}");
    }
    assert!(message(FrameStack::read(&at("none.npz"))).contains("no such file"));
    assert!(
        message(read_mesh(&at("none.stl"), &Import::default()))
            .contains("only .obj, .ply, .msh, .t, .seg, .usda, .usd, .gltf, .glb files")
    );
    assert!(
        message(read_mesh(folder.path(), &Import::default()))
            .contains("only .obj, .ply, .msh, .t, .seg, .usda, .usd, .gltf, .glb files")
    );
    fs::create_dir(at("folder.npz")).unwrap();
    fs::create_dir(at("folder.ply")).unwrap();
    assert!(message(FrameStack::read(&at("folder.npz"))).contains("it is a folder"));
    assert!(message(read_mesh(&at("folder.ply"), &Import::default())).contains("it is a folder"));
}
