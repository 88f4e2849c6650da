//! Which vertices are prescribed in a time step, where to, and which of them lag behind.

use crate::simulator::{Scratch, Simulator, time_of};
use bowknot_geometry::Point;
use bowknot_scene::world::ObstacleMotion;
use bowknot_twoway::ResolveInput;
use std::collections::BTreeMap;

/// Distances below this are rounding [m].
const NO_DISTANCE: f64 = 1e-9;

impl Simulator {
    /// Fills in which vertices are prescribed at `time`, the end of the time step, and their keyframes. The
    /// vertices of a pin form a group: they move by one fraction of their way.
    pub(crate) fn prescribe(&mut self, time: f64, scratch: &mut Scratch) {
        let ends = self.dynamics.params().integrator.stage_ends();
        let inner = if self.sleeping.is_some() { &ends[..ends.len() - 1] } else { &[] };
        scratch.inner.resize_with(inner.len(), Vec::new);
        for (stage, &share) in inner.iter().enumerate() {
            self.place_prescribed(time, share, scratch);
            scratch.inner[stage].clone_from(&scratch.keyframes);
        }
        self.place_prescribed(time, 1.0, scratch);
    }

    /// Places the keyframes of the vertices that are prescribed in a time step that ends at `time`, with those of
    /// bodies asleep, where they are at the end of a stage of it, after that share of the time step.
    pub(crate) fn lead_to(&mut self, time: f64, share: f64, scratch: &mut Scratch) {
        let prescribed = scratch.prescribed.clone();
        self.place_prescribed(time, share, scratch);
        scratch.prescribed = prescribed;
    }

    /// What has a motion over time is where it is then. What a program has placed for the end of the time step goes
    /// there at a constant speed.
    fn place_prescribed(&mut self, time: f64, share: f64, scratch: &mut Scratch) {
        let at = if share == 1.0 { time } else { time_of(self.step, self.dt) + share * self.dt };
        let Self { world, anchors, attachments, positions, dt, .. } = self;
        let Scratch { prescribed, keyframes, groups, .. } = scratch;
        let on_the_way = |end: Point, start: &Point| {
            if share == 1.0 { end } else { start + (end - start) * share }
        };
        let count = world.collision_vertices();
        prescribed.clear();
        prescribed.resize(positions.len(), false);
        groups.clear();
        groups.resize(count, ResolveInput::NO_GROUP);
        keyframes.clone_from(positions);
        for body in world.bodies.iter().filter(|body| body.kind.is_none()) {
            let range = body.vertices.start as usize..body.vertices.end as usize;
            prescribed[range.clone()].fill(true);
            body.motion.positions(&world.base[range.clone()], at, &mut keyframes[range.clone()]);
            if matches!(body.motion, ObstacleMotion::Placed(_)) {
                let ways = keyframes[range.clone()].iter_mut().zip(&positions[range]);
                ways.for_each(|(keyframe, start)| *keyframe = on_the_way(*keyframe, start));
            }
        }
        for (index, ((pin, anchor), attachments)) in
            world.pins.iter().zip(anchors).zip(attachments).enumerate()
        {
            if !pin.holds(time, *dt) {
                continue;
            }
            if anchor.is_empty() && pin.start > 0.0 {
                let place = pin.motion.as_ref().map(|motion| motion.at(pin.start));
                let undo = |v: &u32| {
                    let x = &positions[*v as usize];
                    place.map_or(*x, |place| place.undo(x))
                };
                *anchor = pin.vertices.iter().map(undo).collect();
            }
            if pin.follow.is_some() && attachments.is_empty() {
                let home = |v: &u32| world.positions[*v as usize];
                let homes: Vec<Point> = pin.vertices.iter().map(home).collect();
                *attachments = world.attach(pin, if anchor.is_empty() { &homes } else { anchor });
            }
            let place = pin.motion.as_ref().map(|motion| motion.at(at));
            for (k, &v) in pin.vertices.iter().enumerate() {
                let v = v as usize;
                let home = anchor.get(k).unwrap_or(&world.positions[v]);
                prescribed[v] = true;
                let followed = attachments.get(k).and_then(|a| a.as_ref()?.place(keyframes));
                let led =
                    || place.map_or_else(|| on_the_way(*home, &positions[v]), |place| place.apply(home));
                keyframes[v] = followed.unwrap_or_else(led);
                if v < count {
                    groups[v] = index as u32;
                }
            }
        }
    }

    /// The obstacles and pins that are behind their keyframes at the end of the time step, and how far [m].
    pub(crate) fn waiting(&self, time: f64, scratch: &Scratch) -> BTreeMap<String, f64> {
        let behind = |vertices: &mut dyn Iterator<Item = u32>| {
            vertices
                .map(|v| (scratch.keyframes[v as usize] - self.positions[v as usize]).norm())
                .fold(0.0, f64::max)
        };
        let obstacles = self.world.bodies.iter().filter(|body| body.kind.is_none() && !body.motion.is_rest());
        let obstacles = obstacles.map(|body| (&body.name, behind(&mut body.vertices.clone())));
        let pins = self.world.pins.iter().filter(|pin| pin.holds(time, self.dt));
        let pins = pins.map(|pin| (&pin.name, behind(&mut pin.vertices.iter().copied())));
        let rounding = NO_DISTANCE.max(self.backend.resolution());
        let waiting = obstacles.chain(pins).filter(|(_, behind)| *behind > rounding);
        waiting.map(|(name, behind)| (name.clone(), behind)).collect()
    }
}
