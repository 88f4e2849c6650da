use super::scene;
use bowknot::geometry::Vector;
use bowknot::proximity::{PairList, ProximitySearch};
use bowknot::{Scene, Simulator};

const SHEET: &str = "[[body]]\nname = \"sheet\"\nshape = \
                     { type = \"sheet\", size = [0.3, 0.3], edge = 0.05 }\n\
                     translate = [0, 0, 0.01]\n";

const FAR: &str = "[[body]]\nname = \"far\"\nshape = { type = \"sheet\", size = [0.3, 0.3], edge = 0.05 }\n\
    translate = [3, 0, 2]\n";

const GROUND: &str = "[[obstacle]]\nname = \"ground\"\nshape = { type = \"half-space\" }\n";

fn simulator(text: &str) -> Simulator {
    Simulator::new(&scene(text)).unwrap_or_else(|error| panic!("{error}"))
}

/// Far from all others there is no row and no pair in range. In fast flight the search lists pairs of the
/// sheet with itself, because trust regions grow with the way, and a step ends at their border.
#[test]
fn a_body_in_flight_takes_no_part_in_collisions() {
    let mut flying = simulator(FAR);
    for _ in 0..30 {
        let statistics = flying.step().expect("a step");
        let rows = [statistics.contact_rows, statistics.active_rows, statistics.friction_rows];
        assert_eq!(rows, [0; 3], "time step {}", statistics.step);
        assert!(flying.resolver().state().contacts.pairs.is_empty());
        assert!(statistics.two_way_steps <= 2 * statistics.newton_iterations);
        assert_eq!(statistics.repulsion_springs, 0);
        assert!(statistics.remaining_m < 1e-15, "rounding at most: {}", statistics.remaining_m);
    }
}

#[test]
fn a_body_far_from_others_is_in_no_pair_of_theirs() {
    let mut both = simulator(&format!("{SHEET}{FAR}{GROUND}"));
    let far = both.world().bodies[1].vertices.clone();
    let mut most = 0;
    for _ in 0..30 {
        most = most.max(both.step().expect("a step").pressing_contacts);
        let pairs = &both.resolver().state().contacts.pairs;
        for pair in pairs.pairs() {
            assert!(pair.vertices.iter().all(|v| !far.contains(v)), "{pair:?}");
        }
    }
    assert!(most > 0, "the other sheet should reach the ground");
}

/// What a scene lacks is not indexed: no obstacles, particles and strands.
#[test]
fn a_search_indexes_what_is_there() {
    // Trees of vertices, edges, triangles and of particles and strands; those of the obstacle besides.
    let grains = "[[body]]\nname = \"grains\"\nkind = \"particles\"\n\
                  shape = { type = \"grains\", count = [2, 2, 2], spacing = 0.02 }\ntranslate = [0, 0, 1]\n";
    let strands = "[[body]]\nname = \"hair\"\nkind = \"strands\"\n\
                   shape = { type = \"strands\", count = 2, length = 0.2, segments = 4, spacing = 0.05 }\n\
                   translate = [2, 0, 1]\n";
    let ball = "[[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.1, edge = 0.05 }\n\
                translate = [-1, 0, 0]\n";
    for (text, trees) in [
        (SHEET.to_owned(), 3),
        (format!("{SHEET}{GROUND}"), 3),
        (format!("{SHEET}{ball}"), 6),
        (strands.to_owned(), 1),
        (grains.to_owned(), 1),
        (format!("{SHEET}{grains}"), 4),
        (format!("{SHEET}{grains}{strands}{ball}"), 8),
    ] {
        let simulator = simulator(&text);
        let model = &simulator.world().collision;
        let count = model.topology().vertex_count;
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        let mut search = ProximitySearch::new(model);
        for searched in 0..3 {
            search.search(
                model,
                &simulator.positions()[..count],
                &vec![0.01; count],
                &mut pairs,
                &mut separations,
            );
            let statistics = search.statistics();
            let obstacles = if text.contains(ball) { 3 } else { 0 };
            // Obstacles at rest are indexed by the first search alone.
            let expected = if searched == 0 { trees } else { trees - obstacles };
            assert_eq!(statistics.refits, expected, "search {searched} of {text}");
            assert_eq!(
                statistics.rebuilds,
                if searched == 0 { trees } else { 0 },
                "search {searched} of {text}"
            );
        }
    }
}

/// Without friction, stretch limits, solids and pins, their arrays stay empty and their passes do nothing.
#[test]
fn what_a_scene_lacks_has_no_data() {
    let mut plain = simulator(&format!("{SHEET}{GROUND}[contact]\nedges = false\n"));
    let mut seen = 0;
    for _ in 0..20 {
        let statistics = plain.step().expect("a step");
        assert_eq!([statistics.edge_rows, statistics.friction_rows, statistics.interior_solves], [0; 3]);
        assert!(statistics.waiting.is_empty());
        let state = plain.resolver().state();
        assert!(state.contacts.frictions.is_empty() && state.contacts.friction_multipliers.is_empty());
        assert!(state.call.slip_start().is_empty() && state.call.groups().of_vertices().is_empty());
        seen += state.contacts.pairs.len();
    }
    assert!(seen > 0, "the sheet should reach the ground");
    assert!(plain.checkpoint().anchors.is_empty());
}

/// Measures that nobody reads are not computed, and change no result.
#[test]
fn a_simulation_without_measures_goes_to_the_same_bits() {
    let scene = Scene::builtin("drape", 0.3).expect("a scene");
    let [mut measured, mut bare] = [true, false].map(|measures| {
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        simulator.set_measured(measures);
        simulator
    });
    for _ in 0..30 {
        let (with, without) = (measured.step().expect("a step"), bare.step().expect("a step"));
        assert!(with.energy.potential != 0.0 && with.max_stretch > 0.9);
        assert_eq!((without.energy, without.collision_energy_j), Default::default());
        assert_eq!((without.max_stretch, without.momentum), (0.0, [0.0; 3]));
        assert_eq!((with.two_way_steps, with.cg_iterations), (without.two_way_steps, without.cg_iterations));
    }
    assert_eq!(measured.checkpoint(), bare.checkpoint());
    assert!(measured.velocities().iter().any(|v| *v != Vector::zeros()));
}
