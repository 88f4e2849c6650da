use crate::Place;

/// Two squares that meet along x = 1 without being joined, one of them with a triangle given twice.
const SEAM: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4\nf 1 4 3\n\
                    v 1 0 0\nv 2 0 0\nv 1 1 0\nv 2 1 0\nf 5 6 8\nf 5 8 7\nf 8 5 6\n";

#[test]
fn a_seam_is_welded_and_the_mesh_runs() {
    let place = Place::new();
    place.write("seam.obj", SEAM);
    let ended = place.run("check seam.obj --list 1 --dump bad.ply");
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert!(ended.stdout.contains("wrote 5 triangles to bad.ply"), "{ended:#?}");
    assert_eq!(ended.stdout.matches(" intersect at ").count(), 1, "{ended:#?}");
    place.run("info bad.ply").ok();

    let ended = place.run("repair seam.obj --out clean.obj").ok();
    for words in
        ["welded 2 border vertices", "given twice: 1", "in 1 part,", " 0 intersections", "wrote clean.obj"]
    {
        assert!(ended.stdout.contains(words), "{words:?}: {ended:#?}");
    }
    // The file may be in centimeters.
    assert!(ended.stdout.contains("(units of the file)") && !ended.stdout.contains("e-2 m"), "{ended:#?}");
    let report = place.run("repair seam.obj --out clean.ply --json").ok().json();
    assert_eq!((&report["welded_vertices"], &report["repeated_triangles"]), (&2.into(), &1.into()));
    assert_eq!((&report["after"]["intersections"], &report["after"]["vertices"]), (&0.into(), &6.into()));
    assert!(report["before"]["intersections"].as_u64().unwrap() > 0);
    place.run("check clean.obj clean.ply").ok();
    place.run("run clean.obj --frames 1").ok();
}

/// The panels of [`SEAM`] as quads with texture coordinates of their own, and a triangle given twice.
const TEXTURED: &str = "mtllib cloth.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nv 2 \
                        1 0\n\
                        vt 0 0\nvt 0.4 0\nvt 0.4 1\nvt 0 1\nvt 0.6 0\nvt 1 0\nvt 1 1\nvt 0.6 1\n\
                        g left\nusemtl silk\nf 1/1 2/2 4/3 3/4\ng right\nusemtl wool\nf 5/5 6/6 8/7 7/8\nf \
                        8/7 5/5 6/6\n";

#[test]
fn what_an_obj_says_about_faces_is_kept() {
    let place = Place::new();
    place.write("seam.obj", TEXTURED);
    let ended = place.run("repair seam.obj --out clean.obj").ok();
    assert!(!ended.stdout.contains("left out"), "{ended:#?}");
    let clean = place.read("clean.obj");
    assert!(clean.starts_with("mtllib cloth.mtl\n"), "{clean}");
    // Welded vertices have one number, and a texture coordinate for each panel.
    let faces = "g left\nusemtl silk\nf 1/1 2/2 4/3 3/4\ng right\nusemtl wool\nf 2/5 5/6 6/7 4/8\n";
    assert!(clean.ends_with(faces), "{clean}");
    let ended = place.run("repair seam.obj --out clean.ply").ok();
    for words in ["left out", "texture coordinates", "names of objects"] {
        assert!(ended.stdout.contains(words), "{words:?}: {ended:#?}");
    }
    // A vertex on the edge of the quad splits a triangle of it.
    let seam = "v 1 0.4 0\nv 2 0 0\nv 2 1 0\nf 5 7 6\nf 5 8 7\nf 2 5 6\nv 1 1 0\n";
    let left = TEXTURED.split("g right").next().unwrap().replace("v 1 0 0\nv 2 0 0\nv 1 1 0\nv 2 1 0\n", "");
    place.write("t.obj", left + "g right\n" + seam);
    let ended = place.run("repair t.obj --out t-clean.obj").ok();
    assert!(ended.stdout.contains("cut polygons around these triangles: 1"), "{ended:#?}");
    let clean = place.read("t-clean.obj");
    assert!(clean.contains("vt 0.4 0.4\n") && clean.contains("usemtl silk\n"), "{clean}");
}

/// Without the triangle given twice, it is the seam that keeps the mesh from running.
#[test]
fn the_remedy_names_repair() {
    let place = Place::new();
    place.write("seam.obj", SEAM.replace("f 8 5 6\n", ""));
    place.run("run seam.obj --frames 1").refused(2, &["intersect", "bowknot repair"]);
}

