use crate::common::Scene;
use bowknot_baselines::Outcome;
use bowknot_baselines::twoway::Params;
use bowknot_baselines::twoway::geometry::{Point, Vector, intersection};
use bowknot_baselines::zones::{Impact, ImpactSearch};

/// Pairs of an edge and a triangle that meet at one of 200 times, by exact predicates.
fn meetings(scene: &Scene, paths: &[Vector]) -> usize {
    let topology = scene.model.topology();
    let mut found = std::collections::BTreeSet::new();
    for k in 0..=200 {
        let t = f64::from(k) / 200.0;
        let at: Vec<Point> = scene.x.iter().zip(paths).map(|(x, p)| x + t * p).collect();
        for (e, edge) in topology.edges.iter().enumerate() {
            for (f, triangle) in topology.triangles.iter().enumerate() {
                if !edge.iter().any(|v| triangle.contains(v)) {
                    let (edge, triangle) = (edge.map(|v| &at[v as usize]), triangle.map(|v| &at[v as usize]));
                    if intersection::edge_triangle(edge, triangle) {
                        found.insert((e, f));
                    }
                }
            }
        }
    }
    found.len()
}

#[test]
fn paths_without_impacts_meet_nothing_and_paths_that_meet_have_impacts() {
    let scene = Scene::two_sheets(3, 0.05);
    let collision = scene.collision_scene(Params::fast());
    let mut search = ImpactSearch::new(collision.model());
    let swapped = scene.swapped();
    let (mut clear, mut met) = (0, 0);
    for share in [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0] {
        let paths: Vec<Vector> = scene.x.iter().zip(&swapped).map(|(x, y)| share * (y - x)).collect();
        let mut outcome = Outcome::default();
        let impacts = search.find(&collision, &scene.x, &paths, f64::INFINITY, |_| true, &mut outcome);
        let meetings = meetings(&scene, &paths);
        assert_eq!(outcome.searches, 1);
        assert!(impacts.iter().all(|impact| (0.0..1.0).contains(&impact.time)));
        if impacts.is_empty() {
            assert_eq!(meetings, 0, "{share}");
            clear += 1;
        } else if meetings > 0 {
            met += 1;
        }
    }
    assert!(clear >= 2 && met >= 3, "{clear} clear, {met} met");
}

#[test]
fn a_pair_that_comes_from_afar_to_its_contact_distance_does_not_count_as_meeting() {
    // 10 m above: a tenth of that is a hundred times the contact distance.
    let scene = Scene::vertex_above_triangle(10.0);
    let mut params = Params::fast();
    params.contact.delta = Some(0.01);
    let collision = scene.collision_scene(params);
    let mut search = ImpactSearch::new(collision.model());
    let mut impacts = |height: f64| {
        let mut paths = vec![Vector::zeros(); 4];
        paths[3].z = height - 10.0;
        search.find(&collision, &scene.x, &paths, f64::INFINITY, |_| true, &mut Outcome::default()).len()
    };
    assert_eq!(impacts(0.01), 0);
    assert_eq!(impacts(-0.01), 1);
}

#[test]
fn later_rounds_of_a_call_find_what_a_search_of_its_own_finds() {
    let scene = Scene::two_sheets(4, 0.05);
    let collision = scene.collision_scene(Params::fast());
    let swapped = scene.swapped();
    let mut kept = ImpactSearch::new(collision.model());
    for thickness in [0.0, 0.8] {
        kept.thickness = thickness;
        let mut paths: Vec<Vector> = scene.x.iter().zip(&swapped).map(|(x, y)| 0.4 * (y - x)).collect();
        let mut state = 1u64;
        let mut counts = Vec::new();
        for round in 0..12 {
            // In some rounds a part of the pairs is refused, as those within a zone are.
            let accept =
                |impact: &Impact| round % 4 != 1 || !(impact.pair.elements[0] + round).is_multiple_of(3);
            let find = |search: &mut ImpactSearch| {
                search.find(&collision, &scene.x, &paths, f64::INFINITY, accept, &mut Outcome::default())
            };
            let mut alone = ImpactSearch::new(collision.model());
            alone.thickness = thickness;
            let impacts = find(&mut kept);
            assert_eq!(impacts, find(&mut alone));
            counts.push(impacts.len());
            // A few vertices get longer or shorter ways, back and forth; the others keep theirs.
            for _ in 0..4 {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let v = (state >> 33) as usize % paths.len();
                paths[v] *= [0.1, 0.5, 1.5, -0.3][(state >> 60) as usize % 4];
            }
        }
        assert!(counts.iter().any(|&n| n != counts[0]) && counts.iter().all(|&n| n > 0), "{counts:?}");
    }
}
