"""Frames of a run as OBJ files, what `bowknot check` says of them, and figures of the motion itself."""

import json
import shutil
import subprocess

import numpy as np


def write_frames(scene, motion, folder):
    """One OBJ per frame; each body and obstacle is an object, by which the judge names it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    bodies = [body.shell() for body in scene.bodies]
    starts = np.cumsum([0] + [len(body.x) for body in bodies])
    for number, x in enumerate(motion):
        lines, first = [], 1
        parts = [(body, x[a:b]) for body, a, b in zip(bodies, starts, starts[1:], strict=False)]
        parts += [(obstacle, obstacle.x) for obstacle in scene.obstacles]
        for body, points in parts:
            lines.append(f"o {body.name}")
            lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
            lines += [f"f {a} {b} {c}" for a, b, c in (body.triangles + first).tolist()]
            first += len(points)
        (folder / f"{number:06}.obj").write_text("\n".join(lines) + "\n")


def judge(scene, command, folder, out):
    """The report of `bowknot check`; writes its table and, if anything intersects, its picture."""
    options = ["--paths", "--json", "--table", out / "judge.csv", "--picture", out / "first.png"]
    for obstacle in scene.obstacles:
        options += ["--obstacle", obstacle.name]
    # Exit code 1 says that something intersects.
    done = subprocess.run([command, "check", folder, *options], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"bowknot check {folder} ended with exit code {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def figures(scene, motion, report):
    """What the tables show of a run."""
    deepest = max(report["pairs"], key=lambda pair: pair["depth_m"], default=None)
    stretch = [largest_stretch(scene, motion[0], x) for x in motion]
    return {
        "frames": report["states"],
        "intersecting_frames": report["intersecting_states"],
        "pairs_per_100_frames": 100.0 * report["intersections"] / report["states"],
        "deepest_m": deepest["depth_m"] if deepest else 0.0,
        "deepest_between": " and ".join(deepest["parts"]) if deepest else "",
        "hints_between_frames": report["hints_between_frames"],
        "largest_stretch": max(stretch),
        "final_stretch": stretch[-1],
        "lowest_m": float(motion[:, :, 2].min()),
        "final_lowest_m": float(motion[-1][:, 2].min()),
        "final_highest_m": float(motion[-1][:, 2].max()),
    }


def largest_stretch(scene, start, x):
    """Largest length of an edge of a surface, relative to that at the start, where nothing is strained."""
    largest, first = 0.0, 0
    for body in (body.shell() for body in scene.bodies):
        edges = np.concatenate([body.triangles[:, k] for k in ([0, 1], [1, 2], [2, 0])])
        a, b = edges.T + first
        lengths = np.linalg.norm(x[a] - x[b], axis=1) / np.linalg.norm(start[a] - start[b], axis=1)
        largest, first = max(largest, float(lengths.max())), first + len(body.x)
    return largest
