//! The collision stage behind anyone's dynamics, and the judge.

use crate::error::{BowknotStatus, Failure, guarded, input, intersects};
use crate::memory::{array, elements, exclusive, points, shared};
use bowknot::check::{Judge, StateOptions};
use bowknot::geometry::{BodyFilter, CollisionModel, HalfSpace, Point, Topology, Vector};
use bowknot::twoway::{BodyContact, ContactData, HalfSpaceContact, Params, ResolveInput, Resolver};
use bowknot_errors::counted;

/// Largest number of intersections of a start that a message names.
const NAMED: usize = 5;

/// Moves positions toward targets without intersections, whatever computes the targets.
pub struct BowknotResolver {
    inner: Resolver,
    judge: Judge,
    obstacle: Vec<bool>,
    /// The state that the last call ended with, which needs no judge.
    last: Vec<Point>,
}

/// What collides. Arrays may be NULL where their count is 0, or where it says so.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct BowknotMesh {
    /// x y z of each vertex at rest [m].
    pub rest: *const f64,
    /// How many vertices there are.
    pub vertices: usize,
    /// Three vertices for each triangle.
    pub triangles: *const u32,
    /// How many triangles there are.
    pub triangle_count: usize,
    /// Two vertices for each edge of strands.
    pub edges: *const u32,
    /// How many such edges there are.
    pub edge_count: usize,
    /// Vertices that are grains.
    pub particles: *const u32,
    /// How many grains there are.
    pub particle_count: usize,
    /// Mass of each vertex [kg]. NULL: all have the same.
    pub masses: *const f64,
    /// Whether each vertex belongs to an obstacle, which goes to its targets as they are. NULL: none does.
    pub obstacle: *const bool,
    /// Four numbers for each half-space: a normal and an offset [m]; what lies at n . x < offset is solid.
    pub planes: *const f64,
    /// How many half-spaces there are.
    pub plane_count: usize,
    /// Coefficient of Coulomb friction of everything.
    pub friction: f64,
    /// Contact distance [m]; 0: a share of the edges' length.
    pub delta: f64,
    /// Largest ratio of an edge's length to its rest length; 0: no limit.
    pub stretch_limit: f64,
}

/// What a call did.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct BowknotResolved {
    /// Whether no vertex wants to move any more.
    pub converged: bool,
    /// Two-way steps.
    pub steps: u32,
    /// Smallest distance of a pair [m]; infinite if none is within reach.
    pub min_gap: f64,
    /// Largest ratio of an edge's length to its rest length.
    pub max_stretch: f64,
}

/// Makes a resolver. The handle is written to `resolver`, NULL if the call fails. The arrays are copied.
///
/// # Safety
/// `mesh` points to a `BowknotMesh` whose arrays have the entries that it says; `resolver` points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_resolver_new(
    mesh: *const BowknotMesh,
    resolver: *mut *mut BowknotResolver,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (out, mesh) = unsafe { (exclusive("resolver", resolver)?, shared("mesh", mesh)?) };
        *out = std::ptr::null_mut();
        // SAFETY: by the contract.
        let made = unsafe { make(mesh)? };
        *out = Box::into_raw(Box::new(made));
        Ok(())
    })
}

/// Frees a resolver; NULL does nothing.
///
/// # Safety
/// The handle is null or one of `bowknot_resolver_new` that has not been freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_resolver_free(resolver: *mut BowknotResolver) {
    if !resolver.is_null() {
        guarded(|| {
            // SAFETY: it came from a box, by the contract.
            drop(unsafe { Box::from_raw(resolver) });
            Ok(())
        });
    }
}

/// Moves `x` toward `y`, both x y z of each vertex [m], `count` numbers. `x` must be free of intersections: unless it is what
/// the last call ended with, the judge looks at it. Where there is friction, `time_step` [s] is the time between both; 0: none.
/// What the call did is written to `resolved`, unless that is NULL. If it fails `x` stays as it is.
///
/// # Safety
/// The handle is that of a resolver; both arrays have so many entries; `resolved` is null or points to a
/// `BowknotResolved`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_resolver_resolve(
    resolver: *mut BowknotResolver,
    x: *mut f64,
    y: *const f64,
    count: usize,
    time_step: f64,
    resolved: *mut BowknotResolved,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (resolver, out) = unsafe { (exclusive("resolver", resolver)?, resolved.as_mut()) };
        // SAFETY: by the contract.
        let [mut state, target] =
            unsafe { [points("x", array("x", x, count)?)?, points("y", array("y", y, count)?)?] };
        if state != resolver.last {
            refuse_intersections(&resolver.judge, &state)?;
        }
        let call = ResolveInput {
            prescribed: &resolver.obstacle,
            time_step: (time_step != 0.0).then_some(time_step),
            ..ResolveInput::default()
        };
        let did = resolver.inner.resolve_with(&mut state, &target, &call, &mut ()).map_err(input)?;
        for (k, number) in state.iter().flat_map(|x| [x.x, x.y, x.z]).enumerate() {
            // SAFETY: `state` has as many numbers as the array, by whose entries it was made.
            unsafe { x.add(k).write(number) };
        }
        let did = BowknotResolved {
            converged: did.converged,
            steps: did.steps as u32,
            min_gap: did.min_gap_m.unwrap_or(f64::INFINITY),
            max_stretch: did.max_stretch,
        };
        out.into_iter().for_each(|out| *out = did);
        resolver.last = state;
        Ok(())
    })
}

