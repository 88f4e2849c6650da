//! `cargo xtask web`: the page and the npm packages of `crates/web`, and their tests.
//!
//! Cargo compiles the crate for the web, and the tool `wasm-bindgen` writes the JavaScript that calls it; it has the
//! version of the crate of that name in `Cargo.lock`. The viewer of the page is that of `crates/report`.

use crate::workspace::{cargo, succeed, target_folder};
use crate::{bowknot, licenses, nightly, venv};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::{Error, Result, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// What rustc compiles for.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// The crate of the page and the packages.
const CRATE: &str = "crates/web";

/// Where the viewer's scripts are.
const REPORT: &str = "crates/report/src/assets";

/// Scripts of the report that the page uses, and what their licenses are in.
const VIEWER: [&str; 8] = [
    "page.css",
    "libraries/libraries.min.js",
    "libraries/LICENSE-three",
    "app/colors.js",
    "app/fields.js",
    "app/shapes.js",
    "app/ground.js",
    "app/viewer.js",
];

/// Vector instructions, which all browsers have had since 2023, and a stack like that of the command's threads.
const FLAGS: &str = "-C target-feature=+simd128 -C link-arg=-zstack-size=8388608";

/// And with threads: memory that they share, of at most 4 GB, and what the start of each of them needs.
const THREADS: &str = "-C target-feature=+atomics -C link-arg=--shared-memory -C link-arg=--import-memory \
     -C link-arg=--max-memory=4294967296 -C link-arg=--export=__wasm_init_tls -C link-arg=--export=__tls_size \
     -C link-arg=--export=__tls_align -C link-arg=--export=__tls_base";

/// The folder of the page and of the package `bowknot` with that module.
const THREADED: &str = "threads";

/// The variable of the environment that names the command to compare with.
pub const COMMAND: &str = "BOWKNOT_COMMAND";

/// Most bytes of the page, each of its files compressed by gzip.
const MOST: usize = 3_000_000;

/// What is built.
#[derive(Clone, Copy)]
pub struct Options {
    /// Without the optimization of the whole, and not all of the tests.
    pub quick: bool,
    /// A module with threads as well, which takes the nightly compiler.
    pub threads: bool,
}

/// Builds, and tests as well if asked to.
pub fn run(root: &Path, with_tests: bool, options: Options) -> ExitCode {
    let target = target_folder(root);
    let done = build(root, &target, options).and_then(|()| match with_tests {
        true => test(root, &target, options.quick),
        false => Ok(()),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Builds the page into `target/web` and the packages into `target/npm`, and prints how large they are.
pub fn build(root: &Path, target: &Path, options: Options) -> Result<()> {
    // Macros and build scripts of the release profile are those of the command.
    let profile = if options.quick { "release" } else { "wasm" };
    let wasm = compile(cargo(root, "build"), target, profile, FLAGS)?;
    let threaded = match options.threads {
        true => Some(compile_threads(root, &target.join(THREADED), profile)?),
        false => None,
    };
    let tool = bindgen(root, target)?;
    let (page, npm) = (target.join("web"), target.join("npm"));
    for folder in [&page, &npm] {
        if folder.exists() {
            fs::remove_dir_all(folder)?;
        }
    }
    write_page(root, &tool, &wasm, &page)?;
    write_packages(root, &tool, &wasm, &npm)?;
    if let Some(threaded) = &threaded {
        write_threaded(&tool, threaded, &page.join(THREADED), &["--no-typescript"])?;
        write_threaded(&tool, threaded, &npm.join("bowknot").join(THREADED), &[])?;
        export_threads(&npm.join("bowknot/package.json"))?;
    }
    let features: &[&str] = if options.threads { &["bowknot-web/threads"] } else { &[] };
    for folder in [&page, &npm.join("bowknot"), &npm.join("bowknot-compat")] {
        for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
            fs::copy(root.join(license), folder.join(license))?;
        }
        licenses::write(root, &["bowknot-web"], features, TARGET, folder)?;
    }
    // A visitor loads one of the two modules.
    let other = if threaded.is_some() { report(&page.join(THREADED))? } else { 0 };
    let size = report(&page)? - other;
    report(&npm.join("bowknot"))?;
    report(&npm.join("bowknot-compat"))?;
    if size > MOST {
        return Err(Error::other(format!("the page takes {size} bytes compressed, more than {MOST}")));
    }
    Ok(())
}

/// Compiles the module and returns its file.
fn compile(mut cargo: Command, target: &Path, profile: &str, flags: &str) -> Result<PathBuf> {
    cargo
        .args(["--package", "bowknot-web", "--profile", profile, "--target", TARGET, "--target-dir"])
        .arg(target);
    // Flags of the environment would take the place of these.
    succeed(cargo.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", flags))?;
    Ok(target.join(TARGET).join(profile).join("bowknot_web.wasm"))
}

/// The same with threads. The standard library that compilers come with has none on this target.
fn compile_threads(root: &Path, target: &Path, profile: &str) -> Result<PathBuf> {
    if !nightly::has_sources(root) {
        return Err(Error::other(
            "threads take the nightly compiler and the sources of its standard library: rustup toolchain install nightly \
             --component rust-src",
        ));
    }
    let mut cargo = nightly::cargo(root);
    cargo.args(["build", "-Z", "build-std=std,panic_abort", "--features", "threads"]);
    compile(cargo, target, profile, &format!("{FLAGS} {THREADS}"))
}

/// The module with threads. Bundlers take the folder that its workers import for the file in it; servers do not.
fn write_threaded(tool: &Path, wasm: &Path, folder: &Path, options: &[&str]) -> Result<()> {
    glue(tool, wasm, folder, options)?;
    let mut files = Vec::new();
    list(&folder.join("snippets"), &mut files)?;
    let mut found = false;
    for file in files.iter().filter(|file| file.extension().is_some_and(|end| end == "js")) {
        let text = fs::read_to_string(file)?;
        found |= text.contains("import('../../..')");
        fs::write(file, text.replace("import('../../..')", "import('../../../bowknot.js')"))?;
    }
    if found {
        Ok(())
    } else {
        Err(Error::other("wasm-bindgen-rayon imports the module in another way than it did"))
    }
}

/// Names the module with threads in the manifest of the package.
fn export_threads(manifest: &Path) -> Result<()> {
    let text = fs::read_to_string(manifest)?;
    let last = "\"./bowknot_bg.wasm\": \"./bowknot_bg.wasm\"";
    let more = r#""./threads": { "types": "./threads/bowknot.d.ts", "default": "./threads/bowknot.js" }"#;
    if !text.contains(last) {
        return Err(Error::other(format!(
            "{}: no export after which that of threads fits",
            manifest.display()
        )));
    }
    fs::write(manifest, text.replace(last, &format!("{last},\n        {more}")))
}

/// The page: its own files, the module, and the viewer of the report.
fn write_page(root: &Path, tool: &Path, wasm: &Path, page: &Path) -> Result<()> {
    let viewer = page.join("viewer");
    fs::create_dir_all(&viewer)?;
    copy_folder(&root.join(CRATE).join("page"), page)?;
    for file in VIEWER {
        let name = Path::new(file).file_name().unwrap_or_default();
        fs::copy(root.join(REPORT).join(file), viewer.join(name))?;
    }
    glue(tool, wasm, page, &["--no-typescript"])
}

/// The package whose module is a file beside it, and the one that has it inside.
fn write_packages(root: &Path, tool: &Path, wasm: &Path, npm: &Path) -> Result<()> {
    let version = env!("CARGO_PKG_VERSION");
    let sources = root.join(CRATE).join("npm");
    for name in ["bowknot", "bowknot-compat"] {
        let folder = npm.join(name);
        fs::create_dir_all(&folder)?;
        copy_folder(&sources.join(name), &folder)?;
        let manifest = folder.join("package.json");
        let text = fs::read_to_string(&manifest)?.replace("\"0.0.0\"", &format!("\"{version}\""));
        fs::write(manifest, text)?;
    }
    glue(tool, wasm, &npm.join("bowknot"), &[])?;
    // Bundlers would look for the file that the glue names.
    let compat = npm.join("bowknot-compat");
    glue(tool, wasm, &compat, &["--omit-default-module-path"])?;
    let module = compat.join("bowknot_bg.wasm");
    let inlined = format!("export default \"{}\";\n", STANDARD.encode(fs::read(&module)?));
    fs::write(compat.join("module.js"), inlined)?;
    fs::remove_file(module)?;
    fs::remove_file(compat.join("bowknot_bg.wasm.d.ts"))
}

/// Writes the JavaScript that calls a module, as `bowknot.js`, and the module beside it.
fn glue(tool: &Path, wasm: &Path, folder: &Path, options: &[&str]) -> Result<()> {
    let mut command = Command::new(tool);
    command
        .args("--remove-name-section --remove-producers-section --target web --out-name bowknot".split(' '));
    command.args(options).arg("--out-dir").arg(folder);
    succeed(command.arg(wasm))
}

/// The tool of the right version; installs it unless it is there.
fn bindgen(root: &Path, target: &Path) -> Result<PathBuf> {
    let version = bindgen_version(root)?;
    if let Some(tool) = found(target, &version) {
        return Ok(tool);
    }
    println!("==> installing wasm-bindgen {version}, which takes a minute or two once");
    // It runs for seconds, so it need not be optimized, which takes longer.
    let mut install = cargo(root, "install wasm-bindgen-cli --quiet --debug --version");
    install.arg(&version).arg("--root").arg(target.join("xtask"));
    succeed(&mut install)?;
    found(target, &version).ok_or_else(|| Error::other("cargo has installed another version of wasm-bindgen"))
}

/// The tool in the target folder, or on the path.
fn found(target: &Path, version: &str) -> Option<PathBuf> {
    let own = target.join("xtask/bin").join(format!("wasm-bindgen{}", std::env::consts::EXE_SUFFIX));
    let wanted = format!("wasm-bindgen {version}");
    [own, PathBuf::from("wasm-bindgen")].into_iter().find(|tool| {
        let output = Command::new(tool).arg("--version").stderr(Stdio::null()).output();
        output.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim() == wanted)
    })
}

/// The version of the crate `wasm-bindgen` in `Cargo.lock`.
fn bindgen_version(root: &Path) -> Result<String> {
    let lock = fs::read_to_string(root.join("Cargo.lock"))?;
    let entry =
        lock.split_once("name = \"wasm-bindgen\"\nversion = \"").and_then(|(_, rest)| rest.split_once('"'));
    entry.map(|(version, _)| version.to_owned()).ok_or_else(|| Error::other("Cargo.lock has no wasm-bindgen"))
}

/// Opens the page in a browser and compares what it computes with the command, which is built first unless the
/// environment names one.
fn test(root: &Path, target: &Path, quick: bool) -> Result<()> {
    let command = match std::env::var_os(COMMAND) {
        Some(command) => command.into(),
        None => bowknot::build(root).map_err(Error::other)?,
    };
    let (folder, tests) = (target.join("xtask/web"), root.join(CRATE).join("tests"));
    venv::ensure(&folder, &tests.join("requirements.txt"))?;
    let mut pytest = Command::new(venv::python(&folder));
    // What they print, frame rates and errors, is part of the result.
    pytest.args(["-m", "pytest", "--quiet", "-rs", "--capture=no", "-p", "no:cacheprovider"]).arg(tests);
    if quick {
        pytest.args(["-m", "not long"]);
    }
    succeed(pytest.env(COMMAND, command).env("BOWKNOT_TARGET", target).current_dir(root))
}

/// Prints the size of each file of a folder and of all, as they are and compressed. Returns the latter.
fn report(folder: &Path) -> Result<usize> {
    println!("{}", folder.display());
    let mut files = Vec::new();
    list(folder, &mut files)?;
    let mut total = [0, 0];
    for file in &files {
        let sizes = [fs::metadata(file)?.len() as usize, compressed(file)?];
        total = [total[0] + sizes[0], total[1] + sizes[1]];
        // Small ones are of no interest.
        if sizes[0] > 50_000 {
            let name = file.strip_prefix(folder).unwrap_or(file);
            println!("  {:9} bytes, {:9} compressed  {}", sizes[0], sizes[1], name.display());
        }
    }
    println!("  {:9} bytes, {:9} compressed  in all", total[0], total[1]);
    Ok(total[1])
}

/// The size of a file compressed by gzip, which most servers do.
fn compressed(file: &Path) -> Result<usize> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&fs::read(file)?)?;
    Ok(encoder.finish()?.len())
}

/// The files of a folder and of those in it, sorted.
fn list(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    entries.sort();
    for entry in entries {
        if entry.is_dir() { list(&entry, files)? } else { files.push(entry) }
    }
    Ok(())
}

/// Copies the files of a folder.
fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    let mut files = Vec::new();
    list(from, &mut files)?;
    for file in files {
        let place = to.join(file.strip_prefix(from).unwrap_or(&file));
        fs::create_dir_all(place.parent().unwrap_or(to))?;
        fs::copy(&file, place)?;
    }
    Ok(())
}
