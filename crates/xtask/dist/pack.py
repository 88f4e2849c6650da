"""Packs what a release uploads: `cargo xtask dist` calls it with what it has built.

Archives have fixed times, owners and orders: the same files give the same bytes. Needs Python 3.11 alone.
"""

from __future__ import annotations

import argparse
import contextlib
import gzip
import hashlib
import io
import os
import platform
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

#: Time of all files in archives [s].
_TIME = 1767225600

#: The text of the licenses of what is linked, as `crates/xtask/src/licenses.rs` names it.
_DEPENDENCIES = "LICENSES-OF-DEPENDENCIES.txt"


def system() -> str:
    """The system and processor that the binaries are for, such as `linux-x64`."""
    names = {"Linux": "linux", "Darwin": "macos", "Windows": "windows"}
    processors = {"x86_64": "x64", "AMD64": "x64", "aarch64": "arm64", "arm64": "arm64"}
    machine = platform.machine()
    return f"{names.get(platform.system(), platform.system().lower())}-{processors.get(machine, machine)}"


def archive(path: Path, files: dict[str, Path | bytes], level: int = 9) -> None:
    """Writes a .tar.gz of these files, which lie in a folder of the archive's name."""
    folder = path.name.removesuffix(".tar.gz").removesuffix(".tgz")
    with path.open("wb") as raw, gzip.GzipFile("", "wb", level, raw, mtime=0) as zipped:
        with tarfile.open(fileobj=zipped, mode="w", format=tarfile.PAX_FORMAT) as tar:
            for name in sorted(files):
                content = files[name]
                data = content if isinstance(content, bytes) else content.read_bytes()
                entry = tarfile.TarInfo(f"{folder}/{name}")
                entry.size, entry.mtime = len(data), _TIME
                is_program = name.startswith("bin/") or name.endswith((".so", ".dylib", ".dll"))
                entry.mode = 0o755 if is_program else 0o644
                tar.addfile(entry, io.BytesIO(data))


