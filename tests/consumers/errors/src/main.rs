//! Parameters of somebody's own solver, checked all at once.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_errors::{Checks, Parameters};

struct Spring {
    stiffness: f64,
    damping: f64,
}

impl Parameters for Spring {
    fn check(&self, checks: &mut Checks) {
        checks.positive("stiffness", self.stiffness);
        checks.between("damping", self.damping, 0.0, 1.0);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    Spring { stiffness: 100.0, damping: 0.1 }.validate()?;
    let errors = Spring { stiffness: f64::NAN, damping: 2.0 }.validate().expect_err("both are wrong");
    println!("{errors}");
    assert_eq!(errors.iter().map(|error| error.path.as_str()).collect::<Vec<_>>(), ["stiffness", "damping"]);
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
