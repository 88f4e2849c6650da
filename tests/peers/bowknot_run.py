"""Bowknot's command, on the scene files in `bowknot_scenes`."""

import pathlib
import shutil
import subprocess

import numpy as np

SCENES = pathlib.Path(__file__).with_name("bowknot_scenes")
EXAMPLES = {name: f"bowknot_scenes/{name}.toml" for name in ("drape", "twist", "blocks")}


def version(command):
    return subprocess.run([command, "--version"], check=True, capture_output=True, text=True).stdout.strip()


def simulate(scene, command, folder):
    """Runs the scene in the folder and yields the positions of all surfaces frame by frame."""
    shutil.copyfile(SCENES / f"{scene.name}.toml", folder / "scene.toml")
    for body in [*scene.bodies, *scene.obstacles]:
        if body.tets is None:
            write_mesh(folder / f"{body.name}.obj", body)
        else:
            write_solid(folder / f"{body.name}.msh", body)
    run = folder / "run"
    shutil.rmtree(run, ignore_errors=True)
    options = ["--frames", str(scene.frames), "--out", run, "--threads", "1", "--quiet"]
    subprocess.run([command, "run", folder / "scene.toml", *options], check=True)
    for path in sorted((run / "frames").glob("*.ply")):
        yield read_bodies(path, [len(body.outside()) for body in scene.bodies])


def write_mesh(path, body):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in body.x.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (body.triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


def write_solid(path, body):
    """Gmsh's format 2.2."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(body.x))]
    lines += [f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(body.x.tolist(), 1)]
    lines += ["$EndNodes", "$Elements", str(len(body.tets))]
    lines += [f"{k} 4 0 {a} {b} {c} {d}" for k, (a, b, c, d) in enumerate((body.tets + 1).tolist(), 1)]
    path.write_text("\n".join([*lines, "$EndElements", ""]))


def read_bodies(path, counts):
    """Vertices of the bodies of a PLY frame, in the order of the bodies and of their meshes. Frames hold surfaces."""
    content = path.read_bytes()
    header, _, data = content.partition(b"end_header\n")
    count = next(int(line.split()[2]) for line in header.splitlines() if line.startswith(b"element vertex"))
    kind = np.dtype([("x", "<f8", 3), ("obstacle", "u1"), ("body", "<i4")])
    vertices = np.frombuffer(data[: count * kind.itemsize], kind)
    parts = [vertices["x"][vertices["body"] == k] for k in range(len(counts))]
    if [len(part) for part in parts] != counts:
        raise ValueError(f"{path}: bodies of {[len(part) for part in parts]} vertices, not of {counts}")
    return np.concatenate(parts)
