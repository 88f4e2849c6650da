use super::*;
use bowknot_geometry::{HalfSpace, Point, Vector};
use bowknot_twoway::BodyContact;

/// Level sheets of n x n squares of 1 cm at these heights, each a body of its own, over a half-space far
/// below.
fn sheets(n: usize, heights: &[f64]) -> States {
    let mut states = States {
        half_spaces: vec![HalfSpace { normal: Vector::z(), offset: -1.0 }],
        time_step: Some(0.01),
        ..States::default()
    };
    for (body, &z) in heights.iter().enumerate() {
        let first = states.x.len() as u32;
        let side = n as u32 + 1;
        for at in 0..side * side {
            let (i, j) = (f64::from(at % side), f64::from(at / side));
            states.x.push(Point::new(0.01 * i, 0.01 * j, z));
            states.body.push(body as u32);
        }
        for at in (0..side * (side - 1)).filter(|at| at % side + 1 < side) {
            let at = first + at;
            states.triangles.push([at, at + 1, at + side]);
            states.triangles.push([at + 1, at + side + 1, at + side]);
        }
        states.body_contacts.push(BodyContact { friction: 0.1 * body as f64, ..BodyContact::default() });
    }
    let n = states.x.len();
    states.y = states.x.clone();
    states.rest = states.x.clone();
    states.masses = vec![1e-4; n];
    states.fixed = vec![false; n];
    states.obstacle = vec![false; n];
    states
}

fn reduced(states: &States, params: &Params, failure: Failure) -> States {
    let part = states.reduce(params, failure, Limits::default()).expect("the whole shows it");
    assert!(part.minimal && part.of == states.element_count(), "{} tries", part.tries);
    let found = part.states.failure(params, failure == Failure::Unsafe, &|| false);
    assert_eq!(found.map(|(found, _)| found), Some(failure), "{:?}", part.states);
    // It survives its file.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("part.npz");
    part.states.write(&path).expect("written");
    let read = States::read(&path).expect("read");
    assert_eq!(
        (&read.x, &read.triangles, &read.body),
        (&part.states.x, &part.states.triangles, &part.states.body)
    );
    part.states
}

#[test]
fn of_an_intersecting_start_two_elements_are_left() {
    let mut states = sheets(8, &[0.0, 0.1, 0.2]);
    // One vertex of the middle sheet is pulled through the upper one.
    let vertex = 81 + 40;
    states.x[vertex].z = 0.25;
    let part = reduced(&states, &Params::default(), Failure::Intersects);
    assert_eq!((part.triangles.len(), part.half_spaces.len(), part.x.len()), (2, 0, 6));
    // Bodies 1 and 2 became 0 and 1, and kept what they bring into contacts.
    assert_eq!(part.body, [0, 0, 0, 1, 1, 1]);
    let frictions: Vec<f64> = part.body_contacts.iter().map(|contact| contact.friction).collect();
    assert_eq!(frictions, [0.1, 0.2]);
    assert!(part.x.contains(&states.x[vertex]));
}

#[test]
fn of_a_call_that_ends_at_its_limit_few_elements_are_left() {
    let mut states = sheets(6, &[0.0, 0.004, 0.5]);
    // The middle sheet is to fall through the lower one; the upper one moves freely.
    let fall = |v: usize| if states.body[v] == 1 { 0.05 } else { 0.0 };
    states.y = (0..states.x.len()).map(|v| states.x[v] - fall(v) * Vector::z()).collect();
    let mut params = Params::default();
    params.solver.stop.max_steps = Some(1);
    let part = reduced(&states, &params, Failure::NotConverged);
    assert!(part.element_count() <= 4, "{} elements", part.element_count());
    // With the default number of steps the same problem converges, and has no failure to reduce.
    assert!(states.reduce(&Params::default(), Failure::NotConverged, Limits::default()).is_none());
}

#[test]
fn a_problem_with_arrays_of_the_wrong_length_is_not_reduced() {
    let mut states = sheets(2, &[0.0, 0.1]);
    states.x[12].z = -0.5;
    let reduce = |states: &States| states.reduce(&Params::default(), Failure::Intersects, Limits::default());
    assert!(reduce(&states).is_some());
    states.body_contacts.pop();
    assert!(reduce(&states).is_none());
}

#[test]
fn of_a_call_that_is_refused_the_element_that_it_is_about_is_left() {
    let mut states = sheets(4, &[0.0, 0.1]);
    states.y[30].z = 1e13;
    let (failure, place) = states.failure(&Params::default(), false, &|| false).expect("refused");
    assert_eq!(place, Some(states.x[30]));
    let part = reduced(&states, &Params::default(), failure);
    assert_eq!(part.element_count(), 1);
    assert!(part.y.iter().any(|y| y.z == 1e13));
}

#[test]
fn strands_grains_and_half_spaces_are_elements_too() {
    let mut states = sheets(2, &[0.0]);
    let first = states.x.len() as u32;
    for (k, z) in [(0.0, 0.1), (1.0, 0.1), (2.0, 0.1), (0.0, 0.2)] {
        states.x.push(Point::new(0.05 * k, 0.0, z));
        states.body.push(if z == 0.1 { 1 } else { 2 });
    }
    states.strands = vec![[first, first + 1], [first + 1, first + 2]];
    states.particles = vec![first + 3];
    states.body_contacts.extend([BodyContact::default(); 2]);
    let n = states.x.len();
    (states.y, states.rest) = (states.x.clone(), states.x.clone());
    (states.masses, states.fixed, states.obstacle) = (vec![1e-4; n], vec![false; n], vec![false; n]);
    assert_eq!(states.failure(&Params::default(), true, &|| false), None);

    let mut grain = states.clone();
    grain.x[first as usize + 3] = Point::new(0.03, 0.0, 0.1);
    let part = reduced(&grain, &Params::default(), Failure::Intersects);
    assert_eq!((part.triangles.len(), part.strands.len(), part.particles.len()), (0, 1, 1));

    let mut sunk = states;
    sunk.x[first as usize].z = -2.0;
    let part = reduced(&sunk, &Params::default(), Failure::Intersects);
    assert_eq!((part.strands.len(), part.half_spaces.len(), part.element_count()), (1, 1, 2));
}
