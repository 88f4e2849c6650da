//! Prints speeds of bodies on slopes with grounds of all tessellations, and those by Coulomb's law: `cargo
//! run --release -p bowknot-tests --example slopes [-- BODY [GROUND [SETTING ...]]]`.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use bowknot_tests::contact::{Ground, Slider, Slope};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let named = |index: usize, name: String| arguments.get(index).is_none_or(|a| a == "all" || *a == name);
    let settings = arguments.get(2..).unwrap_or_default().to_vec();
    println!(
        "mean speed over the time steps 23 to 25 [m/s] at mu = 0, 0.1, 0.3, 0.5; way from 0.3 to 1.3 s at mu \
         = 0.5 [mm]"
    );
    for slider in Slider::ALL.into_iter().filter(|s| named(0, format!("{s:?}"))) {
        for ground in Ground::ALL.into_iter().filter(|g| named(1, format!("{g:?}"))) {
            let mut line = format!("{:>10} {:>10}", format!("{slider:?}"), format!("{ground:?}"));
            let (mut seconds, mut steps) = (0.0, 0);
            for friction in [0.0, 0.1, 0.3, 0.5] {
                let mut slope = Slope::new(slider, ground, friction);
                slope.settings.clone_from(&settings);
                let sticks = slope.acceleration() == 0.0;
                let track = slope.run(if sticks { 130 } else { 25 });
                seconds += track.cpu_seconds;
                steps += track.two_way_steps;
                line += &format!(" {:8.4} ({:.4})", track.speed(23..26), slope.acceleration() * 0.24);
                if sticks {
                    line += &format!(" {:7.3}", 1e3 * (track.places[130] - track.places[30]).norm());
                }
            }
            println!("{line}  {seconds:.2} CPU s, {steps} two-way steps");
        }
    }
}
