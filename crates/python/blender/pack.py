# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the extension for Blender: `python pack.py OUT WHEEL..` writes a zip with the wheels, one or several.

The manifest in the zip names the wheels, and the platforms that they are for.
"""

from __future__ import annotations

import re
import sys
import zipfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "bowknot_blender"
MANIFEST = "blender_manifest.toml"

#: Blender's names of platforms, by what the names of wheels end with.
PLATFORMS = (
    (r"(manylinux|linux)\w*_x86_64", "linux-x64"),
    (r"(manylinux|linux)\w*_aarch64", "linux-arm64"),
    (r"win_amd64", "windows-x64"),
    (r"win_arm64", "windows-arm64"),
    (r"macosx\w*_arm64", "macos-arm64"),
    (r"macosx\w*_x86_64", "macos-x64"),
)

#: The same bytes in give the same bytes out: no time of the clock goes into the zip.
_TIME = (2026, 1, 1, 0, 0, 0)


def platform_of(wheel: Path) -> str:
    """Blender's name of the platform of a wheel."""
    tags = wheel.stem.split("-")[-1].split(".")
    for pattern, platform in PLATFORMS:
        if any(re.fullmatch(pattern, tag) for tag in tags):
            return platform
    raise SystemExit(f"{wheel.name}: Blender has no platform {tags[0]}")


def manifest(wheels: list[Path]) -> str:
    """The manifest with the wheels and their platforms, ahead of its tables."""
    platforms = sorted({platform_of(wheel) for wheel in wheels})
    versions = {wheel.name.split("-")[1] for wheel in wheels}
    text = (FOLDER / MANIFEST).read_text(encoding="utf-8")
    version = re.search(r'^version = "(.*)"$', text, re.MULTILINE).group(1)
    if versions != {version}:
        raise SystemExit(
            f"{MANIFEST}: version {version}, but the wheels have {', '.join(sorted(versions))}: make them agree"
        )
    own = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in sorted(wheels))
    names = ", ".join(f'"{platform}"' for platform in platforms)
    return text.replace("[permissions]", f"platforms = [{names}]\nwheels = [\n{own}]\n\n[permissions]", 1)


def pack(out: Path, wheels: list[Path]) -> Path:
    """Writes the zip into a folder; its path."""
    text = manifest(wheels)
    version = re.search(r'^version = "(.*)"$', text, re.MULTILINE).group(1)
    platforms = sorted({platform_of(wheel) for wheel in wheels})
    suffix = f"-{platforms[0]}" if len(platforms) == 1 else ""
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"bowknot-{version}{suffix}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        _add(archive, MANIFEST, text.encode())
        for file in sorted(FOLDER.rglob("*")):
            name = file.relative_to(FOLDER).as_posix()
            if file.suffix == ".py" or name == "LICENSE":
                _add(archive, name, file.read_bytes())
        for wheel in sorted(wheels):
            _add(archive, f"wheels/{wheel.name}", wheel.read_bytes())
    return path


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    archive.writestr(zipfile.ZipInfo(name, _TIME), content, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    print(pack(Path(sys.argv[1]), [Path(given) for given in sys.argv[2:]]))
