//! The steps of CI, each with its name and duration.
//!
//! All steps share one target folder and the release profile, so that each reuses what the steps above it
//! compiled. The tests come last and nothing follows them: the log ends with the test runner's own lines.

use crate::workspace::{cargo, root, target_folder};
use crate::{bowknot, docs, nightly, peers, readers, venv, web, wheel};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

struct Step {
    name: &'static str,
    command: Command,
    /// Runs the command and says whether it passed.
    run: fn(&mut Command) -> std::io::Result<bool>,
}

impl Step {
    /// A step that passes if its command does.
    fn new(name: &'static str, command: Command) -> Self {
        Self { name, command, run: |command| Ok(command.status()?.success()) }
    }
}

/// Programs of which the browser tests take the first that is there.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Runs the steps in order and stops at the first that fails.
pub fn run(fast: bool) -> ExitCode {
    let root = root();
    let steps = if fast { fast_steps(&root) } else { all_steps(&root) };
    let count = steps.len();
    for (index, mut step) in steps.into_iter().enumerate() {
        println!("\n==> [{}/{count}] {}: {}", index + 1, step.name, describe(&step.command));
        let timer = Instant::now();
        let passed = (step.run)(&mut step.command).unwrap_or_else(|error| {
            eprintln!("cannot start {}: {error}", describe(&step.command));
            false
        });
        let seconds = timer.elapsed().as_secs_f64();
        if !passed {
            println!("<== {} failed after {seconds:.1} s", step.name);
            return ExitCode::FAILURE;
        }
        if index + 1 < count {
            println!("<== {} passed in {seconds:.1} s", step.name);
        }
    }
    ExitCode::SUCCESS
}

fn fast_steps(root: &Path) -> Vec<Step> {
    vec![
        format(root),
        clippy(root),
        Step::new("unit tests", cargo(root, "test --release --workspace --lib --bins")),
    ]
}

fn all_steps(root: &Path) -> Vec<Step> {
    let mut docs = cargo(root, "doc --release --workspace --no-deps");
    docs.env("RUSTDOCFLAGS", docs::FLAGS);
    let docs = Step { run: docs::run, ..Step::new("docs", docs) };
    let mut steps = vec![format(root), clippy(root), docs];
    if wasm_is_installed() {
        // With all that it depends on: every library but those of files, pages and devices.
        let mut wasm = cargo(root, "clippy --release --package bowknot-web --target");
        wasm.args([web::TARGET, "--", "-D", "warnings"]);
        steps.push(Step::new("wasm", wasm));
    } else {
        println!("==> wasm: skipped, because the target is missing: rustup target add {}", web::TARGET);
    }
    if is_there("deny") {
        // Advisories need a database from the network.
        let deny = cargo(root, "deny --config .deny.toml check bans licenses sources");
        steps.push(Step::new("deny", deny));
    } else {
        println!("==> deny: skipped, because cargo-deny is missing: cargo install cargo-deny --locked");
    }
    if nightly::is_installed(root) {
        steps.push(Step::new("fuzz targets", fuzz_targets(root)));
    } else {
        println!(
            "==> fuzz targets: skipped, because there is no nightly compiler: rustup toolchain install \
             nightly"
        );
    }
    steps.push(Step::new("build tests", cargo(root, "test --release --workspace --no-run")));
    // The step above built the command. `cargo run` would build it anew, with the features of its own package
    // alone.
    let target = target_folder(root);
    let mut drape = Command::new(bowknot::path(&target));
    drape
        .args("run drape --scale 0.4 --frames 40 --check --out".split(' '))
        .arg(target.join("xtask").join("drape"));
    drape.current_dir(root);
    steps.push(Step { run: run_afresh, ..Step::new("run drape --check", drape) });
    if venv::wanted() {
        steps.push(Step { run: run_afresh, ..Step::new("export", readers::export(&target)) });
        let read = readers::read(root, &target);
        steps.push(Step { run: readers::run, ..Step::new("read exports", read) });
        for folder in ["tests/peers", "crates/bench/peers"] {
            steps.push(Step::new(folder, peers::tests(root, &target, folder)));
        }
        steps.push(Step { run: wheel::build, ..Step::new("wheel", wheel::command(root, &target)) });
        steps.push(Step { run: wheel::test, ..Step::new("python", wheel::tests(root, &target)) });
    } else {
        println!(
            "==> read exports, peers, wheel, python: skipped, because Python 3.11 with venv is missing: apt-get install \
             python3-venv"
        );
    }
    match web_lacks() {
        None => {
            let mut web = xtask(root, "web --quick --test");
            web.env(web::COMMAND, bowknot::path(&target));
            steps.push(Step::new("web", web));
        }
        Some(what) => println!("==> web: skipped, because {what}"),
    }
    if venv::wanted() {
        // With the wheel and the page of the steps above.
        steps.push(Step::new("dist", xtask(root, "dist --built")));
    } else {
        println!("==> dist: skipped, because there is no wheel to pack");
    }
    steps.push(Step::new("publish", xtask(root, "publish")));
    steps.push(Step::new("tests", cargo(root, "test --release --workspace")));
    steps
}

