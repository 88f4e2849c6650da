//! When obstacles are there.

use std::ops::Range;

/// Share of a time step by which times may be off: they are multiples of it, rounded.
const ROUNDING: f64 = 1e-9;

/// When an obstacle is there: from the start of each of its spans to before the end [s].
#[derive(Clone, Debug, PartialEq)]
pub struct Presence {
    /// Ascending, apart from each other.
    spans: Vec<Range<f64>>,
}

impl Default for Presence {
    /// Always.
    fn default() -> Self {
        Self { spans: vec![f64::NEG_INFINITY..f64::INFINITY] }
    }
}

impl Presence {
    /// What is there in frames at `times` [s], ascending, of which `shown` says which are not empty. A frame
    /// counts until the next; the first one also before, the last one also after.
    pub(super) fn of_frames(shown: &[bool], time: impl Fn(usize) -> f64) -> Self {
        let mut spans: Vec<Range<f64>> = Vec::new();
        for (frame, _) in shown.iter().enumerate().filter(|(_, shown)| **shown) {
            let start = if frame == 0 { f64::NEG_INFINITY } else { time(frame) };
            let end = if frame + 1 == shown.len() { f64::INFINITY } else { time(frame + 1) };
            match spans.last_mut() {
                Some(last) if frame > 0 && shown[frame - 1] => last.end = end,
                _ => spans.push(start..end),
            }
        }
        Self { spans }
    }

    /// What of it is between two times [s].
    #[must_use]
    pub(super) fn between(self, start: f64, end: f64) -> Self {
        let cut = |span: Range<f64>| span.start.max(start)..span.end.min(end);
        Self { spans: self.spans.into_iter().map(cut).filter(|span| span.start < span.end).collect() }
    }

    /// Whether the obstacle is there at `time`, a multiple of the time step `dt` [s], and so during the time
    /// step that begins then.
    pub fn holds(&self, time: f64, dt: f64) -> bool {
        let rounding = ROUNDING * dt;
        self.spans.iter().any(|span| span.start <= time + rounding && time + rounding < span.end)
    }

    /// Whether it is there at the beginning of any of so many time steps of `dt` [s].
    pub(super) fn is_ever(&self, dt: f64, steps: usize) -> bool {
        (0..steps).any(|step| self.holds(step as f64 * dt, dt))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 0.1;

    /// The time steps of 0.1 s, of the first ten, at whose beginning it is there.
    fn steps(presence: &Presence) -> Vec<usize> {
        (0..10).filter(|&step| presence.holds(step as f64 * DT, DT)).collect()
    }

    #[test]
    fn an_obstacle_is_there_from_its_start_to_before_its_end() {
        let all: Vec<usize> = (0..10).collect();
        assert_eq!(steps(&Presence::default()), all);
        assert_eq!(steps(&Presence::default().between(0.0, f64::INFINITY)), all);
        // 0.3 and 0.7 are no multiples of 0.1 in binary.
        assert_eq!(steps(&Presence::default().between(0.3, 0.7)), [3, 4, 5, 6]);
        // Times between time steps count from the next one on.
        assert_eq!(steps(&Presence::default().between(0.25, 0.61)), [3, 4, 5, 6]);
        let between_steps = Presence::default().between(0.31, 0.39);
        assert!(!between_steps.is_ever(DT, 10) && Presence::default().is_ever(DT, 1));
    }

    #[test]
    fn empty_frames_are_gaps() {
        let of = |shown: &[u8]| {
            let shown: Vec<bool> = shown.iter().map(|&s| s == 1).collect();
            steps(&Presence::of_frames(&shown, |frame| 0.1 + 0.2 * frame as f64))
        };
        assert_eq!(of(&[0, 1, 1, 0, 1, 0]), [3, 4, 5, 6, 9]);
        assert_eq!(of(&[1, 0, 1]), [0, 1, 2, 5, 6, 7, 8, 9]);
        assert_eq!(of(&[1]), (0..10).collect::<Vec<_>>());
        assert_eq!(of(&[0, 0]), [0; 0]);
        let cut =
            Presence::of_frames(&[true, false, true], |frame| 0.1 + 0.2 * frame as f64).between(0.2, 0.7);
        assert_eq!(steps(&cut), [2, 5, 6]);
    }
}
