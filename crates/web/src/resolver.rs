//! The collision stage behind anyone's dynamics.

use crate::arrays;
use crate::error::{self, Thrown, input};
use crate::options::{Options, object};
use bowknot::check::{Judge, StateOptions};
use bowknot::geometry::{BodyFilter, CollisionModel, Point, Topology};
use bowknot::twoway::{BodyContact, ContactData, HalfSpaceContact, ResolveInput};
use bowknot_errors::counted;
use js_sys::{Float64Array, Object, Reflect, Uint32Array};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Largest number of intersections of a start that a message names.
const NAMED: usize = 5;

/// Keys of the options of a resolver.
const OPTIONS: [&str; 14] = [
    "rest",
    "triangles",
    "edges",
    "particles",
    "masses",
    "fixed",
    "bodies",
    "obstacles",
    "planes",
    "friction",
    "thickness",
    "delta",
    "stretchLimit",
    "sets",
];

/// Keys of the options of a call.
const OF_CALL: [&str; 4] = ["fixed", "timeStep", "start", "check"];

/// Moves positions toward targets without intersections, whatever computes the targets.
#[wasm_bindgen]
pub struct Resolver {
    inner: bowknot::twoway::Resolver,
    judge: Judge,
    fixed: Vec<bool>,
    /// The state that the last call ended with, which needs no judge.
    last: Vec<Point>,
}

#[wasm_bindgen]
impl Resolver {
    /// A resolver for these elements.
    #[wasm_bindgen(constructor)]
    pub fn new(
        #[wasm_bindgen(unchecked_param_type = "ResolverOptions")] options: &JsValue,
    ) -> Result<Resolver, Thrown> {
        let options = Options::new(options, "options", &OPTIONS)?;
        let params = bowknot::scene::twoway_params(&options.texts("sets")?).map_err(input)?;
        let Some(rest) = options.floats("rest")? else {
            return Err(input("options: rest, the positions at rest, is missing"));
        };
        let rest = arrays::points("rest", &rest)?;
        // A mass that is given as NaN is refused as such.
        let default = if options.get("masses").is_none() { 1.0 } else { f64::NAN };
        let masses = options.per("masses", rest.len())?.into_iter().map(|mass| mass.unwrap_or(default));
        let masses: Vec<f64> = masses.collect();
        let model = model(&options, rest.len())?;
        let (bodies, planes) = (model.bodies().len(), model.half_spaces().len());
        let columns = ["thickness", "delta", "friction", "stretchLimit"].map(|key| options.per(key, bodies));
        let [thickness, delta, friction, stretch_limit] = columns;
        let (thickness, delta, friction, stretch_limit) = (thickness?, delta?, friction?, stretch_limit?);
        let body = |b: usize| BodyContact {
            thickness: thickness[b],
            delta: delta[b],
            friction: friction[b].unwrap_or(0.0),
            stretch_limit: stretch_limit[b],
        };
        // One friction is that of everything; of several, half-spaces have none.
        let of_all = options.get("friction").and_then(|value| value.as_f64()).unwrap_or(0.0);
        let plane = HalfSpaceContact { thickness: None, friction: of_all };
        let contact = ContactData {
            bodies: (0..bodies).map(body).collect(),
            half_spaces: vec![plane; planes],
            ..ContactData::default()
        };
        let judge = Judge::from_model(&model);
        let fixed = flags(&options, "fixed", rest.len())?;
        let inner = bowknot::twoway::Resolver::with_contact(model, &rest, &masses, contact, params);
        Ok(Self { inner: inner.map_err(input)?, judge, fixed, last: Vec::new() })
    }

    /// Moves `x`, free of intersections, toward `y`; both are x y z of each vertex [m].
    #[wasm_bindgen(unchecked_return_type = "Resolved")]
    pub fn resolve(
        &mut self,
        x: &Float64Array,
        y: &Float64Array,
        #[wasm_bindgen(unchecked_optional_param_type = "ResolveOptions")] options: &JsValue,
    ) -> Result<JsValue, Thrown> {
        let (mut x, y) = (arrays::points("x", x)?, arrays::points("y", y)?);
        let options = Options::new(options, "options", &OF_CALL)?;
        let start = options.floats("start")?.map(|start| arrays::points("start", &start)).transpose()?;
        let fixed = match options.get("fixed") {
            Some(_) => flags(&options, "fixed", x.len())?,
            None => self.fixed.clone(),
        };
        let check = options.get("check").is_none_or(|check| check.is_truthy());
        if check && x != self.last {
            self.refuse_intersections(&x)?;
        }
        let input_of_call = ResolveInput {
            prescribed: &fixed,
            time_step: options.number("timeStep")?,
            start: start.as_deref(),
            ..ResolveInput::default()
        };
        let statistics = self.inner.resolve_with(&mut x, &y, &input_of_call, &mut ()).map_err(input)?;
        // What began unjudged is not known to be clear.
        if check {
            self.last.clone_from(&x);
        }
        let resolved: JsValue = Object::new().into();
        Reflect::set(&resolved, &"positions".into(), &arrays::from_points(&x))?;
        Reflect::set(&resolved, &"converged".into(), &statistics.converged.into())?;
        Reflect::set(&resolved, &"info".into(), &object(&statistics)?)?;
        Ok(resolved)
    }

