//! Prints measurements of scenes whose outcome is known from theory: `cargo run --release -p
//! bowknot-tests --example theory [-- SCENE [SETTING ...]]`.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use bowknot_tests::contact::{Ground, Slider, Slope};
use bowknot_tests::theory;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let named = |name: &str| arguments.first().is_none_or(|a| a == "all" || a == name);
    let settings = arguments.get(1..).unwrap_or_default().to_vec();
    let set = settings.as_slice();
    if named("spin") {
        println!("spin: {:?}", theory::spinning_cube(20.0, 100, set));
    }
    if named("meet") {
        for (name, offset) in
            [("head on", [0.0, 0.0]), ("off center", [0.03, 0.0]), ("askew", [0.031, 0.017])]
        {
            for modulus in [1e5, 1e7] {
                println!("meet {name} {modulus:e}: {:?}", theory::meeting(offset, modulus, 40, set));
            }
        }
    }
    if named("drop") {
        for mesh in [false, true] {
            for friction in [0.0, 0.3] {
                for (name, rotate) in
                    [("flat", [0.0; 3]), ("edge", [45.0, 0.0, 0.0]), ("corner", [45.0, 35.26438968, 0.0])]
                {
                    let found = theory::dropped_cube(rotate, friction, mesh, 30, set);
                    println!("drop {name} mu {friction} mesh {mesh}: {found:?} m/s, J");
                }
            }
        }
    }
    if named("throw") {
        for mesh in [false, true] {
            for modulus in [2e4, 1e5, 1e6] {
                let found = theory::thrown_cube(modulus, mesh, 16, set);
                println!("throw {modulus:e} mesh {mesh}: {found:.3?}");
            }
        }
    }
    if named("roll") {
        for (edge, dt) in [(0.02, 0.01), (0.01, 0.01), (0.01, 0.0025)] {
            let steps = (0.4 / dt) as usize;
            println!(
                "roll edge {edge} dt {dt}: {:.3}",
                theory::rolling_ball(10.0, edge, dt, steps / 4..steps, set)
            );
        }
    }
    if named("belt") {
        for friction in [0.2, 0.4] {
            for degrees in [90.0, 180.0, 360.0] {
                let [found, theory] = theory::belt(degrees, friction, set);
                println!("belt {degrees} mu {friction}: {found:.3} ({theory:.3}), {:.3}", found / theory);
            }
        }
    }
    if named("table") {
        for friction in [0.2, 0.4] {
            for pull in [0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2] {
                let moved = theory::table_edge(pull, friction, 100, set);
                println!("table mu {friction} pull {pull}: {:.3} mm", moved * 1e3);
            }
        }
    }
    let level = |slider, ground, friction, speed| Slope {
        degrees: 0.0,
        speed,
        settings: settings.clone(),
        ..Slope::new(slider, ground, friction)
    };
    for slider in Slider::ALL {
        for ground in Ground::ALL {
            if named("stop") {
                let ratio = theory::stopping_distance(&level(slider, ground, 0.3, 0.8));
                println!("stop {slider:?} {ground:?}: {ratio:.3}");
            }
            if named("level") {
                let ratio = level(slider, ground, 0.0, 0.2).run(100).speed(98..101) / 0.2;
                println!("level {slider:?} {ground:?}: {ratio:.4}");
            }
        }
    }
}
