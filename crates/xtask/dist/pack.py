"""Packs what a release uploads: `cargo xtask dist` calls it with what it has built.

Archives have fixed times, owners and orders: the same files give the same bytes. Needs Python 3.11 alone.
"""

from __future__ import annotations

import argparse
import gzip
import hashlib
import io
import json
import platform
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

#: Time of all files in archives [s].
_TIME = 1767225600

#: Names of files with licenses begin so.
_LICENSES = ("license", "licence", "copying", "notice", "unlicense")


def system() -> str:
    """The system and processor that the binaries are for, such as `linux-x64`."""
    names = {"Linux": "linux", "Darwin": "macos", "Windows": "windows"}
    processors = {"x86_64": "x64", "AMD64": "x64", "aarch64": "arm64", "arm64": "arm64"}
    machine = platform.machine()
    return f"{names.get(platform.system(), platform.system().lower())}-{processors.get(machine, machine)}"


def archive(path: Path, files: dict[str, Path | bytes]) -> None:
    """Writes a .tar.gz of these files, which lie in a folder of the archive's name."""
    folder = path.name.removesuffix(".tar.gz").removesuffix(".tgz")
    with path.open("wb") as raw, gzip.GzipFile(filename="", mode="wb", fileobj=raw, mtime=0) as zipped:
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


def licenses(package: str) -> bytes:
    """The licenses of all crates that are linked into a package, in one text."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", host()]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout)
    packages = {entry["id"]: entry for entry in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found, open_ = set(), [next(id_ for id_, entry in packages.items() if entry["name"] == package)]
    while open_:
        id_ = open_.pop()
        if id_ not in found:
            found.add(id_)
            for dependency in nodes[id_]["deps"]:
                # Those of builds and tests are not linked.
                if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                    open_.append(dependency["pkg"])
    texts, without = [], []
    for entry in sorted((packages[id_] for id_ in found), key=lambda entry: (entry["name"], entry["version"])):
        if entry["source"] is None:
            continue
        name = f"{entry['name']} {entry['version']}: {entry['license'] or 'see below'}"
        files = sorted(Path(entry["manifest_path"]).parent.glob("*"))
        files = [path for path in files if path.is_file() and path.name.lower().startswith(_LICENSES)]
        if not files:
            without.append(name)
        for path in files:
            texts.append(f"{'=' * 80}\n{name}\n{path.name}\n\n{path.read_text(encoding='utf-8', errors='replace')}\n")
    head = [
        "Licenses of the crates that are linked into this program.\n",
        "These carry no text of their own; that of their license stands at others:\n",
        *(f"  {name}\n" for name in without),
        "\n",
    ]
    return "".join(head + texts).encode()


def host() -> str:
    """The target that the compiler builds for."""
    version = subprocess.run(["rustc", "-vV"], check=True, capture_output=True, text=True).stdout
    return next(line.removeprefix("host: ") for line in version.splitlines() if line.startswith("host: "))


def with_licenses(package: str, readme: str, files: dict[str, Path | bytes]) -> dict[str, Path | bytes]:
    """These files with what to read first, and the licenses of a package and of what is linked into it."""
    ours = {name: ROOT / name for name in ("LICENSE-MIT", "LICENSE-APACHE")}
    return {**files, **ours, "README.md": ROOT / readme, "LICENSES-OF-DEPENDENCIES.txt": licenses(package)}


def command_archive(target: Path, out: Path, version: str) -> Path:
    """The command with completions, manual pages and licenses."""
    name = "bowknot.exe" if platform.system() == "Windows" else "bowknot"
    files: dict[str, Path | bytes] = {
        f"bin/{name}": target / "shipped" / name,
        "CHANGELOG.md": ROOT / "CHANGELOG.md",
        **folder_files(target / "xtask/dist/completions", "completions/"),
        **folder_files(target / "xtask/dist/man", "share/man/man1/"),
    }
    path = out / f"bowknot-{version}-{system()}.tar.gz"
    archive(path, with_licenses("bowknot-cli", "crates/cli/README.md", files))
    return path


def library_archive(target: Path, out: Path, version: str) -> None:
    """The libraries for C with their header and example."""
    names = ("libbowknot_c.a", "libbowknot_c.so", "libbowknot_c.dylib", "bowknot_c.dll", "bowknot_c.dll.lib", "bowknot_c.lib")
    files: dict[str, Path | bytes] = {
        f"lib/{name}": target / "shipped" / name for name in names if (target / "shipped" / name).is_file()
    }
    files |= {
        "include/bowknot.h": ROOT / "crates/capi/include/bowknot.h",
        "examples/drape.c": ROOT / "crates/capi/examples/drape.c",
    }
    files = with_licenses("bowknot-capi", "crates/capi/README.md", files)
    archive(out / f"bowknot-c-{version}-{system()}.tar.gz", files)


def others(target: Path, out: Path, version: str, extension: Path) -> None:
    """The extension for Blender, the wheel, the page and the npm packages."""
    # Beside the archive of the command, the name says what the zip is.
    shutil.copy2(extension, out / extension.name.replace("bowknot-", "bowknot-blender-", 1))
    for wheel in (target / "wheels").glob(f"bowknot-{version}-*.whl"):
        shutil.copy2(wheel, out)
    archive(out / f"bowknot-web-{version}.tar.gz", folder_files(target / "web"))
    for name in ("bowknot", "bowknot-compat"):
        # As `npm pack` does: all is in a folder `package`.
        with tempfile.TemporaryDirectory() as place:
            packed = Path(place) / "package.tgz"
            archive(packed, folder_files(target / "npm" / name))
            shutil.copyfile(packed, out / f"npm-{name}-{version}.tgz")


def try_command(path: Path) -> None:
    """Unpacks the command as a user does, and runs it."""
    with tempfile.TemporaryDirectory() as place:
        with tarfile.open(path) as tar:
            tar.extractall(place, filter="data")
        folder = Path(place) / path.name.removesuffix(".tar.gz")
        program = next((folder / "bin").iterdir())
        run = [program, "run", "drape", "--scale", "0.2", "--frames", "30", "--check", "--out", f"{place}/run"]
        done = subprocess.run(run, cwd=place, capture_output=True, text=True)
        if done.returncode != 0 or "no intersection" not in done.stdout + done.stderr:
            raise SystemExit(f"{program.name} of {path.name} does not run: {done.stderr}")
        strange = [str(home).encode() for home in (ROOT, Path.home() / ".cargo") if str(home).encode() in program.read_bytes()]
        if strange:
            raise SystemExit(f"{program.name} has paths of this machine in it: {strange}")


def main() -> None:
    """Packs, tries and sums up."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--version", required=True)
    parser.add_argument("--target", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--blender", type=Path, help="the extension; without it, the command and the libraries alone")
    options = parser.parse_args()
    target, out, version = options.target, options.out, options.version
    command = command_archive(target, out, version)
    library_archive(target, out, version)
    try_command(command)
    if options.blender is not None:
        others(target, out, version, options.blender)
    files = sorted(path for path in out.iterdir() if path.is_file())
    sums = "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files)
    (out / "SHA256SUMS").write_text(sums, encoding="utf-8")
    for path in files:
        print(f"{path.stat().st_size:11,} bytes  {path.name}", file=sys.stderr)


main()
