//! `cargo xtask blender`: the extension for Blender as a zip, with the wheel in it, and its tests in Blender's module.

use crate::venv;
use crate::wheel;
use crate::workspace::target_folder;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Where the extension, its tests and what packs it are.
const FOLDER: &str = "crates/python/blender";

/// Libraries of the system that Blender's module loads.
const LIBRARIES: &str = "libX11.so.6 libXrender.so.1 libXxf86vm.so.1 libXfixes.so.3 libXi.so.6 libxkbcommon.so.0 libSM.so.6 \
                         libICE.so.6 libGL.so.1 libgomp.so.1";

/// What the tests need and this machine lacks, if anything.
pub fn lacks() -> Option<&'static str> {
    let runs = |code: &str| {
        let status = Command::new("python3").args(["-c", code, LIBRARIES]).stderr(Stdio::null()).status();
        status.is_ok_and(|status| status.success())
    };
    if !runs("import ensurepip, sys; sys.exit(sys.version_info[:2] != (3, 11))") {
        Some("Blender's module is for Python 3.11 alone, with venv")
    } else if cfg!(target_os = "linux")
        && !runs("import ctypes, sys; [*map(ctypes.CDLL, sys.argv[1].split())]")
    {
        Some("libraries that Blender's module loads are missing: .ci/run installs them")
    } else {
        None
    }
}

/// Packs the wheels that are given, the last one that was built or one that it builds, and prints the path of the zip;
/// tests it as well if asked to.
pub fn run(root: &Path, arguments: &[&str]) -> ExitCode {
    let (target, with_tests) = (target_folder(root), arguments.contains(&"--test"));
    let given = arguments.iter().filter(|argument| argument.ends_with(".whl")).map(PathBuf::from);
    let is_built = arguments.contains(&"--built");
    if with_tests && let Err(error) = install(root, &target) {
        // A package index without files of this size is no fault of the extension.
        eprintln!("Blender's module could not be installed: {error}");
        return if is_built { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    let wheels = match is_built {
        true => wheel::newest(&target).map(|wheel| vec![wheel]),
        false => Ok(given.collect()),
    };
    match wheels.and_then(|wheels| pack_and_test(root, &target, wheels, with_tests)) {
        Ok(zip) => {
            println!("{}", zip.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Packs the wheels, or one that it builds if there are none; the path of the zip.
pub fn pack_and_test(
    root: &Path,
    target: &Path,
    mut wheels: Vec<PathBuf>,
    with_tests: bool,
) -> Result<PathBuf> {
    if wheels.is_empty() {
        if !wheel::build(&mut wheel::command(root, target))? {
            return Err(Error::other("maturin built no wheel"));
        }
        wheels.push(wheel::newest(target)?);
    }
    let mut pack = Command::new("python3");
    pack.arg(root.join(FOLDER).join("pack.py")).arg(target.join("blender")).args(&wheels);
    let packed = pack.stderr(Stdio::inherit()).output()?;
    if !packed.status.success() {
        return Err(Error::other("the extension was not packed"));
    }
    let zip = PathBuf::from(String::from_utf8_lossy(&packed.stdout).trim());
    if with_tests && !test(root, target, &zip)? {
        return Err(Error::other("the tests of the extension failed"));
    }
    Ok(zip)
}

/// Installs Blender's module and what the tests need.
fn install(root: &Path, target: &Path) -> Result<()> {
    venv::ensure(&target.join("xtask/blender"), &root.join(FOLDER).join("tests/requirements.txt"))
}

/// Runs the tests in Blender's module, into which they install the zip as users do.
fn test(root: &Path, target: &Path, zip: &Path) -> Result<bool> {
    let tests = root.join(FOLDER).join("tests");
    let environment = target.join("xtask/blender");
    let mut command = Command::new(venv::python(&environment));
    command.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]).arg(&tests);
    command.env("BOWKNOT_BLENDER_ZIP", zip).current_dir(target);
    Ok(command.status()?.success())
}
