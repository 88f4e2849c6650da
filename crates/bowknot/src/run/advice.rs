//! What a summary says in words about time steps that did not go well, and what helps.

use super::summary::{HeldApartStep, Summary};
use bowknot_errors::counted;
use bowknot_scene::SimulationParams;

/// What a run says of its time steps that ended unsolved.
#[derive(Clone, Debug, PartialEq)]
pub struct UnsolvedAdvice {
    /// How many they are, where the first of them is out of balance, and the largest residual.
    pub text: String,
    /// What lowers residuals; none if there is no tolerance that they exceed.
    pub remedy: Option<Remedy>,
}

/// What lowers the residuals of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remedy {
    /// A quarter of the time step [s], with four times the frames.
    pub dt: f64,
    /// More Newton iterations, if a time step made all that it may.
    pub newton_iterations: Option<usize>,
}

impl Summary {
    /// What to say of time steps that ended unsolved; none if there are none.
    pub fn unsolved_advice(&self, simulation: &SimulationParams) -> Option<UnsolvedAdvice> {
        let first = self.first_unsolved.as_ref()?;
        let steps = counted(self.frames, "time step", "time steps");
        let at = first.at.as_ref().map_or_else(String::new, |at| format!(", at {} m", at.short()));
        let mut text = format!(
            "{} of {steps} ended unsolved: the first is time step {}{at}",
            self.unsolved_steps, first.step
        );
        let largest = self.max.as_ref().and_then(|max| max.residual_m).unwrap_or(first.residual_m);
        if largest <= first.tolerance_m || first.tolerance_m == 0.0 {
            return Some(UnsolvedAdvice { text, remedy: None });
        }
        text += &format!("; the largest residual is {}", residual_text(largest, first.tolerance_m));
        let made = self.max.as_ref().and_then(|max| max.newton_iterations).unwrap_or(0.0);
        Some(UnsolvedAdvice { text, remedy: Some(Remedy::of(simulation, made)) })
    }

    /// What to say of pins that held edges over their stretch limits; none if none did.
    pub fn held_apart_advice(&self) -> Option<String> {
        let HeldApartStep { step, at } = self.most_held_apart.as_ref()?;
        let steps = counted(self.frames, "time step", "time steps");
        Some(format!(
            "in {} of {steps} pins stretch edges beyond their limits, most in time step {step}: {at}; what \
             helps: a larger stretch_limit of {}, or pins nearer together",
            self.held_apart_steps, at.body
        ))
    }
}

impl Remedy {
    /// For a run whose time steps made at most so many Newton iterations.
    fn of(simulation: &SimulationParams, made: f64) -> Self {
        // Digits of a quarter that rounding has added are left out.
        let dt = format!("{:.6e}", simulation.dt / 4.0).parse().unwrap_or(simulation.dt / 4.0);
        let (limit, most) = (simulation.newton_iterations, SimulationParams::MAX_NEWTON_ITERATIONS);
        let newton_iterations = (made >= limit as f64 && limit < most).then(|| (3 * limit).clamp(30, most));
        Self { dt, newton_iterations }
    }

    /// In words, with the names that a time step, its frames and Newton iterations have for the reader:
    /// `name(key, value)` for `dt`, `frames` (without a value) and `newton_iterations`.
    pub fn in_words(&self, name: impl Fn(&str, &str) -> String) -> String {
        let mut text = format!(
            "a quarter of the time step ({} with four times the {})",
            name("dt", &format!("{:?}", self.dt)),
            name("frames", "")
        );
        if let Some(more) = self.newton_iterations {
            text += &format!(
                ", more Newton iterations ({}), or both",
                name("newton_iterations", &more.to_string())
            );
        }
        text
    }
}

/// A residual [m] in words, with its ratio to the tolerance [m], if there is one.
pub fn residual_text(residual: f64, tolerance: f64) -> String {
    let mut text = format!("{} mm", two_digits(1e3 * residual));
    if tolerance > 0.0 {
        text += &format!(", {} times the tolerance", two_digits(residual / tolerance));
    }
    text
}

/// A number with two digits, or as an integer.
fn two_digits(value: f64) -> String {
    if value >= 10.0 {
        return format!("{value:.0}");
    }
    let (mut digits, mut shifted) = (1, value);
    while shifted < 1.0 && digits < 9 {
        (digits, shifted) = (digits + 1, 10.0 * shifted);
    }
    if value > 0.0 && value < 1e-4 { format!("{value:.1e}") } else { format!("{value:.digits$}") }
}
