//! NumPy archives of frames.

use super::*;

#[test]
fn frames_stack_and_resume() {
    let folder = folder();
    let path: &Path = &folder.path().join("frames.npz");
    let mesh = sample();
    let mut stack = FrameStack::new(&MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() }, &[[0, 1, 2, 3]]);
    assert!(stack.is_empty() && stack.push(&mesh.positions));
    assert!(!stack.push(&mesh.positions[..2]), "a frame of another size is refused");
    let moved: Vec<Point> = mesh.positions.iter().map(|p| p * 2.0).collect();
    assert!(stack.push(&moved));
    stack.write(path).unwrap();
    let mut read = FrameStack::read(path).unwrap();
    assert_eq!(read, stack);
    assert_eq!((read.len(), read.frame(1), read.frame(2)), (2, Some(moved), None));
    assert_eq!(read.mesh().triangles.len(), 4);
    read.truncate(1);
    assert_eq!(read.len(), 1);

    let mut unsized_stack = FrameStack::new(&MeshView { positions: &[], ..mesh.view() }, &[]);
    assert!(unsized_stack.push(&mesh.positions) && !unsized_stack.push(&mesh.positions[1..]));
    unsized_stack.write(path).unwrap();
    assert_eq!(FrameStack::read(path).unwrap().frame(0), Some(mesh.positions));
}

#[test]
fn a_stack_that_is_streamed_is_the_stack() {
    let folder = folder();
    let (streamed, held) = (folder.path().join("a.npz"), folder.path().join("b.npz"));
    let mesh = sample();
    let view = MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() };
    let mut stack = FrameStack::new(&view, &[]);
    assert!(stack.push(&mesh.positions) && stack.push(&mesh.positions));
    stack.write(&held).unwrap();
    write_frame_stack(&streamed, &view, 2, |_, bytes| {
        bytes.extend(mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(f64::to_le_bytes));
        Ok(())
    })
    .unwrap();
    assert_eq!(FrameStack::read(&streamed).unwrap(), stack);
    let failing = write_frame_stack(&streamed, &view, 2, |_, _| Err(std::io::ErrorKind::StorageFull.into()));
    assert!(message(failing).contains("the disk is full"));
    assert_eq!(FrameStack::read(&streamed).unwrap(), stack, "the old file stays");
}

/// An archive of one array `X` with these bytes.
fn archive_of(bytes: &[u8], path: &Path) -> zip::result::ZipResult<()> {
    use std::io::Write;
    let mut zip = zip::ZipWriter::new(std::fs::File::create(path)?);
    zip.start_file("X.npy", zip::write::SimpleFileOptions::default())?;
    zip.write_all(bytes)?;
    zip.finish().map(drop)
}

/// Four gigabytes were allocated on the word of eight bytes.
#[test]
fn an_array_whose_header_claims_gigabytes_is_refused() {
    let folder = folder();
    let path = folder.path().join("frames.npz");
    for version in [2, 3] {
        archive_of(&[b"\x93NUMPY", &[version, 0, 0xff, 0xff, 0xff, 0xff][..], b"{}"].concat(), &path)
            .expect("written");
        let says = message(FrameStack::read(&path));
        assert!(says.contains("array X") && says.contains("claims 4294967295 bytes"), "{says}");
    }
}
