//! The normal force of a contact as a function of its gap.

/// Smallest share of the room at which the static force begins to go on linearly. Smaller: contacts can carry
/// more before the floor is reached, but the law is stiffer. Larger: loads of more than about k room /
/// share^2 press through the floor.
pub(super) const MIN_BEND: f64 = 0.02;

/// Smallest share of the room at which the stiffness for the drag is taken. Smaller: contacts that begin deep
/// open more slowly. Larger: they open faster, and closing ones are damped less.
const MIN_DRAG_SHARE: f64 = 0.05;

/// Bisections in the search for the release. More: the force jumps by less there; 40 leave 10^-12 of the
/// reach.
const BISECTIONS: usize = 40;

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
    /// s below which the static force goes on linearly.
    bend: f64,
}

/// A normal force, its decrease with the gap, and its energy.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    /// [N].
    pub force: f64,
    /// Minus the derivative of the force by the gap [N/m].
    pub stiffness: f64,
    /// Energy that has the force as its negative derivative [J].
    pub energy: f64,
}

/// The static force at a share s of the room, with k = r = 1: force, its decrease with s, energy.
fn shape(s: f64) -> [f64; 3] {
    if s >= 1.0 {
        return [0.0; 3];
    }
    [(1.0 - s) / (s * s), (2.0 - s) / (s * s * s), 1.0 / s - 1.0 + libm::log(s)]
}

impl NormalLaw {
    /// A law without drag that bends as late as possible. The reach must be above the floor. `start` is the
    /// gap at the start of the time step.
    pub fn new(stiffness: f64, reach: f64, floor: f64, start: f64) -> Self {
        let from = start.min(reach).max(floor + MIN_BEND * (reach - floor));
        let mut law = Self { stiffness, reach, floor, from, release: reach, bend: MIN_BEND, drag: 0.0 };
        law.find_release();
        law
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

    fn find_release(&mut self) {
        self.release = self.reach;
        if self.from < self.reach {
            let (mut low, mut high) = (self.from, self.reach);
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (low + high);
                if self.whole(middle).force > 0.0 { low = middle } else { high = middle }
            }
            self.release = high;
        }
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

    /// The static force.
    fn resting(&self, gap: f64) -> Push {
        let (room, s) = (self.reach - self.floor, self.share(gap));
        let at = s.max(self.bend);
        let [force, slope, energy] = shape(at);
        let below = at - s;
        Push {
            force: self.stiffness * room * (force + slope * below),
            stiffness: self.stiffness * slope,
            energy: self.stiffness * room * room * (energy + force * below + 0.5 * slope * below * below),
        }
    }

    /// Static force and drag, also where they would pull.
    fn whole(&self, gap: f64) -> Push {
        let mut push = self.resting(gap);
        let way = self.from - gap;
        push.force += self.drag * way;
        push.stiffness += self.drag;
        push.energy += 0.5 * self.drag * way * way;
        push
    }

    /// The force at a gap.
    pub fn at(&self, gap: f64) -> Push {
        if gap >= self.release {
            return Push::default();
        }
        let mut push = self.whole(gap);
        push.energy -= self.whole(self.release).energy;
        push
    }

    /// Stiffness of the static force at a gap, of which the share of the room counts as `least` at least
    /// [N/m].
    pub fn tangent(&self, gap: f64, least: f64) -> f64 {
        self.stiffness * shape(self.share(gap).clamp(least, 1.0 - 1e-9))[1]
    }

    /// The force of a contact that is open now and expected to close: the slope of the law at its reach, as a
    /// spring that pulls as well. Thus one linear solve finds the force with which it closes.
    pub fn predicted(&self, gap: f64) -> Push {
        let k = self.stiffness + self.drag;
        let depth = self.reach - gap;
        Push { force: k * depth, stiffness: k, energy: 0.5 * k * depth * depth }
    }
}

#[cfg(test)]
mod tests;
