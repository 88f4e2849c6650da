//! The same bits on any number of threads, and as the serial solver.

#![allow(clippy::unwrap_used)] // helpers outside the test functions

mod common;
use bowknot_lcp::*;
use common::{Case, cloth};

fn problem<'a>(case: &'a Case, order: Option<&'a [u32]>, starts: &'a [u32]) -> Problem<'a> {
    let rows = Family::new(&case.rows, Schedule { order, starts });
    let balls = Family::new(&case.balls, Schedule::coloured(&case.ball_starts));
    Problem::new(&case.weights, rows, balls, Family::default()).unwrap()
}

fn bits(
    problem: &Problem<'_>,
    case: &Case,
    solve: impl Fn(&Problem<'_>, &mut State<'_>) -> Info + Sync + Send,
) -> (Vec<u64>, Info) {
    let (mut y, mut lambda, mut forces) = case.start();
    let mut state = State { y: &mut y, lambda: &mut lambda, forces: &mut forces, friction: &mut [] };
    let info = solve(problem, &mut state);
    let reals = y.iter().chain(&forces).flat_map(|v| [v.x, v.y, v.z]).chain(lambda);
    (reals.map(f64::to_bits).collect(), info)
}

#[test]
fn coloured_sweeps_give_the_serial_bits_on_any_number_of_threads() {
    let case = cloth(60, 6000, 5);
    let all = problem(&case, None, &case.row_starts);
    validate_colours(&all).unwrap();
    // Every third row left out.
    let (mut order, mut starts) = (Vec::new(), vec![0]);
    for ends in case.row_starts.windows(2) {
        order.extend((ends[0]..ends[1]).filter(|r| r % 3 != 0));
        starts.push(order.len() as u32);
    }
    let some = problem(&case, Some(&order), &starts);
    validate_colours(&some).unwrap();
    let params = Params { max_sweeps: 5, ..Params::default() };
    for problem in [all, some] {
        let serial = bits(&problem, &case, |p, s| solve_serial(p, s, &params).unwrap());
        for threads in [1, 2, 3, 5, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for _ in 0..5 {
                let coloured =
                    pool.install(|| bits(&problem, &case, |p, s| solve_coloured(p, s, &params).unwrap()));
                assert!(coloured == serial, "{threads} threads");
            }
        }
    }
}