/// Judges a state, x y z of each vertex [m], with exact arithmetic: how many pairs intersect is written to `intersections`.
///
/// # Safety
/// The handle is that of a resolver; the array has so many entries; `intersections` points to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_resolver_intersections(
    resolver: *const BowknotResolver,
    x: *const f64,
    count: usize,
    intersections: *mut usize,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (resolver, out) =
            unsafe { (shared("resolver", resolver)?, exclusive("intersections", intersections)?) };
        // SAFETY: by the contract.
        let x = unsafe { points("x", array("x", x, count)?)? };
        let options = StateOptions { limit: 0, distance: false };
        *out = resolver.judge.check_state(&x, &options).map_err(input)?.intersection_count;
        Ok(())
    })
}

/// Contact distance [m]: pairs nearer than this press on each other. NaN for NULL.
///
/// # Safety
/// The handle is null or that of a resolver.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_resolver_delta(resolver: *const BowknotResolver) -> f64 {
    // SAFETY: by the contract.
    unsafe { resolver.as_ref() }.map_or(f64::NAN, |resolver| resolver.inner.scene().lengths().delta)
}

/// Makes a resolver of a mesh.
///
/// # Safety
/// The arrays of the mesh have the entries that it says.
unsafe fn make(mesh: &BowknotMesh) -> Result<BowknotResolver, Failure> {
    let count = mesh.vertices;
    let times =
        |count: usize, by: usize| count.checked_mul(by).ok_or_else(|| input("mesh: a count is too large"));
    // SAFETY: by the contract.
    let (rest, triangles, edges, particles, planes) = unsafe {
        (
            points("rest", array("rest", mesh.rest, times(count, 3)?)?)?,
            elements("triangles", array("triangles", mesh.triangles, times(mesh.triangle_count, 3)?)?)?,
            elements("edges", array("edges", mesh.edges, times(mesh.edge_count, 2)?)?)?,
            array("particles", mesh.particles, mesh.particle_count)?.to_vec(),
            array("planes", mesh.planes, times(mesh.plane_count, 4)?)?,
        )
    };
    let masses = match mesh.masses.is_null() {
        true => vec![1.0; count],
        // SAFETY: by the contract.
        false => unsafe { array("masses", mesh.masses, count)? }.to_vec(),
    };
    let obstacle = match mesh.obstacle.is_null() {
        true => vec![false; count],
        // SAFETY: by the contract; as bytes, since C may write others than 0 and 1.
        false => unsafe { array("obstacle", mesh.obstacle.cast::<u8>(), count)? }
            .iter()
            .map(|&flag| flag != 0)
            .collect(),
    };
    let plane = |row: &[f64; 4]| {
        let normal = Vector::new(row[0], row[1], row[2]);
        let point = Point::from(normal * (row[3] / normal.norm_squared()));
        HalfSpace::new(point, normal).ok_or_else(|| input(format!("planes: {row:?} has no normal")))
    };
    let planes: Vec<HalfSpace> = planes.as_chunks::<4>().0.iter().map(plane).collect::<Result<_, _>>()?;
    let topology = Topology::builder(count)
        .triangles(triangles)
        .strand_edges(edges)
        .particles(particles)
        .build()
        .map_err(|errors| input(errors.first().map(ToString::to_string).unwrap_or_default()))?;
    let bodies = obstacle.iter().map(|&flag| u32::from(flag)).collect();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let optional = |number: f64| (number != 0.0).then_some(number);
    let body = BodyContact {
        friction: mesh.friction,
        delta: optional(mesh.delta),
        stretch_limit: optional(mesh.stretch_limit),
        ..BodyContact::default()
    };
    let plane = HalfSpaceContact { friction: mesh.friction, ..HalfSpaceContact::default() };
    let contact = ContactData {
        bodies: vec![body; 2],
        half_spaces: vec![plane; planes.len()],
        ..ContactData::default()
    };
    let model = CollisionModel::new(topology, bodies, filters, planes).map_err(input)?;
    let judge = Judge::from_model(&model);
    let inner = Resolver::with_contact(model, &rest, &masses, contact, Params::fast()).map_err(input)?;
    Ok(BowknotResolver { inner, judge, obstacle, last: Vec::new() })
}

fn refuse_intersections(judge: &Judge, x: &[Point]) -> Result<(), Failure> {
    let options = StateOptions { limit: NAMED, distance: false };
    let report = judge.check_state(x, &options).map_err(|error| input(format!("x: {error}")))?;
    if report.is_clear() {
        return Ok(());
    }
    let count = counted(report.intersection_count, "pair intersects", "pairs intersect");
    let lines = report.intersections.iter().map(|pair| format!("\n  {pair}"));
    Err(intersects(format!("x: {count} at the start{}", lines.collect::<String>())))
}
