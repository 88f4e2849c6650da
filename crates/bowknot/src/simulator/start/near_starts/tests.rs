use super::*;
use crate::simulator::Simulator;
use bowknot_io::{Mesh, write_obj};
use bowknot_scene::Scene;

fn near(text: &str) -> Vec<NearStart> {
    let scene = Scene::from_toml(text, "").expect("a scene");
    Simulator::new(&scene).expect("a start").near_starts()
}

fn sheets(gap: f64, edge: f64) -> String {
    let body = |name: &str, z: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ type = \"sheet\", size = [0.2, 0.2], edge = {edge} }}\n\
             translate = [0.0, 0.0, {z}]\n"
        )
    };
    format!(
        "[contact]\ndelta = 0.01\n{}{}[[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\n",
        body("low", 0.5),
        body("high", 0.5 + gap)
    )
}

#[test]
fn bodies_are_named_with_the_smallest_distance() {
    assert_eq!(near(&sheets(0.0101, 0.05)), []);
    let found = near(&sheets(0.004, 0.05));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((&found[0].bodies, found[0].within_part), (&["low".to_owned(), "high".to_owned()], false));
    assert!((found[0].distance_m - 0.004).abs() < 1e-12 && found[0].contact_distance_m == 0.01);
    assert!(found[0].pairs >= 25, "{found:?}");
    let text = found[0].to_string();
    assert!(text.contains(" of low and high, the nearest 4.000 of 10.000 mm at ("), "{text}");
    // Half-spaces have names.
    let low = sheets(0.05, 0.05).replace("0.5]", "0.003]").replace("0.55]", "0.5]");
    let found = near(&low);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].bodies[1].as_str(), found[0].pairs), ("ground", 25));
}

/// Edges far shorter than the contact distance.
#[test]
fn neighbors_in_a_fine_mesh_are_not_counted() {
    for edge in [0.004, 0.008, 0.011, 0.02] {
        assert_eq!(near(&sheets(0.05, edge)), [], "edges of {edge} m");
    }
    for shape in
        ["\"ball\", radius = 0.05, edge = 0.007", "\"tube\", radius = 0.02, length = 0.1, edge = 0.004"]
    {
        let text =
            format!("[contact]\ndelta = 0.01\n[[body]]\nname = \"it\"\nshape = {{ type = {shape} }}\n");
        assert_eq!(near(&text), [], "{shape}");
    }
}

/// Both sides of a plate thinner than the contact distance.
#[test]
fn the_sides_of_a_thin_solid_are_no_folds() {
    for size in ["[0.2, 0.2, 0.008]", "[0.06, 0.06, 0.005]"] {
        for edge in [0.02, 0.005] {
            let text = format!(
                "[contact]\ndelta = 0.01\n[[body]]\nname = \"it\"\nkind = \"solid\"\n\
                 shape = {{ type = \"block\", size = {size}, edge = {edge} }}\n"
            );
            assert_eq!(near(&text), [], "{size} {edge}");
        }
    }
}

/// A strip that is folded once: two layers 4 mm apart, joined by half of a circle.
#[test]
fn the_layers_of_a_folded_strip_are_counted() {
    let folder = tempfile::tempdir().expect("a folder");
    let edge = 0.01;
    let mut mesh = Mesh::default();
    let gap: f64 = 0.004;
    let around = std::f64::consts::PI * 0.5 * gap;
    let rows = 41;
    for k in 0..rows {
        let s = 0.2 * 2.0 * (f64::from(k) / f64::from(rows - 1) - 0.5);
        let angle = s / (0.5 * gap);
        let (x, z) = if s.abs() <= 0.5 * around {
            (0.5 * gap * angle.cos(), 0.5 * gap * angle.sin())
        } else {
            (0.5 * around - s.abs(), 0.5 * gap * s.signum())
        };
        for j in 0..5 {
            mesh.positions.push(Point::new(x, edge * f64::from(j), 0.5 + z));
        }
    }
    for (k, j) in (0..rows as u32 - 1).flat_map(|k| (0..4).map(move |j| (k, j))) {
        let [a, b, c, d] = [5 * k + j, 5 * k + j + 1, 5 * k + j + 5, 5 * k + j + 6];
        mesh.triangles.extend([[a, b, d], [a, d, c]]);
    }
    let path = folder.path().join("strip.obj");
    write_obj(&path, &mesh.view()).expect("written");
    let text = format!("[contact]\ndelta = 0.01\n[[body]]\nname = \"strip\"\nmesh = {path:?}\n");
    let found = near(&text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].within_part && found[0].pairs > 100, "{found:?}");
    assert!((found[0].distance_m - gap).abs() < 1e-9, "{found:?}");
    assert!(found[0].place_m[0] < -0.01, "not in the fold: {found:?}");
    assert!(found[0].to_string().contains("of folds of strip"), "{found:?}");
}
