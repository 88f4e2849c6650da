//! The collision stage behind anyone's dynamics.

use crate::arrays::{self, Indices, Rows};
use crate::compute::compute;
use crate::contacts;
use crate::error;
use bowknot::check::{Judge, StateOptions};
use bowknot::geometry::Point;
use bowknot::recording::States;
use bowknot::simulator::Contact;
use bowknot::twoway::{
    AcceptedState, BodyContact, CollisionScene, HalfSpaceContact, Observer, ResolveInput, Statistics,
    max_stretch,
};
use bowknot_errors::counted;
use numpy::{PyArray2, PyReadonlyArray1};
use pyo3::exceptions::PyBaseException;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// Largest number of intersections of a start that a message names.
const MAX_LISTED: usize = 5;

/// A ratio of an edge's length in a target to its length at rest that no sane solver reaches: neighbors would have to
/// part by a hundred edges in one call.
const ABSURD_STRETCH: f64 = 100.0;

/// What a resolver is made of.
struct Inner {
    resolver: bowknot::twoway::Resolver,
    judge: Judge,
    fixed: Vec<bool>,
    groups: Vec<u32>,
    /// The state that the last call ended with, which needs no judge.
    last: Vec<Point>,
}

/// Moves positions toward a target without intersections.
#[pyclass(frozen, module = "bowknot._native")]
pub struct Resolver {
    /// None after an internal error.
    inner: Mutex<Option<Inner>>,
}

/// Ends a call when the user does.
struct Stop<'a>(&'a AtomicBool);

impl Stop<'_> {
    fn go_on(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for Stop<'_> {
    fn accepted(&mut self, _: &AcceptedState<'_>) -> ControlFlow<()> {
        self.go_on()
    }

    fn sees_each_state(&self) -> bool {
        false
    }

    fn advanced(&mut self, _: usize) -> ControlFlow<()> {
        self.go_on()
    }
}

/// How a call failed.
enum Fault {
    Input(String),
    Intersects(String),
}

/// An edge of a target that is far too long: its vertices, and its ratio to its rest length.
type LongEdge = ([u32; 2], f64);

/// A resolved state, what the call did as JSON, the longest edge of a target that no sane solver makes, and the
/// exception that a signal raised meanwhile.
type Resolved<'py> = (Bound<'py, PyArray2<f64>>, String, Option<LongEdge>, Option<Py<PyBaseException>>);

/// What a call did.
#[derive(Serialize)]
struct Info {
    #[serde(flatten)]
    statistics: Statistics,
    /// Largest ratio of a deformable body's edge in the target to its rest length.
    max_target_stretch: f64,
}

