//! The normal force of a contact as a function of its gap.

/// Smallest share of the room at which the static force begins to go on linearly. Smaller: contacts can carry
/// more before the floor is reached, but the law is stiffer. Larger: loads of more than about k room /
/// share^2 press through the floor.
pub(super) const MIN_BEND: f64 = 0.02;

/// Smallest share of the room at which the stiffness for the drag is taken. Smaller: contacts that begin deep
/// open more slowly. Larger: they open faster, and closing ones are damped less.
const MIN_DRAG_SHARE: f64 = 0.05;

/// Step of Newton's method at which the search for the release ends, as a share of the room. Larger: the force
/// jumps by more there.
const RELEASE_TOLERANCE: f64 = 1e-12;

/// Steps of that search at most. From the smallest share of the room it takes about 15.
const MAX_RELEASE_STEPS: usize = 40;

/// The normal force of a contact as a function of its gap g.
///
/// With the room r = reach - floor and s = (g - floor) / r, the static force is k r (1 - s) / s^2. It is zero
/// at the reach, has the slope -k there, and is infinite at the floor. Below s = `bend` it goes on linearly,
/// so that Newton's method can begin anywhere. A drag toward the gap at the start of the time step, drag
/// (from - g), is added. It damps closing and opening. The sum never pulls: from the gap `release` on, where
/// it would begin to, the force is zero.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NormalLaw {
    /// Stiffness k at the reach [N/m].
    pub stiffness: f64,
    /// Gap from which on the static force is zero [m].
    pub reach: f64,
    /// Gap at which the static force becomes infinite [m].
    floor: f64,
    /// Coefficient of the drag over the time step [N/m].
    drag: f64,
    /// The gap that the drag pulls to: that at the start of the time step, at most the reach [m].
    from: f64,
    /// Gap from which on nothing acts [m].
    release: f64,
    /// Energy of force and drag there [J].
    energy_at_release: f64,
    /// s below which the static force goes on linearly.
    bend: f64,
}

/// A normal force and its decrease with the gap.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    /// [N].
    pub force: f64,
    /// Minus the derivative of the force by the gap [N/m].
    pub stiffness: f64,
}

/// The static force at a share s of the room, with k = r = 1, and its decrease with s.
#[inline]
fn shape(s: f64) -> [f64; 2] {
    if s > 1.0 { [0.0; 2] } else { [(1.0 - s) / (s * s), (2.0 - s) / (s * s * s)] }
}

/// Its energy.
fn shape_energy(s: f64) -> f64 {
    if s >= 1.0 { 0.0 } else { 1.0 / s - 1.0 + libm::log(s) }
}

impl NormalLaw {
    /// A law without drag that bends as late as possible. The reach must be above the floor. `start` is the
    /// gap at the start of the time step.
    pub fn new(stiffness: f64, reach: f64, floor: f64, start: f64) -> Self {
        let from = start.min(reach).max(floor + MIN_BEND * (reach - floor));
        let (drag, energy_at_release) = (0.0, 0.0);
        Self { stiffness, reach, floor, from, release: reach, energy_at_release, bend: MIN_BEND, drag }
    }

    /// A law that is linear from the reach on, so that its energy is quadratic: k (reach - g).
    pub fn quadratic(stiffness: f64, reach: f64, floor: f64) -> Self {
        Self { bend: 1.0, ..Self::new(stiffness, reach, floor, reach) }
    }

    /// Sets the drag to `ratio` times the static stiffness at the start of the time step, and less the nearer
    /// the `gap` is to the reach, where it is 0.
    pub fn set_drag(&mut self, ratio: f64, gap: f64) {
        let depth = 1.0 - self.share(gap).clamp(MIN_DRAG_SHARE, 1.0);
        self.drag = ratio * depth * self.tangent(self.from, MIN_DRAG_SHARE);
        self.find_release();
    }

    /// Lets the static force go on linearly below a share of the room.
    pub fn bend_at(&mut self, share: f64) {
        // The release is above `from`. If the law does not change there, neither does the release.
        let moves = self.bend.max(share) > self.share(self.from);
        self.bend = share;
        if moves {
            self.find_release();
        }
    }

    /// The force falls with the gap, and ever slower, so Newton's method goes up from the gap at the start to
    /// the release and never beyond.
    fn find_release(&mut self) {
        self.release = self.reach;
        if self.drag > 0.0 && self.from < self.reach {
            let mut gap = self.from;
            for _ in 0..MAX_RELEASE_STEPS {
                let Push { force, stiffness } = self.whole(gap);
                let step = force / stiffness;
                gap = (gap + step.max(0.0)).min(self.reach);
                if step <= RELEASE_TOLERANCE * (self.reach - self.floor) {
                    break;
                }
            }
            self.release = gap;
        }
        self.energy_at_release = self.whole_energy(self.release);
    }

    /// s at a gap: 0 at the floor, 1 at the reach.
    pub fn share(&self, gap: f64) -> f64 {
        (gap - self.floor) / (self.reach - self.floor)
    }

    /// s below which the static force goes on linearly.
    pub fn bend(&self) -> f64 {
        self.bend
    }

    /// The force at the start of the time step [N].
    pub fn force_at_start(&self) -> f64 {
        self.at(self.from).force
    }

    /// Static force and drag, also where they would pull.
    #[inline]
    fn whole(&self, gap: f64) -> Push {
        let (room, s) = (self.reach - self.floor, self.share(gap));
        let at = s.max(self.bend);
        let [force, slope] = shape(at);
        Push {
            force: self.stiffness * room * (force + slope * (at - s)) + self.drag * (self.from - gap),
            stiffness: self.stiffness * slope + self.drag,
        }
    }

    /// Energy of static force and drag [J].
    fn whole_energy(&self, gap: f64) -> f64 {
        let (room, s) = (self.reach - self.floor, self.share(gap));
        let at = s.max(self.bend);
        let ([force, slope], below, way) = (shape(at), at - s, self.from - gap);
        let energy = shape_energy(at) + force * below + 0.5 * slope * below * below;
        self.stiffness * room * room * energy + 0.5 * self.drag * way * way
    }

    /// The force at a gap.
    #[inline]
    pub fn at(&self, gap: f64) -> Push {
        if gap >= self.release { Push::default() } else { self.whole(gap) }
    }

    /// Energy that has the force as its negative derivative [J]; 0 where nothing acts.
    pub fn energy(&self, gap: f64) -> f64 {
        if gap >= self.release { 0.0 } else { self.whole_energy(gap) - self.energy_at_release }
    }

    /// Stiffness of the static force at a gap, of which the share of the room counts as `least` at least
    /// [N/m].
    pub fn tangent(&self, gap: f64, least: f64) -> f64 {
        self.stiffness * shape(self.share(gap).clamp(least, 1.0 - 1e-9))[1]
    }

    /// The force of a contact that is open now and expected to close: the slope of the law at its reach, as a
    /// spring that pulls as well. Thus one linear solve finds the force with which it closes.
    pub fn predicted(&self, gap: f64) -> Push {
        let stiffness = self.stiffness + self.drag;
        Push { force: stiffness * (self.reach - gap), stiffness }
    }

    /// The energy of that spring [J].
    pub fn predicted_energy(&self, gap: f64) -> f64 {
        0.5 * (self.stiffness + self.drag) * (self.reach - gap) * (self.reach - gap)
    }
}

#[cfg(test)]
mod tests;