    /// How many pairs intersect in a state.
    #[wasm_bindgen(js_name = countIntersections)]
    pub fn count_intersections(&self, x: &Float64Array) -> Result<usize, Thrown> {
        let options = StateOptions { limit: 0, distance: false };
        let report = self.judge.check_state(&arrays::points("x", x)?, &options).map_err(input)?;
        Ok(report.intersection_count)
    }

    /// Contact distance [m]: pairs nearer than this press on each other.
    #[wasm_bindgen(getter)]
    pub fn delta(&self) -> f64 {
        self.inner.scene().lengths().delta
    }
}

impl Resolver {
    fn refuse_intersections(&self, x: &[Point]) -> Result<(), Thrown> {
        let options = StateOptions { limit: NAMED, distance: false };
        let report = self.judge.check_state(x, &options).map_err(|error| input(format!("x: {error}")))?;
        if report.is_clear() {
            return Ok(());
        }
        let count = counted(report.intersection_count, "pair intersects", "pairs intersect");
        let lines = report.intersections.iter().map(|pair| format!("\n  {pair}"));
        Err(error::intersection(format!("x: {count} at the start{}", lines.collect::<String>())))
    }
}

/// Truth values of all vertices; none is true by default.
fn flags(options: &Options, key: &str, count: usize) -> Result<Vec<bool>, Thrown> {
    let flags = options.flags(key)?.unwrap_or_else(|| vec![false; count]);
    match flags.len() == count {
        true => Ok(flags),
        false => Err(input(format!("{key}: {} truth values for {count} vertices", flags.len()))),
    }
}

/// What collides.
fn model(options: &Options, count: usize) -> Result<CollisionModel, Thrown> {
    let none = || Uint32Array::new_with_length(0);
    let indices = |key: &str| Ok::<_, Thrown>(options.indices(key)?.unwrap_or_else(none));
    let triangles = arrays::elements("triangles", &indices("triangles")?)?;
    let edges = arrays::elements("edges", &indices("edges")?)?;
    let topology = Topology::builder(count)
        .triangles(triangles)
        .strand_edges(edges)
        .particles(indices("particles")?.to_vec())
        .build()
        .map_err(|errors| input(errors.first().map(ToString::to_string).unwrap_or_default()))?;
    let obstacle = flags(options, "obstacles", count)?;
    let body = options.indices("bodies")?.map(|bodies| bodies.to_vec());
    let body = body.unwrap_or_else(|| obstacle.iter().map(|&flag| u32::from(flag)).collect());
    // There is an entry for each body up to the largest number, so that a stray large one would cost memory. Obstacles are
    // body 1 by default, even where there is one vertex.
    if let Some(&large) = body.iter().find(|&&body| body as usize >= count.max(2)) {
        return Err(input(format!("bodies: number {large}, but they are numbered 0, 1, 2 and so on")));
    }
    let bodies = body.iter().max().map_or(0, |&last| last as usize + 1);
    let mut filters: Vec<Option<bool>> = vec![None; bodies];
    for (vertex, (&body, &flag)) in body.iter().zip(&obstacle).enumerate() {
        if *filters[body as usize].get_or_insert(flag) != flag {
            return Err(input(format!(
                "obstacles: body {body} has obstacle and deformable vertices (vertex {vertex} differs from its first)"
            )));
        }
    }
    let filter = |flag: Option<bool>| match flag {
        Some(true) => BodyFilter::OBSTACLE,
        _ => BodyFilter::DEFORMABLE,
    };
    let planes =
        options.floats("planes")?.map(|planes| arrays::half_spaces("planes", &planes)).transpose()?;
    let filters = filters.into_iter().map(filter).collect();
    CollisionModel::new(topology, body, filters, planes.unwrap_or_default()).map_err(input)
}
