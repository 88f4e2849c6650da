//! Checkpoints of a simulator, and how it goes on from one.

use super::Simulator;
use super::checkpoint::Checkpoint;
use super::drive::Driven;
use super::restore_error::RestoreError;
use super::sleep::SleepState;
use bowknot_scene::Scene;

impl Simulator {
    /// The state, in full, with all that a program has changed.
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
            driven: self.driven.clone(),
        }
    }

    /// Goes on from a state of the same scene, with what a program had changed then and without what it has
    /// changed since.
    ///
    /// Steps from the same state have the same bits. Who measures a stiffness by differences of restored runs
    /// switches sleep off (`solver.sleep.enabled = false`): how long bodies have been at rest is part of the
    /// state, and bodies asleep do not yield.
    ///
    /// **The state must be free of intersections**, as that of every checkpoint is. One that is not stays so,
    /// or worse: [`Self::restore_checked`] looks.
    ///
    /// # Errors
    /// What does not fit; the simulator is then as it was.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
        self.restore_if(checkpoint, |_| Ok(()))
    }

    /// As [`Self::restore`], for states from elsewhere: the exact judge looks at it, at the cost of about a
    /// two-way step.
    ///
    /// # Errors
    /// What does not fit; [`RestoreError::Intersects`] with the pairs. The simulator is then as it was.
    pub fn restore_checked(&mut self, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
        self.restore_if(checkpoint, |simulator| {
            match simulator.intersections().map_err(RestoreError::refused)? {
                Some((lines, count)) => Err(RestoreError::Intersects { lines, count }),
                None => Ok(()),
            }
        })
    }

    /// Restores a state that is `accepted` once it is in place.
    fn restore_if(
        &mut self,
        checkpoint: &Checkpoint,
        accepted: impl Fn(&Self) -> Result<(), RestoreError>,
    ) -> Result<(), RestoreError> {
        // Checkpoints do not hold the folder of mesh files.
        let in_folder =
            |scene: Box<Scene>| Box::new(Scene { folder: self.home.scene.folder.clone(), ..*scene });
        let scene = checkpoint.driven.scene.clone().map(in_folder);
        if scene != self.driven.scene {
            let mut other = self.rebuilt(scene).map_err(RestoreError::refused)?;
            other.restore_here(checkpoint, accepted)?;
            return self.give_way_to(other).map_err(RestoreError::refused);
        }
        self.restore_here(checkpoint, accepted)
    }

    /// Restores a state with the bodies that there are.
    fn restore_here(
        &mut self,
        checkpoint: &Checkpoint,
        accepted: impl Fn(&Self) -> Result<(), RestoreError>,
    ) -> Result<(), RestoreError> {
        self.check_fits(checkpoint)?;
        let before = self.checkpoint();
        let restored = self.adopt(checkpoint).and_then(|()| accepted(self));
        if restored.is_err() {
            // The state before was a sound one.
            let _ = self.adopt(&before);
        }
        restored
    }

    /// Whether the parts of a state are of the size that the bodies have, and name what there is.
    fn check_fits(&self, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
        let expected = self.positions.len();
        for (what, given) in
            [("positions", checkpoint.positions.len()), ("velocities", checkpoint.velocities.len())]
        {
            if given != expected {
                return Err(RestoreError::Length { what, given, expected });
            }
        }
        self.check_elements(&checkpoint.driven)?;
        self.check_driven(&checkpoint.driven)?;
        let pins = checkpoint.driven.pins.as_ref().unwrap_or(&self.undriven.pins);
        let is_of = |(anchors, pin): (&Vec<_>, &bowknot_scene::world::Pin)| {
            anchors.is_empty() || anchors.len() == pin.vertices.len()
        };
        if checkpoint.anchors.len() != pins.len() || !checkpoint.anchors.iter().zip(pins).all(is_of) {
            return Err(RestoreError::Pins);
        }
        if checkpoint.present.len() != self.present.len() {
            return Err(RestoreError::Obstacles);
        }
        let (bodies, sleep) = (self.world.bodies.len(), &checkpoint.sleep);
        let is_island = |island: &u32| *island == SleepState::AWAKE || (*island as usize) < bodies;
        let joined = self.sleeping.as_ref().map_or(&[][..], |sleeping| sleeping.joined());
        let is_one = |pair: &[u32; 2]| sleep.islands[pair[0] as usize] == sleep.islands[pair[1] as usize];
        let fits = sleep.origins.is_empty()
            || (sleep.origins.len() == expected
                && sleep.calm_steps.len() == bodies
                && sleep.islands.len() == bodies
                && sleep.islands.iter().all(is_island)
                && joined.iter().all(is_one));
        if !fits {
            return Err(RestoreError::Sleep);
        }
        if ![0, self.world.collision_vertices()].contains(&checkpoint.order.len()) {
            return Err(RestoreError::Order);
        }
        Ok(())
    }

    /// Whether the custom elements are those of a state.
    fn check_elements(&self, driven: &Driven) -> Result<(), RestoreError> {
        let refuse = |group: &String, problem| Err(RestoreError::Elements { group: group.clone(), problem });
        let (own, of_state) = (&self.driven.elements, &driven.elements);
        if let Some(group) = of_state.keys().find(|group| !own.contains_key(*group)) {
            return refuse(
                group,
                "are not there, and a checkpoint holds no code: add them before it is restored",
            );
        }
        if let Some(group) = own.keys().find(|group| !of_state.contains_key(*group)) {
            return refuse(group, "were not there: remove them before it is restored");
        }
        match own.iter().find(|(group, vertices)| of_state.get(*group) != Some(vertices)) {
            Some((group, _)) => refuse(group, "have other vertices"),
            None => Ok(()),
        }
    }

    /// Takes a state over that fits.
    fn adopt(&mut self, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
        self.step = checkpoint.step;
        self.positions.clone_from(&checkpoint.positions);
        self.velocities.clone_from(&checkpoint.velocities);
        self.anchors.clone_from(&checkpoint.anchors);
        self.present.clone_from(&checkpoint.present);
        self.search_order.adopt(&checkpoint.order);
        self.adopt_driven(&checkpoint.driven);
        self.adopt_sleep_state(&checkpoint.sleep);
        self.take_out(checkpoint.contacts.clone()).map_err(RestoreError::refused)?;
        // After that, as it may set up the dynamics of the bodies that are awake.
        self.apply_surroundings().map_err(|error| RestoreError::Refused { source: error.into() })
    }
}
