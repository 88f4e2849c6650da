//! Puts bodies to sleep after a time step, and wakes them before one.

use super::approach::Motion;
use super::islands::{SleepState, part};
use super::{Awake, SleepingBodies};
use crate::simulator::contact_forces::CarriedContacts;
use crate::simulator::error::SimulationError;
use crate::simulator::{Scratch, Simulator, time_of};
use bowknot_dynamics::{Dynamics, Energies};
use bowknot_geometry::{Point, Vector};

impl Simulator {
    /// Which bodies of the world sleep during the next time step, see [`bowknot_scene::SleepParams`]. Empty
    /// if bodies never sleep.
    pub fn asleep(&self) -> &[bool] {
        self.sleeping.as_ref().map_or(&[], |sleeping| &sleeping.asleep)
    }

    /// Wakes bodies before a time step that ends at `time`: those that something comes near, those whose
    /// pins take hold, let go or move, and those on which forces have changed. The other bodies asleep become
    /// prescribed.
    pub(crate) fn wake_for_step(&mut self, time: f64, scratch: &mut Scratch) -> Result<(), SimulationError> {
        let mut wakes = std::mem::take(&mut self.driven.pushed);
        let Some(sleeping) = &mut self.sleeping else { return Ok(()) };
        let Scratch { prescribed, start, inner, keyframes, .. } = &*scratch;
        let led: Vec<&[Point]> = inner.iter().chain([keyframes]).map(Vec::as_slice).collect();
        sleeping.record_hold(&self.world, prescribed, start, &led);
        if wakes.contains(&true) {
            sleeping.sleep.stir();
        }
        if sleeping.awake.is_none() {
            return Ok(());
        }
        wakes.resize(self.world.bodies.len(), false);
        let before = time_of(self.step, self.dt);
        wakes.iter_mut().zip(&sleeping.hold.moved).for_each(|(wakes, moved)| *wakes |= *moved);
        for pin in &self.world.pins {
            if pin.holds(time, self.dt) != pin.holds(before, self.dt) {
                for (body, wakes) in self.world.bodies.iter().zip(&mut wakes) {
                    let has = |v: &u32| body.vertices.contains(v) || body.interior.contains(v);
                    *wakes |= pin.vertices.iter().any(has);
                }
            }
        }
        self.predict(scratch);
        let Some(sleeping) = &mut self.sleeping else { return Ok(()) };
        let count = self.world.collision_vertices();
        let at_rest: Vec<bool> = sleeping.sleep.state.calm_steps.iter().map(|steps| *steps > 0).collect();
        let motion = Motion {
            start: &scratch.start[..count],
            inner: &scratch.inner,
            end: &sleeping.predicted[..count],
            margins: &sleeping.margins,
            asleep: &sleeping.asleep,
            at_rest: &at_rest,
            changed: &[],
        };
        let approached = sleeping.elements.approached(&self.world, &motion);
        wakes.iter_mut().zip(approached).for_each(|(wakes, near)| *wakes |= near);
        if sleeping.sleep.wake(&wakes) {
            let carried = self.carried();
            self.take_out(carried)?;
        }
        let Some(sleeping) = &self.sleeping else { return Ok(()) };
        for (body, _) in self.world.bodies.iter().zip(&sleeping.asleep).filter(|(_, asleep)| **asleep) {
            for range in [&body.vertices, &body.interior] {
                scratch.prescribed[range.start as usize..range.end as usize].fill(true);
            }
        }
        Ok(())
    }

    /// Predicts where vertices are at the end of the time step: at their keyframes, or where their velocities
    /// and gravity take them.
    fn predict(&mut self, scratch: &Scratch) {
        let Some(sleeping) = &mut self.sleeping else { return };
        let Scratch { prescribed, keyframes, start, .. } = scratch;
        let (model, gravity) = (self.dynamics.model(), self.dynamics.params().environment.gravity);
        sleeping.predicted.clone_from(start);
        for (body, _) in self.world.bodies.iter().zip(&sleeping.asleep).filter(|(_, asleep)| !**asleep) {
            let gravity = model.gravity(body.vertices.start as usize, gravity);
            for v in body.vertices.start as usize..body.vertices.end as usize {
                let way = (self.velocities[v] + gravity * self.dt) * self.dt;
                sleeping.predicted[v] = if prescribed[v] { keyframes[v] } else { start[v] + way };
            }
        }
    }

    /// Whether a time step has nothing to do: all deformable bodies sleep, and nothing prescribed moves.
    pub(crate) fn has_nothing_to_do(&self) -> bool {
        let all_rest = |sleeping: &SleepingBodies| {
            sleeping.is_all_asleep(&self.world) && !sleeping.hold.moved.contains(&true)
        };
        self.sleeping.as_ref().is_some_and(all_rest)
    }

