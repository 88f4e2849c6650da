//! Developer commands: `cargo xtask COMMAND`.
//!
//! | command | does |
//! |---|---|
//! | `check` | runs everything that CI runs |
//! | `faults` | kills runs, damages files and fills disks, for longer than CI does |
//! | `pictures` | draws the built-in scenes into `assets/pictures` |
//! | `notebooks` | executes the notebooks of the documentation |
//! | `peers` | runs three scenes in other solvers and judges them, for `docs/judge.md` |
//! | `miri` | runs unit tests of the numerical crates under Miri |
//! | `hashes` | prints a hash of the frames of each built-in scene, to show that a change leaves every bit as it is |
//! | `soak` | draws collision problems for minutes or hours, and judges every accepted step |
//! | `twins` | writes the CPU twins of the kernels from their shaders |
//! | `wheel` | builds the Python package as a release uploads it |
//! | `blender` | packs the extension for Blender, with the wheel in it |
//! | `dist` | builds all that a release uploads |
//! | `web` | builds the page and the npm packages |
//! | `publish` | makes the packages for crates.io and compiles them |
//! | `mutations` | makes mistakes in a copy of the code, and requires that the safety tests catch each |
//!
//! `cargo xtask help` prints the options.
// A command for people and CI logs: printing is what it does.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod blender;
mod bowknot;
mod check;
mod dist;
mod docs;
mod faults;
mod hashes;
mod licenses;
mod miri;
mod mutations;
mod nightly;
mod notebooks;
mod peers;
mod pictures;
mod publish;
mod readers;
mod soak;
mod twins;
mod venv;
mod web;
mod wheel;
mod workspace;

use std::process::ExitCode;

const USAGE: &str = "\
Usage: cargo xtask check [--fast]
       cargo xtask miri [CRATE..]
       cargo xtask faults [--kills N] \
[--seeds N]
       cargo xtask pictures [SCENE..]
       cargo xtask peers [--again] [PEER/SCENE..]
       cargo xtask hashes [--scenes A,B] [--jobs N]
       \
cargo xtask soak [--minutes N] [--seed S] [--jobs J] [--generated]
       cargo xtask soak --replay SEED \
[--generated]
       cargo xtask mutations [NAME..]
       cargo xtask twins
       cargo xtask wheel [--test]
       cargo xtask blender [--test] [WHEEL..]
       cargo xtask web [--test] [--quick] [--threads]
       cargo xtask dist [--check | --built]
       cargo xtask publish
       cargo xtask notebooks [NAME..]

check     run what CI runs, in named steps: format, \
clippy, docs, wasm, a small run, its exports read back, the Python
          package, the browser part, what a release uploads, tests; the fuzz targets if there is a \
nightly compiler, `cargo deny` if it is installed
          --fast        format, clippy and unit tests \
only
miri      run unit tests of geometry, lcp and stepper, or of the crates named, under Miri, which finds \
undefined
          behavior; needs the nightly toolchain with the components miri and rust-src
faults    \
kill runs at random moments and resume them, damage checkpoints, files and folders, fill a disk: the tests \
of CI,
          for longer
          --kills N     kills [default: 200; CI: 5]
          --seeds N     \
inputs of the readers, in halves of what CI tries [default: 20]
pictures  run built-in scenes, all or those \
named, and draw them into assets/pictures; needs a graphics driver
peers     run three scenes in Newton, MuJoCo, rapier and Bowknot, those that are not in out/peers yet, judge them
          all, and write the tables of docs/judge.md; needs Python with venv
          --again       run again what is there
hashes    run built-in scenes at a small \
scale on one thread each, and print for each its name, the number of its frames
          and a hash of all \
bytes of the frames: compare the lines before and after a change that is to leave every
          result as \
it is, on the same machine
          --scenes A,B  these scenes only
          --jobs N      run N scenes at \
the same time [default: as many as there are cores]
soak      draw collision problems and judge each \
accepted step; a failure ends it with the smallest case and its seed
          --minutes N   how long \
[default: 10]
          --seed S      seed of all problems [default: from the clock]
          --jobs J      \
