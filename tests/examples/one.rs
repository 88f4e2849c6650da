//! debug
use bowknot_tests::contact::{Ground, Slider, Slope};
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let find = |n: &str| Slider::ALL.into_iter().find(|s| format!("{s:?}") == n).unwrap();
    let findg = |n: &str| Ground::ALL.into_iter().find(|s| format!("{s:?}") == n).unwrap();
    let mut slope = Slope::new(find(&a[0]), findg(&a[1]), a[2].parse().unwrap());
    slope.settings = a[4..].to_vec();
    let folder = tempfile::tempdir().unwrap();
    let mut sim = bowknot::Simulator::new(&slope.scene(folder.path())).unwrap();
    for _ in 0..a[3].parse().unwrap() {
        let s = sim.step().unwrap();
        let v = bowknot_tests::contact::velocity(&sim);
        let c = bowknot_tests::contact::center(&sim);
        println!(
            "{:3} v {:9.5} {:9.5} {:9.5} z {:.6} it {} cg {} steps {} springs {} rows {} res {:.2e} N {:.2e} m coll_e {:.2e} el {:.2e} gap {:?}",
            s.step,
            v.x,
            v.y,
            v.z,
            c.z,
            s.newton_iterations,
            s.cg_iterations,
            s.two_way_steps,
            s.repulsion_springs,
            s.active_rows,
            s.residual_n,
            s.residual_m,
            s.collision_energy_j,
            s.energy.elastic,
            s.min_gap_m.map(|g| (g * 1e6).round())
        );
    }
}
