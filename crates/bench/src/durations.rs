//! How long figures take, for the list of them.
//!
//! Quick runs: processor time with one thread and an empty folder, recording of the problems included (Intel
//! Xeon, 2 cores, 23 November 2026, while other programs shared the machine: an estimate, no measurement to
//! compare with). Runs that the limit of one minute ended are given as a minute. Full runs have the limit
//! that [`crate::bench`] sets; that of `record` is a guess.

/// Seconds of a quick run.
const QUICK: &[(&str, u32)] = &[
    ("overview", 60),
    ("collision-error", 60),
    ("collision-error-unaware", 60),
    ("contacts-alone", 50),
    ("tolerance", 45),
    ("simulation-error", 4),
    ("integrators", 18),
    ("convergence", 13),
    ("table-1", 40),
    ("table-2", 160),
    ("table-2-full", 20),
    ("defaults", 60),
    ("switches", 60),
    ("barrier", 26),
    ("edge-limits", 4),
    ("sweeps", 11),
    ("row-solvers", 10),
    ("step-sizes", 20),
    ("impact-zones", 6),
    ("parameters", 6),
    ("lengths", 15),
    ("steps", 30),
    ("breakdown", 28),
    ("newton", 14),
    ("joint", 10),
    ("funnel", 11),
    ("early-contact", 3),
    ("goals", 13),
    ("gpu", 60),
    ("stability", 60),
    ("gallery", 30),
    ("record", 150),
];

/// How long a quick run of a figure takes, in words.
pub fn quick(name: &str) -> String {
    let seconds = QUICK.iter().find(|(figure, _)| *figure == name).map(|(_, seconds)| *seconds);
    match seconds {
        None => "?".to_owned(),
        Some(seconds) if seconds < 100 => format!("{seconds} s"),
        Some(seconds) => format!("{} min", seconds.div_ceil(60)),
    }
}

/// How long a full run of a figure takes at most, in words.
pub fn full(name: &str) -> &'static str {
    // Its sets take seconds to a few minutes each.
    if name == "record" { "1 h" } else { "20 min" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::ALL;

    #[test]
    fn each_figure_has_a_duration() {
        for name in ALL.iter().map(|figure| figure.name()).chain(["record"]) {
            assert_ne!(quick(name), "?", "{name}");
        }
        assert_eq!(QUICK.len(), ALL.len() + 1, "a duration of no figure");
    }
}
