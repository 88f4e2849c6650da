//! Parameters of a problem: a preset, and switches that it changes.

use bowknot_twoway::constraints::FrictionModel;
use bowknot_twoway::stepper::{Bound, Rounding, TrustRegionRule};
use bowknot_twoway::{BodyContact, HalfSpaceContact, Params};

/// A preset and what is changed in it. Lengths are in units of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Where the parameters start from.
    pub preset: Preset,
    /// The minimum separation; none: the default, a hundredth of the mean edge length.
    pub floor: Option<f64>,
    /// The guaranteed thickness of all bodies and half-spaces, if any.
    pub thickness: Option<f64>,
    /// Contact distance, if not by the mesh.
    pub delta: Option<f64>,
    /// Coefficient of friction of all bodies and half-spaces.
    pub friction: f64,
    /// Whether friction acts before each call as in the paper.
    pub filter: bool,
    /// Stretch limit, if not the default.
    pub stretch: Option<f64>,
    /// The bound, if not that of the preset.
    pub bound: Option<Bound>,
    /// The rule of the trust regions, if not that of the preset.
    pub region: Option<TrustRegionRule>,
    /// Share of a gap that a step may use up.
    pub damping: f64,
    /// Whether steps are never swept.
    pub unswept: bool,
    /// Largest number of two-way steps of a call.
    pub steps: usize,
}

/// A preset of the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// [`Params::fast`].
    Fast,
    /// [`Params::quick`].
    Quick,
    /// [`Params::paper`].
    Paper,
}

impl Default for Setup {
    /// The default parameters, and few steps.
    fn default() -> Self {
        Self {
            preset: Preset::Fast,
            floor: None,
            thickness: None,
            delta: None,
            friction: 0.0,
            filter: false,
            stretch: None,
            bound: None,
            region: None,
            damping: 0.9,
            unswept: false,
            steps: 12,
        }
    }
}

impl Setup {
    /// The setup with its minimum separation and thickness raised to what coordinates up to `largest`, in
    /// units of the scene, allow. Otherwise many problems would be refused.
    pub fn raised(&self, largest: f64) -> Self {
        let smallest = 1.01 * Rounding::smallest_min_separation(largest);
        let raise = |length: f64| if length > 0.0 { length.max(smallest) } else { length };
        Self { floor: self.floor.map(raise), thickness: self.thickness.map(raise), ..self.clone() }
    }

    /// The parameters. `scale`: length of the unit of the scene [m].
    pub fn params(&self, scale: f64) -> Params {
        let mut params = match self.preset {
            Preset::Fast => Params::fast(),
            Preset::Quick => Params::quick(),
            Preset::Paper => Params::paper(),
        };
        let of_scene = |length: Option<f64>| length.map(|length| length * scale);
        let (contact, solver) = (&mut params.contact, &mut params.solver);
        contact.min_separation = of_scene(self.floor);
        contact.delta = of_scene(self.delta);
        if self.filter {
            contact.friction_model = FrictionModel::Filter;
        }
        let forward = &mut solver.forward;
        forward.bound = self.bound.unwrap_or(forward.bound);
        if let Some(region) = self.region.filter(|region| *region != forward.trust_region) {
            // The radii of the rules have different units.
            let paper = Params::paper().solver.forward;
            let other = if region == paper.trust_region { paper } else { Params::fast().solver.forward };
            forward.trust_region = region;
            forward.trust_region_min = other.trust_region_min;
            forward.trust_region_max = other.trust_region_max;
        }
        forward.damping = self.damping;
        if self.unswept {
            forward.swept_travel = f64::INFINITY;
        }
        solver.stop.max_steps = Some(self.steps);
        params
    }

    /// Contact data of each body.
    pub fn body(&self, scale: f64) -> BodyContact {
        let thickness = self.thickness.map(|thickness| thickness * scale);
        BodyContact {
            thickness,
            friction: self.friction,
            stretch_limit: self.stretch,
            ..BodyContact::default()
        }
    }

    /// Contact data of each half-space.
    pub fn half_space(&self, scale: f64) -> HalfSpaceContact {
        let thickness = self.thickness.map(|thickness| thickness * scale);
        HalfSpaceContact { thickness, friction: self.friction }
    }
}
