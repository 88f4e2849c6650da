//! Checkpoints of a simulator, and how it goes on from one.

use super::Simulator;
use super::checkpoint::Checkpoint;
use super::sleep::SleepState;
use bowknot_errors::counted;

impl Simulator {
    /// The state, in full.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            step: self.step,
            positions: self.positions.clone(),
            velocities: self.velocities.clone(),
            anchors: self.anchors.clone(),
            present: self.present.clone(),
            contacts: self.carried(),
            sleep: self.sleep_state(),
            order: self.search_order.positions.clone(),
        }
    }

    /// Goes on from a state of the same scene.
    ///
    /// # Errors
    /// What does not fit, in words; the simulator is then as it was.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), String> {
        let vertices = self.positions.len();
        for (what, given) in
            [("positions", checkpoint.positions.len()), ("velocities", checkpoint.velocities.len())]
        {
            if given != vertices {
                let vertices = counted(vertices, "vertex", "vertices");
                return Err(format!("its {what} are {given}, but the scene has {vertices}"));
            }
        }
        let fits = checkpoint.anchors.len() == self.world.pins.len()
            && checkpoint
                .anchors
                .iter()
                .zip(&self.world.pins)
                .all(|(a, p)| a.is_empty() || a.len() == p.vertices.len());
        if !fits {
            return Err("its pins are not those of the scene".to_owned());
        }
        if checkpoint.present.len() != self.present.len() {
            return Err("its obstacles are not those of the scene".to_owned());
        }
        let (bodies, sleep) = (self.world.bodies.len(), &checkpoint.sleep);
        let is_island = |island: &u32| *island == SleepState::AWAKE || (*island as usize) < bodies;
        let fits = sleep.origins.is_empty()
            || (sleep.origins.len() == vertices
                && sleep.calm_steps.len() == bodies
                && sleep.islands.len() == bodies
                && sleep.islands.iter().all(is_island));
        if !fits {
            return Err("its bodies asleep are not those of the scene".to_owned());
        }
        if ![0, self.world.collision_vertices()].contains(&checkpoint.order.len()) {
            return Err("its order of a search is not one of the scene".to_owned());
        }
        let before = self.checkpoint();
        self.adopt(checkpoint);
        self.take_out(checkpoint.contacts.clone()).map_err(|error| {
            self.adopt(&before);
            // The state before was a sound one.
            let _ = self.take_out(before.contacts);
            error.to_string()
        })
    }

    fn adopt(&mut self, checkpoint: &Checkpoint) {
        self.step = checkpoint.step;
        self.positions.clone_from(&checkpoint.positions);
        self.velocities.clone_from(&checkpoint.velocities);
        self.anchors.clone_from(&checkpoint.anchors);
        self.present.clone_from(&checkpoint.present);
        self.search_order.adopt(&checkpoint.order);
        self.attachments.iter_mut().for_each(Vec::clear);
        self.adopt_sleep_state(&checkpoint.sleep);
    }
}