number of problems at a time, on a thread each [default: 1]
          --generated   large generated states \
only, instead of mostly small pieces
          --replay SEED draw, check and shrink one problem \
again
mutations make the mistakes of tests/safety/mutations, all or those named, one at a time in a copy of \
the workspace, and
          require that the safety tests catch each; some minutes per mutation
twins     write crates/gpu/src/kernels, what \
the CPU runs in place of each kernel, from crates/gpu/shader: after every change of a
          shader
wheel     build the Python package as a release uploads it, in target/wheels; needs Python with venv
          --test        install it into an environment of its own and run its tests
blender   pack the extension for Blender, in target/blender, with the wheels named, of other systems too, or with one that
          it builds; needs Python with venv
          --test        install the zip in Blender's module bpy (500 MB, Python 3.11) and run the extension's tests
web       build the page of crates/web into target/web, which any static server serves, and the npm packages into \
target/npm
          --test        open the page in Chromium and compare with the command; needs Python with venv
          --quick       without optimization of the module as a whole, and without the long tests: what CI does
          --threads     a module with threads as well; needs the nightly compiler with the component rust-src
dist      build all that a release uploads, into target/dist: the command with completions, manual pages and licenses, the
          libraries for C, the wheel, the extension for Blender, the page and the npm packages, checksums; needs what the
          steps above need
          --check       build the archives of the command and of the libraries alone, and unpack and try them
          --built       pack what the steps of `check` have built, in the release profile, and try it: what CI does
publish   make the packages that a release uploads to crates.io, and compile them from what is in them
notebooks execute the notebooks of docs/notebooks, all or those named, with the wheel of this \
commit, and write their outputs
          into them; needs Python with venv, and a graphics driver";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["check"] => check::run(false),
        ["check", "--fast"] => check::run(true),
        ["miri", names @ ..] if names.iter().all(|name| !name.starts_with('-')) => {
            miri::run(&workspace::root(), names)
        }
        ["faults", options @ ..] => match faults::Options::parse(options) {
            Ok(options) => faults::run(&workspace::root(), &options),
            Err(message) => {
                eprintln!("{message}\n\n{USAGE}");
                ExitCode::from(2)
            }
        },
        ["pictures", names @ ..] if names.iter().all(|name| !name.starts_with('-')) => {
            pictures::run(&workspace::root(), names)
        }
        ["peers", options @ ..] => peers::run(&workspace::root(), options),
        ["hashes", options @ ..] => match hashes::Options::parse(options) {
            Ok(options) => hashes::run(&workspace::root(), &options),
            Err(message) => {
                eprintln!("{message}\n\n{USAGE}");
                ExitCode::from(2)
            }
        },
        ["soak", options @ ..] => soak::run(&workspace::root(), options),
        ["mutations", names @ ..] if names.iter().all(|name| !name.starts_with('-')) => {
            mutations::run(&workspace::root(), names)
        }
        ["twins"] => twins::run(&workspace::root()),
        ["wheel"] => wheel::run(&workspace::root(), false),
        ["wheel", "--test"] => wheel::run(&workspace::root(), true),
        ["blender", arguments @ ..]
            if arguments.iter().all(|word| *word == "--test" || word.ends_with(".whl")) =>
        {
            blender::run(&workspace::root(), arguments)
        }
        ["publish"] => publish::run(&workspace::root()),
        ["dist"] => dist::run(&workspace::root(), dist::Parts::All),
        ["dist", "--check"] => dist::run(&workspace::root(), dist::Parts::Programs),
        ["dist", "--built"] => dist::run(&workspace::root(), dist::Parts::Built),
        ["web", words @ ..] if words.iter().all(|word| ["--test", "--quick", "--threads"].contains(word)) => {
            let has = |word| words.contains(&word);
            let options = web::Options { quick: has("--quick"), threads: has("--threads") };
            web::run(&workspace::root(), has("--test"), options)
        }
        ["notebooks", names @ ..] if names.iter().all(|name| !name.starts_with('-')) => {
            notebooks::run(&workspace::root(), names)
        }
        ["help" | "--help" | "-h"] => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}