def folder_files(folder: Path, prefix: str = "") -> dict[str, Path | bytes]:
    """The files of a folder, by their names in an archive."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {prefix + path.relative_to(folder).as_posix(): path for path in files}


def with_licenses(parts: Path, readme: str, files: dict[str, Path | bytes]) -> dict[str, Path | bytes]:
    """These files with what to read first, our licenses and those of what is linked."""
    ours = {name: ROOT / name for name in ("LICENSE-MIT", "LICENSE-APACHE")}
    return {**files, **ours, "README.md": ROOT / readme, _DEPENDENCIES: parts / _DEPENDENCIES}


def command_archive(programs: Path, parts: Path, path: Path, level: int) -> None:
    """The command with completions, manual pages and licenses."""
    name = "bowknot.exe" if platform.system() == "Windows" else "bowknot"
    files: dict[str, Path | bytes] = {
        f"bin/{name}": programs / name,
        "CHANGELOG.md": ROOT / "CHANGELOG.md",
        **folder_files(parts / "completions", "completions/"),
        **folder_files(parts / "man", "share/man/man1/"),
    }
    archive(path, with_licenses(parts, "crates/cli/README.md", files), level)


def library_archive(libraries: Path, parts: Path, path: Path, level: int) -> None:
    """The libraries for C with their header and example."""
    names = ("libbowknot_c.a", "libbowknot_c.so", "libbowknot_c.dylib", "bowknot_c.dll", "bowknot_c.dll.lib", "bowknot_c.lib")
    files: dict[str, Path | bytes] = {
        f"lib/{name}": libraries / name for name in names if (libraries / name).is_file()
    }
    files |= {
        "include/bowknot.h": ROOT / "crates/capi/include/bowknot.h",
        "examples/drape.c": ROOT / "crates/capi/examples/drape.c",
    }
    archive(path, with_licenses(parts, "crates/capi/README.md", files), level)


def others(target: Path, out: Path, version: str) -> None:
    """The wheel, the page and the npm packages, those that are there."""
    for wheel in (target / "wheels").glob(f"bowknot-{version}-*.whl"):
        shutil.copy2(wheel, out)
    if not (target / "web").is_dir():
        print("no page and no npm packages: cargo xtask web has not built them", file=sys.stderr)
        return
    archive(out / f"bowknot-web-{version}.tar.gz", folder_files(target / "web"))
    for name in ("bowknot", "bowknot-compat"):
        # As `npm pack` does: all is in a folder `package`.
        with tempfile.TemporaryDirectory() as place:
            packed = Path(place) / "package.tgz"
            archive(packed, folder_files(target / "npm" / name))
            shutil.copyfile(packed, out / f"npm-{name}-{version}.tgz")


@contextlib.contextmanager
def unpacked(path: Path) -> Iterator[Path]:
    """The folder in an archive, unpacked as a user does."""
    with tempfile.TemporaryDirectory() as place:
        with tarfile.open(path) as tar:
            tar.extractall(place, filter="data")
        yield Path(place) / path.name.removesuffix(".tar.gz")


def try_command(path: Path, shipped: bool) -> None:
    """Runs the command of its archive."""
    with unpacked(path) as folder:
        program = next((folder / "bin").iterdir())
        run = [program, "run", "drape", "--scale", "0.2", "--frames", "30", "--check", "--out", f"{folder}/run"]
        done = subprocess.run(run, cwd=folder, capture_output=True, text=True)
        if done.returncode != 0 or "no intersection" not in done.stdout + done.stderr:
            raise SystemExit(f"{program.name} of {path.name} does not run: {done.stderr}")
        strange = [str(home).encode() for home in (ROOT, Path.home() / ".cargo") if str(home).encode() in program.read_bytes()]
        if shipped and strange:
            raise SystemExit(f"{program.name} has paths of this machine in it: {strange}")


def try_libraries(path: Path) -> None:
    """Compiles the example for C with header and libraries of the archive, and runs it."""
    compiler = os.environ.get("CC", "cc")
    if platform.system() != "Linux" or shutil.which(compiler) is None:
        print("the libraries for C are not tried: this needs Linux and a compiler for C", file=sys.stderr)
        return
    with unpacked(path) as folder:
        libraries, program = folder / "lib", folder / "drape"
        compile_ = [compiler, "-std=c11", "-o", program, folder / "examples/drape.c", "-I", folder / "include"]
        shared = ["-L", libraries, "-lbowknot_c", f"-Wl,-rpath,{libraries}"]
        for linked in (shared, [libraries / "libbowknot_c.a", "-lm", "-lpthread", "-ldl"]):
            subprocess.run([*compile_, *linked], check=True)
            done = subprocess.run([program], cwd=folder, capture_output=True, text=True)
            if done.returncode != 0 or ", 0 intersections\n" not in done.stdout:
                raise SystemExit(f"the example of {path.name} does not run: {done.stdout}{done.stderr}")


def require_licenses(path: Path) -> None:
    """Refuses what has no licenses of its dependencies in it. The zip for Blender has those of the wheel in it."""
    if path.suffix == ".whl":
        with zipfile.ZipFile(path) as wheel:
            names = wheel.namelist()
    elif path.suffix in (".gz", ".tgz"):
        with tarfile.open(path) as tar:
            names = tar.getnames()
    else:
        return
    if not any(name.endswith(f"/{_DEPENDENCIES}") for name in names):
        raise SystemExit(f"{path.name} has no {_DEPENDENCIES}")


def main() -> None:
    """Packs, tries and sums up."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--version", required=True)
    parser.add_argument("--target", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--blender", type=Path, help="the extension")
    parser.add_argument("--others", action="store_true", help="the wheel, the page and the npm packages as well")
    parser.add_argument("--built", action="store_true", help="what CI has built, with symbols and hardly compressed")
    options = parser.parse_args()
    target, out, version = options.target, options.out, options.version
    folders = ("release", "release/deps") if options.built else ("shipped", "shipped")
    programs, libraries = (target / folder for folder in folders)
    # Those with symbols take hundreds of megabytes.
    parts, level = target / "xtask/dist", 1 if options.built else 9
    command = out / f"bowknot-{version}-{system()}.tar.gz"
    library = out / f"bowknot-c-{version}-{system()}.tar.gz"
    command_archive(programs, parts, command, level)
    library_archive(libraries, parts, library, level)
    try_command(command, not options.built)
    try_libraries(library)
    if options.others:
        others(target, out, version)
    if options.blender is not None:
        # Beside the archive of the command, the name says what the zip is.
        shutil.copy2(options.blender, out / options.blender.name.replace("bowknot-", "bowknot-blender-", 1))
    files = sorted(path for path in out.iterdir() if path.is_file())
    for path in files:
        require_licenses(path)
    sums = "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files)
    (out / "SHA256SUMS").write_text(sums, encoding="utf-8")
    for path in files:
        print(f"{path.stat().st_size:11,} bytes  {path.name}", file=sys.stderr)


main()
