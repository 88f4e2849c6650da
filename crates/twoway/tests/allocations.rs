//! In the steady state, a two-way step allocates nothing: buffers are kept from step to step and from call to
//! call. A second call that repeats the first must find all buffers large enough.
//!
//! The test has a binary of its own, because it replaces the allocator.
#![allow(unsafe_code, clippy::unwrap_used)]

use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{AcceptedState, Params, ResolveInput, Resolver, Statistics, StopRule};
use std::alloc::{GlobalAlloc, Layout, System};
use std::backtrace::Backtrace;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

#[path = "suite/common/sheet.rs"]
mod sheet;

/// Whether allocations count now.
static COUNTS: AtomicBool = AtomicBool::new(false);
static COUNT: AtomicUsize = AtomicUsize::new(0);
/// Where the first allocations came from.
static FIRST: Mutex<Vec<Backtrace>> = Mutex::new(Vec::new());

struct Counting;

impl Counting {
    fn note(&self) {
        if COUNTS.swap(false, Ordering::Relaxed) {
            if COUNT.fetch_add(1, Ordering::Relaxed) < 4 {
                FIRST.lock().unwrap().push(Backtrace::force_capture());
            }
            COUNTS.store(true, Ordering::Relaxed);
        }
    }
}

// SAFETY: all calls go to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.note();
        // SAFETY: as promised by the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        self.note();
        // SAFETY: as promised by the caller.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as promised by the caller.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Two sheets above the ground and each other.
fn scene() -> (Vec<Point>, CollisionModel) {
    let (mut x, mut triangles, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
    for (body, height) in [0.05, 0.12].into_iter().enumerate() {
        sheet::sheet(20, 0.1, height, &mut x, &mut triangles);
        bodies.resize(x.len(), body as u32);
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let filters = vec![BodyFilter::DEFORMABLE; 2];
    (x, CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap())
}

/// Allocations between the first and the last accepted state of the second of two equal calls toward
/// `target`.
fn allocations(target: impl Fn(&Point) -> Point) -> (usize, Statistics) {
    let (start, model) = scene();
    let mut params = Params::fast();
    // As many steps as make progress, whatever the residuals.
    params.solver.stop.rule = StopRule::Clock { remaining_fraction: f64::MIN_POSITIVE };
    params.solver.stop.max_steps = Some(24);
    let masses = vec![1.0; start.len()];
    let mut resolver = Resolver::new(model, &start, &masses, params).unwrap();
    let target: Vec<Point> = start.iter().map(target).collect();
    let mut statistics = Statistics::default();
    for call in 0..2 {
        let mut x = start.clone();
        let mut observe = |_: &AcceptedState<'_>| {
            COUNTS.store(call == 1, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        statistics = resolver.resolve_with(&mut x, &target, &ResolveInput::default(), &mut observe).unwrap();
        COUNTS.store(false, Ordering::Relaxed);
    }
    (COUNT.swap(0, Ordering::Relaxed), statistics)
}

#[test]
fn steps_after_the_first_call_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    // Down through the other sheet and the ground, with a wave that folds them.
    let pressed = |p: &Point| Point::new(p.x, p.y, 0.1 * (9.0 * p.x).sin() - p.z);
    let (count, statistics) = pool.install(|| allocations(pressed));
    assert!(statistics.contact_rows > 100 && statistics.active_rows > 0, "{statistics:?}");
    assert!(statistics.searches > 4 && statistics.steps >= 8, "{statistics:?}");
    let first: Vec<String> = FIRST.lock().unwrap().iter().map(Backtrace::to_string).collect();
    assert_eq!(count, 0, "the first of {count} allocations:\n{}", first.join("\n\n"));
}