#[test]
fn what_remains_is_said() {
    let place = Place::new();
    place.write(
        "cross.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.3 0.2 1\nv 5 5 0\nf 1 2 3\nf 4 5 6\n",
    );
    let ended = place.run("repair cross.obj --out out.ply");
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert!(ended.stdout.contains("part 0 (3 vertices) with part 1 (3 vertices)"), "{ended:#?}");
    assert!(ended.stdout.contains("--weld-distance"), "{ended:#?}");
}

#[test]
fn what_cannot_be_repaired() {
    let place = Place::new();
    place.write("seam.obj", SEAM);
    place.run("repair seam.obj").refused(2, &["--out"]);
    place.run("repair seam.obj --out clean.stl").refused(2, &["clean.stl", ".obj or .ply", ".msh or .t"]);
    place.run("repair none.obj --out clean.obj").refused(2, &["none.obj", "no such file"]);
    place.run("repair seam.obj --out none/clean.obj").refused(2, &["none/clean.obj"]);
    for distance in ["0", "-1", "nan", "x"] {
        place
            .run(&format!("repair seam.obj --out a.obj --weld-distance={distance}"))
            .refused(2, &["--weld-distance"]);
    }
    place.write("points.obj", "v 0 0 0\np 1\n");
    place.run("repair points.obj --out a.obj").refused(2, &["points.obj", "no triangles"]);
    place.write("solid.t", "Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nTet 0 0 1 2 3\n");
    place.run("repair solid.t --out a.obj").refused(2, &["a.obj", "solid.t has tetrahedra", ".msh or .t"]);
    place
        .run("repair seam.obj --out a.msh")
        .refused(2, &["a.msh", "seam.obj has no tetrahedra", ".obj or .ply"]);
    assert!(!place.path("a.obj").exists());
}

/// A scene of one solid above the ground.
const SOLID: &str = "[simulation]\nframes = 3\n[[body]]\nname = \"it\"\nkind = \"solid\"\nmesh = \"MESH\"\n\
                     translate = [0.0, 0.0, 1.5]\n[[obstacle]]\nshape = \"half-space\"\n";

/// Two tetrahedra, all that can be wrong with them, and a scene that takes what is left.
#[test]
fn a_solid_is_repaired_and_runs() {
    let place = Place::new();
    let text = "Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nVertex 4 0 0 -1\nVertex 5 \
                0.1 0.1 2\n\
                Vertex 6 0 1e-6 0\nVertex 7 1 1 0\nVertex 8 9 9 9\n\
                Tet 0 0 1 2 3\nTet 1 6 1 2 4\nTet 2 2 1 0 3\nTet 3 0 1 2 5\nTet 4 1 1 2 3\nTet 5 0 1 2 7\n\
                Face 0 0 1 3\nFace 1 1 3 7\n";
    place.write("bad.t", text);
    place.write("scene.toml", SOLID.replace("MESH", "bad.t"));
    place.run("run scene.toml").refused(2, &["body it"]);
    let ended = place.run("repair bad.t --out clean.msh").ok();
    for words in [
        "before: cannot be checked, because a tetrahedron, triangle or strand names a vertex twice",
        "welded 1 vertex nearer than",
        "dropped tetrahedra given twice: 1; the first at (0.25",
        "named a vertex twice: 1;",
        "dropped flat tetrahedra: 1; the first at (0.5",
        "inside out: 1;",
        "on the same side of a face as another: 1; the first at (0.275",
        "triangles that stay (--drop-triangles drops them; a solid may have none): 1;",
        "volume: ",
        "after: 6 vertices, 2 tetrahedra, 7 triangles",
        "0 intersections",
    ] {
        assert!(ended.stdout.contains(words), "{words:?}: {ended:#?}");
    }
    for out in ["clean.msh", "clean.t"] {
        let report = place.run(&format!("repair bad.t --out {out} --drop-triangles --json")).ok().json();
        assert_eq!((&report["after"]["tets"], &report["after"]["vertices"]), (&2.into(), &5.into()));
        assert_eq!(report["solid"]["overlapping"]["count"], 1);
        place.write("scene.toml", SOLID.replace("MESH", out));
        let ended = place.run(&format!("run scene.toml --check --out out-{out}")).ok();
        assert!(!ended.stderr.contains("warning"), "{ended:#?}");
    }
}
