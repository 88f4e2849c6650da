//! The tables of a scene that belong to the facade itself; the others are the crates' own parameters.

use bowknot_constraints::FrictionModel;
use bowknot_dynamics::{Integrator, NewtonParams};
use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::{BackwardParams, ForwardParams, StopParams};
use serde::{Deserialize, Serialize};

/// Time and the order of work within a time step; with [`bowknot_dynamics::Environment`] this is the table
/// `[simulation]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SimulationParams {
    /// Name of the scene in reports. Default: the file's name without its ending.
    pub name: String,
    /// Time step [s]; one frame is one time step. Larger: fewer, harder collision problems, and more
    /// damping by implicit Euler. Default 0.01.
    pub dt: f64,
    /// How time is integrated: `implicit-euler`, of first order, which damps what vibrates, or `sdirk2`, of
    /// second order, which makes two solves for a time step. Default `implicit-euler`.
    pub integrator: Integrator,
    /// Number of time steps of a run [1]. Default 100.
    pub frames: usize,
    /// Most Newton iterations per time step, each with a collision problem [1]; they end earlier at
    /// `solver.newton.step_tolerance`. More: contact and large deformation come nearer to the solution of the
    /// time step. Default 8.
    pub newton_iterations: usize,
    /// When collisions are resolved: after each Newton iteration, `newton`, or once at the end of the
    /// time step, `step`. Default `newton`.
    pub collision_every: CollisionEvery,
    /// How vertices inside of solids follow their surface where collisions keep it from its target:
    /// `elastic`, by a solve with the surface held, or `average`, by the corrections of their neighbors,
    /// cheaper and coarser. Default `elastic`.
    pub interior: InteriorFollows,
}

/// How vertices inside of solids follow their surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InteriorFollows {
    /// By an elastic solve with the surface held.
    #[default]
    Elastic,
    /// By the corrections of their neighbors.
    Average,
}

/// When collisions are resolved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CollisionEvery {
    /// After each Newton iteration: the next one starts from a state without intersections.
    #[default]
    Newton,
    /// Once per time step, after the last Newton iteration.
    Step,
}

/// A set of defaults for the tables `[contact]` and `[solver]`; [`crate::Scene::with_preset`] has all of
/// them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Everything that measurements showed to pay, [`bowknot_twoway::Params::fast`].
    #[default]
    Fast,
    /// [`Self::Fast`] with loose tolerances, [`bowknot_twoway::Params::quick`]: for previews. Nothing
    /// intersects either.
    Quick,
    /// The method as the paper describes it, [`bowknot_twoway::Params::paper`].
    Paper,
}

impl Preset {
    /// The parameters of the preset.
    pub fn params(self) -> bowknot_twoway::Params {
        match self {
            Self::Fast => bowknot_twoway::Params::fast(),
            Self::Quick => bowknot_twoway::Params::quick(),
            Self::Paper => bowknot_twoway::Params::paper(),
        }
    }
}

/// How a time step is solved, the table `[solver]`: the collision stage and Newton's method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SceneSolverParams {
    /// The backward step of the collision stage.
    pub backward: BackwardParams,
    /// Its forward step and trust regions.
    pub forward: ForwardParams,
    /// When a call of the collision stage ends.
    pub stop: StopParams,
    /// Newton's method and its linear solves.
    pub newton: NewtonParams,
    /// Contact forces of the dynamics.
    pub repulsion: RepulsionParams,
    /// Bodies at rest.
    pub sleep: SleepParams,
}

/// Contact forces of the dynamics, `[solver.repulsion]` (paper, section 6.2): springs between surfaces that
/// are near, in Newton's method, whose force follows from the gap, with friction. Without
/// them the collision stage alone holds bodies apart, and what rests on something is deformed within each
/// time step. The guarantee does not rest on them. Grains have none where they touch grains or obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RepulsionParams {
    /// What the springs are: `contact`, or `quadratic` as in the paper. Default contact. Under
    /// `contact.friction_model = "filter"` they are always quadratic, and pairs with friction have none: the
    /// filter takes friction from how deep targets are.
    pub law: RepulsionLaw,
    /// Stiffness of the springs in units of the bodies' own at the contact [1]; 0 switches them off. Larger:
    /// contacts give way less in the dynamics, its linear system takes longer. Default 3 (paper: 1000).
    pub stiffness: f64,
}

/// The springs of near surfaces in the dynamics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RepulsionLaw {
    /// Contacts: the force is infinite at a floor below the contact distance and has friction, and the
    /// iterations of a time step go on until the forces of all contacts are right.
    #[default]
    Contact,
    /// A repulsion of quadratic energy (paper, section 6.2) from two contact distances on: targets lie less deep, and
    /// collisions are left to the collision stage.
    Quadratic,
}

impl RepulsionParams {
    /// Those of the paper. It gives neither reach nor stiffness: the reach is that up to which its search finds all
    /// pairs, and with this stiffness scenes take 0.4 to 1 times as many two-way steps as it
    /// reports, but the needle on finer meshes up to 12 times as many.
    pub fn paper() -> Self {
        Self { law: RepulsionLaw::Quadratic, stiffness: 1000.0 }
    }