/// Another command of this program.
fn xtask(root: &Path, arguments: &str) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap_or_else(|_| "xtask".into()));
    command.args(arguments.split(' ')).current_dir(root);
    command
}

/// What the tests of the browser part need and this machine lacks, if anything.
fn web_lacks() -> Option<String> {
    let starts = |program: &&str| {
        let output = Command::new(program).arg("--version").output();
        output.is_ok_and(|output| output.status.success())
    };
    if !wasm_is_installed() {
        Some(format!("the target is missing: rustup target add {}", web::TARGET))
    } else if !starts(&"node") {
        Some("Node is missing: apt-get install nodejs".to_owned())
    } else if !BROWSERS.iter().any(starts) {
        Some("Chromium is missing: apt-get install chromium".to_owned())
    } else if !venv::wanted() {
        Some("Python 3.11 with venv is missing: apt-get install python3-venv".to_owned())
    } else {
        None
    }
}

/// Runs a command whose last argument is its output folder, and removes that folder first: `bowknot run`
/// refuses a folder that holds a run.
fn run_afresh(command: &mut Command) -> std::io::Result<bool> {
    if let Some(out) = command.get_args().last().map(Path::new).filter(|out| out.exists()) {
        std::fs::remove_dir_all(out)?;
    }
    Ok(command.status()?.success())
}

/// Checks the fuzz targets, which are no members of the workspace, with the compiler that runs them.
fn fuzz_targets(root: &Path) -> Command {
    let mut command = nightly::cargo(root);
    command.args("check --release --manifest-path tests/fuzz/Cargo.toml --target-dir".split(' '));
    command.arg(target_folder(root).join("fuzz"));
    command
}

/// Whether cargo has this subcommand.
fn is_there(subcommand: &str) -> bool {
    let output = Command::new("cargo").args([subcommand, "--version"]).output();
    output.is_ok_and(|output| output.status.success())
}

fn format(root: &Path) -> Step {
    Step::new("format", cargo(root, "fmt --all --check"))
}

fn clippy(root: &Path) -> Step {
    Step::new("clippy", cargo(root, "clippy --release --workspace --all-targets -- -D warnings"))
}

fn describe(command: &Command) -> String {
    let words = command.get_args().map(|word| word.to_string_lossy().into_owned());
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default().to_string_lossy();
    std::iter::once(program.into_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Whether the compiler has the standard library of the web target.
fn wasm_is_installed() -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).args(["--print", "target-libdir", "--target", web::TARGET]).output();
    output.is_ok_and(|o| o.status.success() && Path::new(String::from_utf8_lossy(&o.stdout).trim()).is_dir())
}