    /// Puts bodies to sleep after a time step, and wakes those that were touched in it.
    pub(crate) fn fall_asleep(&mut self) -> Result<(), SimulationError> {
        let Self { world, sleeping, contacts, positions, .. } = self;
        let Some(sleeping) = sleeping else { return Ok(()) };
        if sleeping.sleep.update(world, positions, contacts.touching(), &sleeping.hold) {
            let carried = self.carried();
            self.take_out(carried)?;
        }
        Ok(())
    }

    /// What contacts remember, with the forces between bodies asleep.
    pub(crate) fn carried(&self) -> CarriedContacts {
        let mut carried = self.contacts.carried().clone();
        let put_aside = self.sleeping.as_ref().and_then(|sleeping| sleeping.awake.as_ref());
        carried.forces.extend(put_aside.iter().flat_map(|awake| &awake.forces));
        carried
    }

    /// Makes the collision stage and the dynamics work on the bodies that are awake alone, and finds their
    /// contacts; `carried` is what all contacts remember.
    pub(crate) fn take_out(&mut self, carried: CarriedContacts) -> Result<(), SimulationError> {
        self.apply_filters()?;
        let Self {
            world, resolver, contacts, step, dynamics, positions, velocities, sleeping, driven, ..
        } = self;
        let Some(sleeping) = sleeping else { return self.find_contacts(carried) };
        let asleep = sleeping.sleep.asleep();
        if asleep != sleeping.asleep {
            contacts.leave_out(world, resolver, &asleep);
            // The dynamics of the bodies that are awake are computed where they were before.
            let mut before = sleeping.awake.take();
            let active = before.as_mut().map_or(&mut *dynamics, |awake| &mut awake.dynamics);
            let backend = active.take_backend();
            let set = |dynamics: &mut Dynamics, backend| {
                dynamics.set_backend(backend).map_err(|source| SimulationError::target(*step, source))
            };
            set(dynamics, backend)?;
            if asleep.contains(&true) {
                let mut awake = Awake::new(world, &asleep, dynamics, positions)?;
                if !driven.external_forces.is_empty() {
                    let forced = awake.dynamics.set_external_forces(&driven.external_forces);
                    forced.map_err(|source| SimulationError::Target { step: *step, source })?;
                }
                set(&mut awake.dynamics, dynamics.take_backend())?;
                sleeping.awake = Some(awake);
            }
            sleeping.asleep = asleep;
        }
        let parted = part(world, &sleeping.asleep, &carried.forces);
        if let Some(awake) = &mut sleeping.awake {
            awake.forces = parted.asleep;
        }
        // A body that is to wake may have been given velocities.
        let pushed = |body: usize| driven.pushed.get(body) == Some(&true);
        let rests = |(body, asleep): (usize, &bool)| *asleep && !pushed(body);
        let rest = sleeping.asleep.iter().enumerate().map(rests);
        for (body, _) in world.bodies.iter().zip(rest).filter(|(_, rests)| *rests) {
            for range in [&body.vertices, &body.interior] {
                velocities[range.start as usize..range.end as usize].fill(Vector::zeros());
            }
        }
        self.find_contacts(CarriedContacts { forces: parted.awake, ..carried })
    }

    /// The state of sleep, for a checkpoint.
    pub(crate) fn sleep_state(&self) -> SleepState {
        self.sleeping.as_ref().map_or_else(SleepState::default, |sleeping| sleeping.sleep.state.clone())
    }

    /// Takes over the state of sleep of a checkpoint. Without one all bodies are awake.
    pub(crate) fn adopt_sleep_state(&mut self, state: &SleepState) {
        let Some(sleeping) = &mut self.sleeping else { return };
        if state.origins.is_empty() {
            let bodies = self.world.bodies.len();
            sleeping.sleep.state.origins.clone_from(&self.positions);
            sleeping.sleep.state.calm_steps = vec![0; bodies];
            sleeping.sleep.state.islands = vec![SleepState::AWAKE; bodies];
        } else {
            sleeping.sleep.state.clone_from(state);
        }
    }

    /// Number of vertices asleep.
    pub(crate) fn asleep_vertices(&self) -> usize {
        self.sleeping.as_ref().and_then(|sleeping| sleeping.awake.as_ref()).map_or(0, |awake| awake.vertices)
    }

    /// Energies, and the largest stretch of an edge, of all bodies.
    pub(crate) fn measures(&self) -> (Energies, f64) {
        let Self { dynamics, positions, velocities, .. } = self;
        let Some(awake) = self.sleeping.as_ref().and_then(|sleeping| sleeping.awake.as_ref()) else {
            return (dynamics.energies(positions, velocities), dynamics.max_stretch(positions));
        };
        let own = awake.dynamics.energies(positions, velocities);
        let energies = Energies {
            kinetic: own.kinetic,
            elastic: own.elastic + awake.energies.elastic,
            potential: own.potential + awake.energies.potential,
        };
        (energies, awake.dynamics.max_stretch(positions).max(awake.stretch))
    }
}
