//! A scene of the CPU as the device needs it.

use super::error::GpuResolveError;
use crate::{Collision, CollisionError, Constraints, Engine, Grid, Lengths, Settings};
use bowknot_geometry::Point;
use bowknot_twoway::constraints::{ContactForm, EdgeForm, EdgeReference, FrictionModel};
use bowknot_twoway::stepper::{Bound, TrustRegionRule};
use bowknot_twoway::{CallInput, CollisionScene, ContactSide, ResolveInput, StopRule};

/// Longest travel of a vertex in a step, in local edge lengths.
pub fn longest_travel(scene: &CollisionScene) -> f64 {
    scene.params().solver.forward.trust_region_max
}

/// The scene on the engine, on a grid with room from `positions` to `ends` [m], and the grid around the
/// positions `home` that it begins with. Trees are ordered by the positions `order`.
pub fn collision<E: Engine>(
    engine: E,
    scene: &CollisionScene,
    [home, order, positions, ends]: [&[Point]; 4],
    call: &CallInput,
    input: &ResolveInput<'_>,
) -> Result<(Collision<E>, Grid), CollisionError> {
    let (model, params) = (scene.model(), scene.params());
    let vertices = 0..scene.vertex_count();
    let body = |v: usize| model.vertex_body()[v];
    let contact = |v: usize| &scene.contact().bodies()[body(v) as usize];
    let limit = |[a, b]: &[u32; 2]| {
        let rest = (scene.rest()[*a as usize] - scene.rest()[*b as usize]).norm();
        let limits = params.contact.edges;
        if limits { scene.stretch_limit(body(*a as usize)) * rest } else { f64::INFINITY }
    };
    let has_friction = scene.friction_model() != FrictionModel::None;
    let of_vertices = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { vertices.clone().map(value).collect() };
    let frictions = if has_friction { of_vertices(&|v| contact(v).friction) } else { Vec::new() };
    let half_spaces = scene.contact().half_spaces();
    let side = |side: ContactSide| match side {
        ContactSide::Body(b) => b,
        ContactSide::HalfSpace(h) => model.bodies().len() as u32 + h,
    };
    let pair_friction = |&(sides, friction): &([ContactSide; 2], f64)| (sides.map(side), friction);
    let pair_frictions: Vec<([u32; 2], f64)> =
        scene.contact().pair_frictions().iter().filter(|_| has_friction).map(pair_friction).collect();
    let lengths = Lengths {
        edges: &of_vertices(&|v| scene.local_edge(v)),
        margins: &of_vertices(&|v| scene.spacing().margin(body(v))),
        deltas: &of_vertices(&|v| scene.spacing().delta(body(v))),
        half_space_deltas: &of_vertices(&|v| scene.spacing().half_space_delta(body(v))),
        thicknesses: &of_vertices(&|v| contact(v).thickness.unwrap_or(f64::NAN)),
        half_space_thicknesses: &half_spaces
            .iter()
            .map(|h| h.thickness.unwrap_or(f64::NAN))
            .collect::<Vec<_>>(),
        min_separation: scene.lengths().min_separation,
        edge_limits: &model.topology().edges.iter().map(limit).collect::<Vec<f64>>(),
    };
    let constraints = Constraints {
        prescribed: call.prescribed(),
        groups: input.groups,
        masses: &of_vertices(&|v| scene.relative_mass(v)),
        frictions: &frictions,
        half_space_frictions: &half_spaces.iter().map(|h| h.friction).collect::<Vec<_>>(),
        pair_frictions: &pair_frictions,
    };
    let backward = &params.solver.backward;
    let defaults = Settings::default();
    let settings = Settings {
        sweeps: backward.sweeps_of(call.has_unknown()),
        cluster_sweeps: defaults.cluster_sweeps,
        bucket_sweeps: defaults.bucket_sweeps,
        bucket_vertices: defaults.bucket_vertices,
        polish_sweeps: backward.polish_sweeps,
        polish_distance: backward.polish_distance * scene.lengths().edge,
        polish_stretch: 1.0 + 0.5 * params.solver.stop.stretch_tolerance,
        edge_proximal: backward.edge_proximal,
        contact_proximal: backward.contact_proximal,
        proximal_growth: backward.proximal_growth,
        range: params.contact.range,
        active: params.contact.active,
        contacts_only: params.contact.contacts_only,
        known: bowknot_twoway::KNOWN,
        guarded: bowknot_twoway::GUARDED,
        guarded_floor: bowknot_twoway::GUARDED_FLOOR,
        guarded_stretch: bowknot_twoway::GUARDED_STRETCH,
        coarse_correction: backward.coarse_correction,
        damping: params.solver.forward.damping,
        longest_travel: params.solver.forward.trust_region_max,
        smallest_radius: params.solver.forward.trust_region_min,
        progress: bowknot_twoway::MIN_PROGRESS * scene.lengths().edge,
    };
    let home_grid = Collision::<E>::grid_around(home, scene.rest(), &lengths)?;
    let grid = home_grid.for_motion(positions, ends, lengths.min_separation);
    let grid = grid.ok_or_else(|| CollisionError::OutsideGrid {
        vertex: ends.iter().position(|x| home_grid.nearest(x).is_none()).unwrap_or(0),
    })?;
    let collision =
        Collision::on_grid(engine, &grid, model, order, scene.rest(), &lengths, &constraints, &settings)?;
    Ok((collision, home_grid))
}

/// Refuses what the kernels do not have.
pub fn refuse_unsupported(scene: &CollisionScene) -> Result<(), GpuResolveError> {
    const FAST: Option<&str> = Some("the preset `fast`");
    let params = scene.params();
    let (contact, solver) = (&params.contact, &params.solver);
    let filter = scene.friction_model() == FrictionModel::Filter;
    let refused = [
        (contact.form != ContactForm::Gap, "contact.form other than \"gap\"", FAST),
        (filter, "contact.friction_model = \"filter\"", FAST),
        (contact.edge_form != EdgeForm::Ball, "contact.edge_form other than \"ball\"", FAST),
        (contact.edge_reference != EdgeReference::Rest, "contact.edge_reference other than \"rest\"", FAST),
        (!solver.backward.active_rows, "solver.backward.active_rows = false", FAST),
        (solver.forward.bound != Bound::Planes, "solver.forward.bound other than \"planes\"", FAST),
        (
            solver.forward.trust_region != TrustRegionRule::PerVertex,
            "solver.forward.trust_region other than \"per-vertex\"",
            FAST,
        ),
        (!matches!(solver.stop.rule, StopRule::Travel { .. }), "solver.stop.rule = \"clock\"", FAST),
        (
            solver.forward.trust_region_min.max(solver.forward.trust_region_max) > 1.0,
            "solver.forward.trust_region_min or trust_region_max above 1",
            FAST,
        ),
        (scene.lengths().min_separation == 0.0, "contact.min_separation = 0", None),
    ];
    match refused.into_iter().find(|(refused, ..)| *refused) {
        Some((_, what, instead)) => Err(GpuResolveError::Unsupported { what: what.to_owned(), instead }),
        None => Ok(()),
    }
}