#[pymethods]
impl Resolver {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        rest: Rows<'_>,
        triangles: Indices<'_>,
        strands: Indices<'_>,
        particles: PyReadonlyArray1<'_, u32>,
        masses: PyReadonlyArray1<'_, f64>,
        fixed: PyReadonlyArray1<'_, bool>,
        obstacle: PyReadonlyArray1<'_, bool>,
        body: PyReadonlyArray1<'_, u32>,
        groups: PyReadonlyArray1<'_, u32>,
        planes: Rows<'_>,
        bodies: Rows<'_>,
        plane_contacts: Rows<'_>,
        sets: Vec<String>,
    ) -> PyResult<Self> {
        let params = bowknot::scene::twoway_params(&sets).map_err(error::input)?;
        let rest = arrays::points(&rest)?;
        let given = |value: f64| Some(value).filter(|value| !value.is_nan());
        let body_contact = |[thickness, delta, friction, stretch_limit]: [f64; 4]| BodyContact {
            thickness: given(thickness),
            delta: given(delta),
            friction: given(friction).unwrap_or(0.0),
            stretch_limit: given(stretch_limit),
        };
        let plane_contact = |[thickness, friction]: [f64; 2]| HalfSpaceContact {
            thickness: given(thickness),
            friction: given(friction).unwrap_or(0.0),
        };
        let problem = States {
            x: rest.clone(),
            rest,
            triangles: arrays::elements(&triangles)?,
            strands: arrays::elements(&strands)?,
            particles: arrays::column(&particles),
            masses: arrays::column(&masses),
            obstacle: arrays::column(&obstacle),
            body: arrays::column(&body),
            half_spaces: arrays::half_spaces(&planes)?,
            body_contacts: arrays::table(&bodies)?.into_iter().map(body_contact).collect(),
            half_space_contacts: arrays::table(&plane_contacts)?.into_iter().map(plane_contact).collect(),
            ..States::default()
        };
        let (fixed, groups) = (arrays::column(&fixed), arrays::column(&groups));
        let make = move |_: &Arc<AtomicBool>| -> Result<Inner, String> {
            let model = problem.collision_model()?;
            let judge = Judge::from_model(&model);
            let resolver = problem.resolver(model, params).map_err(|error| error.to_string())?;
            Ok(Inner { resolver, judge, fixed, groups, last: Vec::new() })
        };
        let inner = compute(py, make)?.finish()?.map_err(error::input)?;
        Ok(Self { inner: Mutex::new(Some(inner)) })
    }

    /// Moves `x` toward `y`. A start that the last call did not end with is judged first if `check` is true.
    #[pyo3(signature = (x, y, fixed, start, time_step, check))]
    #[allow(clippy::too_many_arguments)]
    fn resolve<'py>(
        &self,
        py: Python<'py>,
        x: Rows<'_>,
        y: Rows<'_>,
        fixed: Option<PyReadonlyArray1<'_, bool>>,
        start: Option<Rows<'_>>,
        time_step: Option<f64>,
        check: bool,
    ) -> PyResult<Resolved<'py>> {
        let (mut x, y) = (arrays::points(&x)?, arrays::points(&y)?);
        let start = start.map(|start| arrays::points(&start)).transpose()?;
        let fixed = fixed.map(|fixed| arrays::column(&fixed));
        let mut guard = self.inner.try_lock().map_err(|_| error::busy("resolver"))?;
        let inner = guard.as_mut().ok_or_else(|| error::broken("resolver"))?;
        let positions = &mut x;
        let work = |stop: &Arc<AtomicBool>| -> Result<(Info, Option<LongEdge>), Fault> {
            let Inner { resolver, judge, fixed: own, groups, last } = inner;
            if check && *positions != *last {
                refuse_intersections(judge, positions)?;
            }
            let input = ResolveInput {
                prescribed: fixed.as_deref().unwrap_or(own),
                time_step,
                start: start.as_deref(),
                groups,
                ..ResolveInput::default()
            };
            let statistics = resolver
                .resolve_with(positions, &y, &input, &mut Stop(stop))
                .map_err(|error| Fault::Input(error.to_string()))?;
            // What began unjudged is not known to be clear.
            if check {
                last.clone_from(positions);
            }
            let scene = resolver.scene();
            let [_, max_target_stretch] = max_stretch(scene, [positions, scene.rest()], &y);
            let long = match max_target_stretch > ABSURD_STRETCH {
                true => absurd_edge(scene, &y, input.prescribed),
                false => None,
            };
            Ok((Info { statistics, max_target_stretch }, long))
        };
        let done = compute(py, work)?;
        let (info, long) = match done.result {
            Err(message) => {
                *guard = None;
                return Err(error::internal(message));
            }
            Ok(Err(Fault::Input(message))) => return Err(error::input(message)),
            Ok(Err(Fault::Intersects(message))) => return Err(error::intersection(message)),
            Ok(Ok(info)) => info,
        };
        let info = serde_json::to_string(&info).map_err(error::internal)?;
        let signal = done.signal.map(|signal| signal.into_value(py));
        Ok((arrays::point_array(py, &x)?, info, long, signal))
    }

    /// The contacts that press at the end of the last call, which stood for a time step [s].
    fn contacts<'py>(&self, py: Python<'py>, time_step: f64) -> PyResult<Bound<'py, PyDict>> {
        if !(time_step.is_finite() && time_step > 0.0) {
            return Err(error::input(format!("dt {time_step} must be finite and above 0")));
        }
        let guard = self.inner.try_lock().map_err(|_| error::busy("resolver"))?;
        let inner = guard.as_ref().ok_or_else(|| error::broken("resolver"))?;
        let bodies = inner.resolver.scene().model().bodies().len();
        contacts::arrays_of(py, &Contact::of_call(&inner.resolver, time_step), bodies)
    }

    /// The lengths in force [m], by name.
    #[getter]
    fn lengths(&self) -> PyResult<Vec<(&'static str, f64)>> {
        let guard = self.inner.try_lock().map_err(|_| error::busy("resolver"))?;
        let inner = guard.as_ref().ok_or_else(|| error::broken("resolver"))?;
        let lengths = inner.resolver.scene().lengths();
        Ok(vec![
            ("edge", lengths.edge),
            ("delta", lengths.delta),
            ("min_separation", lengths.min_separation),
            ("contact_range", lengths.contact_range),
            ("separation_speed", lengths.separation_speed),
        ])
    }
}

/// The longest edge between two free vertices of a target that is more than [`ABSURD_STRETCH`] times as long as at
/// rest, and as the mean edge: edges at rest that are far shorter than the others tell nothing.
fn absurd_edge(scene: &CollisionScene, y: &[Point], prescribed: &[bool]) -> Option<LongEdge> {
    let (model, rest, mean) = (scene.model(), scene.rest(), scene.lengths().edge);
    let is_led = |v: u32| model.is_obstacle(v) || prescribed.get(v as usize) == Some(&true);
    let ratio = |&[a, b]: &[u32; 2]| {
        let length = |x: &[Point]| (x[a as usize] - x[b as usize]).norm();
        let (now, before) = (length(y), length(rest));
        let is_absurd = !is_led(a) && !is_led(b) && now > ABSURD_STRETCH * before.max(mean);
        is_absurd.then(|| ([a, b], now / before))
    };
    model.topology().edges.iter().filter_map(ratio).max_by(|(_, r), (_, s)| r.total_cmp(s))
}

/// Refuses a start that intersects.
fn refuse_intersections(judge: &Judge, x: &[Point]) -> Result<(), Fault> {
    let report = judge
        .check_state(x, &StateOptions { limit: MAX_LISTED, distance: false })
        .map_err(|error| Fault::Input(format!("x: {error}")))?;
    if report.is_clear() {
        return Ok(());
    }
    let count = counted(report.intersection_count, "pair intersects", "pairs intersect");
    let mut lines = vec![format!("x: {count} at the start")];
    lines.extend(report.intersections.iter().map(|pair| format!("  {pair}")));
    let rest = report.intersection_count - report.intersections.len();
    if rest > 0 {
        lines.push(format!("  and {rest} more"));
    }
    Err(Fault::Intersects(lines.join("\n")))
}
