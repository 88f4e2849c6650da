use super::{Ended, Place, SMALL};

/// Side lengths of a PNG.
fn png_size(place: &Place, name: &str) -> [u32; 2] {
    let bytes = std::fs::read(place.path(name)).unwrap();
    assert_eq!(&bytes[1..4], b"PNG", "{name}");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

/// Whether pictures can be drawn on this machine; prints why not.
#[allow(clippy::print_stdout, reason = "a test that is skipped says so")]
fn drawn(ended: &Ended) -> bool {
    if ended.code == 3 && std::env::var_os("BOWKNOT_NEED_DRIVER").is_none() {
        println!("skipped: {}", ended.stderr);
        return false;
    }
    assert_eq!(ended.code, 0, "{ended:#?}");
    true
}

#[test]
fn a_run_becomes_pictures() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    if !drawn(&place.run("render run --out pictures/last.png --size 80x60")) {
        return;
    }
    assert_eq!(png_size(&place, "pictures/last.png"), [80, 60]);
    place.run("render run --out first.png --frame 0 --size 80x60 --indexed --view top").ok();
    let bytes = |name| std::fs::read(place.path(name)).unwrap();
    assert_ne!(bytes("first.png"), bytes("pictures/last.png"));

    place.run("render run --out all --size 64x48 --frames 0..3:2").ok();
    assert_eq!(place.files("all"), ["000000.png", "000002.png"]);

    let said = place.run("render run --out run.gif --size 64x48 --frames ..2").ok();
    assert!(said.stdout.contains("run.gif: 3 frames, 64 x 48 pixels"), "{said:#?}");
    assert_eq!(&bytes("run.gif")[..6], b"GIF89a");
    place.run("render run --out own.png --size 64x48 --camera 2,2,2 --target 0,0,0 --fov 40 --quiet").ok();
}

#[test]
fn each_quantity_gives_another_picture() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run --record")).ok();
    if !drawn(&place.run("render run --out plain.png --size 160x120")) {
        return;
    }
    let mut seen = vec![std::fs::read(place.path("plain.png")).unwrap()];
    for color in ["stretch", "gap", "speed", "remaining", "body"] {
        place.run(&format!("render run --out {color}.png --size 160x120 --color {color}")).ok();
        let bytes = std::fs::read(place.path(&format!("{color}.png"))).unwrap();
        assert!(!seen.contains(&bytes), "{color} looks like another picture");
        seen.push(bytes);
    }
    // Without recorded targets the statistics give the largest distance of each step.
    std::fs::remove_dir_all(place.path("run/states")).unwrap();
    place.run("render run --out steps.png --size 160x120 --color remaining --range 0..2.5").ok();
}

#[test]
fn wrong_arguments_are_refused() {
    let place = Place::new();
    place.run("render nowhere --out a.png").refused(2, &["nowhere", "no such folder"]);
    std::fs::create_dir(place.path("empty")).unwrap();
    place.run("render empty --out a.png").refused(2, &["empty", "scene.toml"]);
    place.run(&format!("{SMALL} --out run")).ok();
    place.run("render run --out a.jpg").refused(2, &["a.jpg", ".png"]);
    place.run("render run --out a.png --frame 4").refused(2, &["no frame 4", "0 to 3"]);
    place.run("render run --out a.gif --frames 2..9").refused(2, &["no frame 9"]);
    place.run("render run --out a.png --frames 0..2").refused(2, &["--frame"]);
    for (option, says) in [
        ("--frames 3..1", "ends before"),
        ("--frames x", "A..B"),
        ("--size 0x9", "from 16"),
        ("--camera 1,2", "three"),
        ("--target 1,2,3", "--camera"),
        ("--fov 200", "degrees"),
        ("--range 3..1", "below"),
        ("--color mood", "stretch"),
    ] {
        place.run(&format!("render run --out a.png {option}")).refused(2, &[says]);
    }
    std::fs::remove_dir_all(place.path("run/frames")).unwrap();
    place.run("render run --out a.png").refused(2, &["frames/*.ply", "--format ply"]);
}

#[test]
fn a_picture_that_is_too_large_says_which_would_fit() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    if !drawn(&place.run("render run --out small.png --size 64x48")) {
        return;
    }
    let says = ["16384 x 16384 pixels", "pixels at most", "such as 8192x8192", "--size"];
    place.run("render run --out large.png --size 16384x16384").refused(2, &says);
    assert!(!place.path("large.png").exists());
}

/// A layer of Mesa's drivers complains on stderr if it finds no Wayland display.
#[cfg(target_os = "linux")]
#[test]
fn without_a_display_nothing_is_printed() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    let words = "render run --out a.png --size 64x48";
    let output = place.command(words).env_remove("XDG_RUNTIME_DIR").output().unwrap();
    let ended = Ended::new(words, output);
    if drawn(&ended) {
        assert_eq!(ended.stderr, "", "{ended:#?}");
    }
}

/// The variables name a driver that does not exist.
#[cfg(target_os = "linux")]
#[test]
fn without_a_driver_the_package_is_named() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    let words = "render run --out a.png";
    let mut command = place.command(words);
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(variable, "/nonexistent/driver.json");
    }
    let ended = Ended::new(words, command.output().unwrap());
    ended.refused(3, &["no graphics driver", "apt install mesa-vulkan-drivers", "dnf install"]);
}
