use crate::Place;
use std::path::Path;

/// The blocks of a tutorial in a language.
fn blocks<'a>(tutorial: &'a str, language: &str) -> Vec<&'a str> {
    let begin = format!("```{language}\n");
    tutorial.split(&*begin).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn a_garment_from_a_modeling_tool() {
    let tutorial = include_str!("../../../../docs/tutorials/garment.md");
    let place = Place::new();
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes");
    for name in ["shirt.obj", "shirt.mtl", "character.ply"] {
        std::fs::copy(meshes.join(name), place.path(name)).unwrap();
    }
    let [scene] = blocks(tutorial, "toml")[..] else { panic!("one scene") };
    place.write("shirt.toml", scene);
    let commands: Vec<&str> = blocks(tutorial, "sh")
        .iter()
        .flat_map(|block| block.lines())
        .filter_map(|line| line.split('#').next()?.trim().strip_prefix("bowknot "))
        .collect();
    assert_eq!(commands.len(), 8);
    for command in commands {
        let ended = place.run(command);
        let expected = match command.split(' ').next() {
            Some("check") => 1,
            // Without a driver there are no pictures; `render` says so by code 3, and is not always built.
            Some("render") if ended.code == 3 || !cfg!(feature = "render") => continue,
            _ => 0,
        };
        assert_eq!(ended.code, expected, "{ended:#?}");
        match command.split(' ').next() {
            Some("info") => assert!(ended.stdout.contains("0.3310 x 0.7649 x 0.4567 m"), "{ended:#?}"),
            Some("repair") => assert!(
                ended.stdout.contains("304 intersections") && ended.stdout.contains("in 1 part"),
                "{ended:#?}"
            ),
            Some("run") => assert!(ended.stdout.contains("no intersection"), "{ended:#?}"),
            _ => {}
        }
    }
    let frame = place.read("out/shirt/frames/000040.obj");
    for line in ["o shirt", "g left_sleeve", "usemtl sleeves", "mtllib ../../../shirt.mtl"] {
        assert!(frame.lines().any(|found| found == line), "{line}");
    }
    let stage = place.read("out/shirt/scene.usda");
    assert!(stage.contains("primvars:st") && stage.contains("def GeomSubset \"sleeves\""), "subsets");
    assert!(place.path("out/shirt/pc2/shirt.pc2").exists() && place.path("out/shirt/report.html").exists());
}