    /// Whether the dynamics knows contacts and their forces, beside a model of friction.
    pub fn knows_contacts(&self, friction: FrictionModel) -> bool {
        self.stiffness > 0.0 && self.law == RepulsionLaw::Contact && friction != FrictionModel::Filter
    }
}

impl Default for RepulsionParams {
    fn default() -> Self {
        Self { law: RepulsionLaw::Contact, stiffness: 3.0 }
    }
}

/// Bodies at rest, `[solver.sleep]`. An island, bodies in contact range of each other, falls asleep when all
/// of its vertices have stayed within `distance` of where they were for `time`, and something at rest holds
/// it: an obstacle, a half-space or a pin. Bodies asleep do not move at all, take no time, and are obstacles
/// at rest for others. An island wakes before something comes into its contact range, and when its pins, the
/// wind or the forces on it change. A body sleeps as a whole: all of its strands or grains together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SleepParams {
    /// Whether bodies at rest fall asleep. What still creeps by less than `distance` in `time` is then
    /// stopped. Default true.
    pub enabled: bool,
    /// Largest distance of a vertex at rest from where it was [1], in the contact distance `contact.delta`.
    /// Larger: bodies fall asleep earlier, and faster creep is stopped. Default 0.1.
    pub distance: f64,
    /// How long it must stay there [s]. Larger: what only pauses, such as a pendulum at its turning point,
    /// stays awake, and bodies fall asleep later. Default 0.5.
    pub time: f64,
}

impl Default for SleepParams {
    fn default() -> Self {
        Self { enabled: true, distance: 0.1, time: 0.5 }
    }
}

/// What a run writes, the table `[output]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OutputParams {
    /// Formats of the frames: `ply`, `obj` and `vtu` write one file per frame, `pc2` one point cache per
    /// body, `npz`, `usd` and `gltf` one file of all frames at the end. Default `["ply"]`.
    pub formats: Vec<Format>,
    /// Time steps between checkpoints [1]; 0 writes one at the end only. Smaller: less is repeated after
    /// an interruption. Default 10.
    pub checkpoint_every: usize,
    /// Whether every accepted state x^(l) is written to `trace/`: hundreds of files per time step. Default
    /// false.
    pub trace: bool,
    /// Whether the collision problems are written to `states/`, for `bowknot resolve`. Default false.
    pub record: bool,
    /// Whether the velocities of all vertices are kept in `fields/velocities.f64`; frames in `vtu`, `npz` and
    /// `usd` then have them. Default false.
    pub velocities: bool,
    /// Whether the contact forces on all vertices are kept in `fields/contact_forces.f64`; frames in `vtu`,
    /// `npz` and `usd` then have them. Default false.
    pub contact_forces: bool,
}

/// Format of the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Binary PLY with double coordinates.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// NumPy archive of all frames.
    Npz,
    /// Point caches, one per body.
    Pc2,
    /// Universal Scene Description of all frames, as text.
    Usd,
    /// VTK XML for ParaView.
    Vtu,
    /// Binary glTF of all frames, as morph targets.
    Gltf,
}

impl Default for SimulationParams {
    fn default() -> Self {
        Self {
            name: String::new(),
            dt: 0.01,
            integrator: Integrator::default(),
            frames: 100,
            newton_iterations: 8,
            collision_every: CollisionEvery::default(),
            interior: InteriorFollows::default(),
        }
    }
}

impl Default for OutputParams {
    fn default() -> Self {
        Self {
            formats: vec![Format::Ply],
            checkpoint_every: 10,
            trace: false,
            record: false,
            velocities: false,
            contact_forces: false,
        }
    }
}

impl SimulationParams {
    /// Largest [`Self::newton_iterations`].
    pub const MAX_NEWTON_ITERATIONS: usize = 1000;
}

impl Parameters for SimulationParams {
    fn check(&self, checks: &mut Checks) {
        let fits = (1e-6..=1.0).contains(&self.dt);
        checks.require(fits, "dt", self.dt, "must be a number of seconds from 1e-6 to 1");
        checks.require(self.frames <= 1_000_000, "frames", self.frames, "must be at most 1000000");
        let iterations = self.newton_iterations;
        let fits = (1..=Self::MAX_NEWTON_ITERATIONS).contains(&iterations);
        checks.require(fits, "newton_iterations", iterations, "must lie from 1 to 1000");
    }
}

impl Parameters for RepulsionParams {
    fn check(&self, checks: &mut Checks) {
        checks.non_negative("stiffness", self.stiffness);
    }
}

impl Parameters for SleepParams {
    fn check(&self, checks: &mut Checks) {
        checks.positive("distance", self.distance);
        checks.positive("time", self.time);
    }
}

impl Parameters for OutputParams {
    fn check(&self, checks: &mut Checks) {
        let fits = !self.formats.is_empty();
        checks.require(fits, "formats", "[]", "must name at least one of ply, obj, npz, pc2, usd, vtu, gltf");
    }
}
