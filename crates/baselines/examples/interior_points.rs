//! Interior point methods side by side: two sheets pressed into each other and onto a spike.
//!
//! `cargo run --release -p bowknot-baselines --example interior_points -- [CELLS]`. Every method starts from
//! the same state and wants the same target. One run each; for reliable figures see
//! `bowknot-bench`.
#![allow(clippy::print_stdout)] // it is a command

use bowknot_baselines::barrier::{BarrierParams, Scaling, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact, SweptSearch};
use bowknot_baselines::twoway::geometry::{Point, Topology, Vector};
use bowknot_baselines::twoway::proximity::{BodyFilter, CollisionModel};
use bowknot_baselines::twoway::{
    CertifiedForward, CollisionScene, ContactData, ForwardStep, LcpBackward, Params, ResolveInput, Resolver,
    Search, TrustRegionSearch,
};
use bowknot_baselines::{Composed, Method};

/// Side of a cell [m].
const CELL: f64 = 0.01;

struct Scene {
    x: Vec<Point>,
    target: Vec<Point>,
    model: CollisionModel,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cells = std::env::args().nth(1).map_or(Ok(12), |text| text.parse())?;
    let Scene { x, target, model } = scene(cells)?;
    let masses = vec![1e-4; x.len()];
    let collision_scene =
        |params: Params| CollisionScene::new(model.clone(), &x, &masses, ContactData::default(), params);
    let slab = AdditiveCcd { speed: ClosingSpeed::Slab, ..AdditiveCcd::default() };
    let travel = AdditiveCcd::default();
    let barrier = BarrierParams::default();
    let plain = BarrierParams { scaling: Scaling::Mass, ..BarrierParams::default() };
    let (fast, paper) = (Params::fast, Params::paper);
    let (regions, swept) = (TrustRegionSearch::new, SweptSearch::new);

    let mut methods: Vec<Box<dyn Method>> = vec![
        two_way("two-way, fast", collision_scene(fast())?, regions, CertifiedForward::default()),
        two_way("two-way, paper", collision_scene(paper())?, regions, CertifiedForward::default()),
        two_way("two-way, earliest impact", collision_scene(fast())?, swept, EarliestImpact::new(travel)?),
        two_way("the same, slab speeds", collision_scene(fast())?, swept, EarliestImpact::new(slab)?),
        two_way("two-way, impact per vertex", collision_scene(fast())?, swept, PerVertexImpact::new(travel)?),
        two_way("the same, slab speeds", collision_scene(fast())?, swept, PerVertexImpact::new(slab)?),
    ];
    for (bound, params) in [("planes", fast()), ("isotropic", paper())] {
        for (scaling, barrier) in [("blocks", &barrier), ("mass", &plain)] {
            let resolver = by_descent(collision_scene(params.clone())?, barrier.clone())?;
            let name = format!("log barrier, descent by {scaling}, {bound}");
            methods.push(Box::new(Composed::new(name, resolver)));
        }
    }
    let newton = by_newton(collision_scene(paper())?, barrier.clone(), travel)?;
    methods.push(Box::new(Composed::new("log barrier, Newton", newton)));
    let ipc = by_newton(collision_scene(paper())?, BarrierParams::ipc(), travel)?;
    methods.push(Box::new(Composed::new("IPC", ipc)));
    let edges = BarrierParams { edge_stiffness: 1000.0, ..barrier };
    let newton = by_newton(collision_scene(paper())?, edges, travel)?;
    methods.push(Box::new(Composed::new("the same, edges by penalty", newton)));

    println!("{} vertices", x.len());
    println!("{:36} steps searches seconds  to target mm  stretch  converged", "");
    let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
    for method in &mut methods {
        let mut end = x.clone();
        let outcome = method.solve(&mut end, &target, &input)?;
        let squares: f64 = end.iter().zip(&target).map(|(a, b)| (a - b).norm_squared()).sum();
        let stretch = model.topology().edges.iter().map(|&[a, b]| {
            let length = |x: &[Point]| (x[a as usize] - x[b as usize]).norm();
            length(&end) / length(&x)
        });
        println!(
            "{:36} {:5} {:8} {:7.3} {:13.4} {:8.3}  {}",
            method.name(),
            outcome.steps,
            outcome.searches,
            outcome.seconds.total,
            1e3 * (squares / x.len() as f64).sqrt(),
            stretch.fold(0.0, f64::max),
            outcome.converged,
        );
    }
    Ok(())
}

fn two_way<S: Search + 'static, F: ForwardStep<S> + 'static>(
    name: &str,
    scene: CollisionScene,
    search: impl FnOnce(&CollisionScene) -> S,
    forward: F,
) -> Box<dyn Method> {
    let search = search(&scene);
    let backward = LcpBackward::new();
    Box::new(Composed::new(name, Resolver::with_stages(scene, search, backward, forward)))
}

/// Two sheets, the upper one turned, and a spike below; the target presses them together and down.
fn scene(cells: usize) -> Result<Scene, Box<dyn std::error::Error>> {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    let n = cells + 1;
    let half = 0.5 * CELL * cells as f64;
    for sheet in 0..2 {
        let (base, (sine, cosine)) = (x.len(), (0.4 * f64::from(sheet)).sin_cos());
        for k in 0..n * n {
            let (u, v) = ((k % n) as f64 * CELL - half, (k / n) as f64 * CELL - half);
            x.push(Point::new(
                cosine * u - sine * v,
                sine * u + cosine * v,
                0.004 + 0.003 * f64::from(sheet),
            ));
        }
        for k in (0..n * n).filter(|k| k % n < cells && k / n < cells) {
            let [a, b, c, d] = [k, k + 1, k + n + 1, k + n].map(|v| (base + v) as u32);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let first = x.len();
    let mut target: Vec<Point> =
        (0..first).map(|v| x[v] + (if v < n * n { -0.015 } else { -0.025 }) * Vector::z()).collect();
    for (u, v) in [(1.3, 0.2), (-0.6, 1.1), (-0.7, -1.2)] {
        x.push(Point::new(0.3 * CELL + CELL * u, 0.2 * CELL + CELL * v, -4.0 * CELL));
    }
    x.push(Point::new(0.3 * CELL, 0.2 * CELL, 0.0));
    let [a, b, c, tip] = [0, 1, 2, 3].map(|k| (first + k) as u32);
    triangles.extend([[a, b, tip], [b, c, tip], [c, a, tip]]);
    target.extend_from_slice(&x[first..]);
    let bodies = (0..x.len()).map(|v| (v / (n * n)).min(2) as u32).collect();
    let topology =
        Topology::builder(x.len()).triangles(triangles).build().map_err(|errors| format!("{errors:?}"))?;
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    Ok(Scene { x, target, model: CollisionModel::new(topology, bodies, filters, vec![])? })
}
