//! Cloth that folds is neither crushed nor overstretched.

use bowknot::{Scene, Simulator};

#[test]
fn a_sheet_that_falls_on_a_ball_keeps_its_edges() {
    let scene = Scene::builtin("drape", 0.6).unwrap_or_else(|error| panic!("{error}"));
    let mut simulator = Simulator::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let is_sheet =
        |v: u32| simulator.world().bodies.iter().any(|b| b.kind.is_some() && b.vertices.contains(&v));
    let edges: Vec<[usize; 2]> = simulator
        .world()
        .collision
        .topology()
        .edges
        .iter()
        .filter(|edge| is_sheet(edge[0]))
        .map(|edge| edge.map(|v| v as usize))
        .collect();
    let lengths = |simulator: &Simulator| -> Vec<f64> {
        let x = simulator.positions();
        edges.iter().map(|&[a, b]| (x[a] - x[b]).norm()).collect()
    };
    let rest = lengths(&simulator);
    for step in 1..=80 {
        simulator.step().unwrap_or_else(|error| panic!("{error}"));
        for ((now, rest), edge) in lengths(&simulator).iter().zip(&rest).zip(&edges) {
            let ratio = now / rest;
            assert!((0.93..1.1).contains(&ratio), "time step {step}: edge {edge:?} is {ratio} of its length");
        }
    }
}
