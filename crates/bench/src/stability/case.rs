//! A case of the table: a scene, how it starts, and what is expected of it.

use super::scenes::Setting;
use bowknot::Scene;
use bowknot::geometry::Point;
use bowknot::simulator::Checkpoint;
use bowknot::{SceneError, Simulator};
use std::path::Path;

/// How a case starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// As the scene is.
    Scene,
    /// Vertices inside of solids are elsewhere, so that tetrahedra are inverted: each is mirrored at the
    /// center of the solid and moved out by this factor.
    InsideOut(f64),
    /// The solid is mirrored: all of its tetrahedra are inverted, its surface is sound.
    Mirrored,
}

/// A scene at the end of what users ask for.
#[derive(Clone, Debug)]
pub struct Case {
    /// What is varied.
    pub sweep: &'static str,
    /// Its value.
    pub value: String,
    /// The scene, as TOML.
    pub scene: String,
    /// Meshes of the scene: file name, OBJ.
    pub meshes: Vec<(String, String)>,
    pub time_steps: usize,
    pub start: Start,
    /// Time from which nothing drives the scene any more, so that its energy must not grow [s].
    pub driven_until: f64,
    /// Largest stretch limit of its bodies.
    pub stretch_limit: f64,
    /// Whether all prescribed places can be reached, so that collision problems can be expected to end by
    /// their stopping rule.
    pub can_converge: bool,
    /// Whether inverted tetrahedra can recover without their surface passing through itself.
    pub can_recover: bool,
    /// Why the case misses a goal, if it is known to; empty if it must miss none.
    pub known: &'static str,
}

impl Case {
    /// A case that starts as its scene is, is not driven, and must reach every goal.
    pub fn new(sweep: &'static str, value: impl Into<String>, scene: String, time_steps: usize) -> Self {
        Self {
            sweep,
            value: value.into(),
            scene,
            meshes: Vec::new(),
            time_steps,
            start: Start::Scene,
            driven_until: 0.0,
            stretch_limit: super::scenes::STRETCH_LIMIT,
            can_converge: true,
            can_recover: true,
            known: "",
        }
    }

    /// A case of a setting, with the reason why it misses a goal; empty if it must miss none.
    pub fn of(
        setting: &Setting,
        [sweep, known]: [&'static str; 2],
        value: impl Into<String>,
        scene: fn(&Setting, usize) -> String,
        time_steps: usize,
    ) -> Self {
        Self {
            stretch_limit: setting.stretch_limit,
            can_recover: setting.bears_its_weight(),
            known,
            ..Self::new(sweep, value, scene(setting, time_steps), time_steps)
        }
    }

    pub fn name(&self) -> String {
        format!("{} {}", self.sweep, self.value)
    }

    /// Its name, without characters that file names should not have.
    pub fn file_name(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || ".-".contains(c) { c } else { '_' };
        self.name().chars().map(plain).collect()
    }

    /// The scene, if its meshes are in `folder`.
    ///
    /// # Errors
    /// If the scene is refused.
    pub fn open(&self, folder: &Path) -> Result<Scene, SceneError> {
        Scene::from_toml(&self.scene, folder)
    }

    /// The state that the case starts from, if it is not that of the scene.
    pub fn start(&self, simulator: &Simulator) -> Option<Checkpoint> {
        let mut state = simulator.checkpoint();
        let collide = simulator.world().collision_vertices();
        let (solid, inside): (Vec<usize>, Vec<usize>) = {
            let deformable = 0..simulator.world().deformable_vertices;
            let inside: Vec<usize> = (collide..state.positions.len()).collect();
            (deformable.chain(inside.iter().copied()).collect(), inside)
        };
        let sum: bowknot::geometry::Vector = solid.iter().map(|&v| state.positions[v].coords).sum();
        let center = Point::from(sum / solid.len() as f64);
        match self.start {
            Start::Scene => return None,
            Start::InsideOut(factor) => {
                for v in inside {
                    state.positions[v] = center - (state.positions[v] - center) * factor;
                }
            }
            Start::Mirrored => {
                for v in solid {
                    state.positions[v].x = 2.0 * center.x - state.positions[v].x;
                }
            }
        }
        Some(state)
    }
}
