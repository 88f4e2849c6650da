#!/usr/bin/env python3
"""Drops 50 sheets on a cylinder, from which they slide to the ground, by `bowknot run`: CPU seconds per time step and
per simulated second, beside those that the paper of offset geometric contact gives for such a scene.

The paper's program is not run: its times are quoted.
"""

import os
import sys
from dataclasses import dataclass
from pathlib import Path

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import fall
import frames
import measure
import results
from measure import number, plain

NAME = "layers"
SIDE = 1.0
RADIUS, LENGTH = 0.2, 1.4
# The sheets lie so far apart and above the cylinder [m], and off its axis, so that they slide down to one side.
GAP, ASIDE = 0.01, 0.25
GROUND = -0.8
DT = 0.01
# Chen et al. 2025, "Offset Geometric Contact", Table 1 and Section 5: 0.21 s and at most 0.55 s of wall time per time
# step on an AMD Ryzen 7950X of 16 cores, 6.3 and 11.5 ms on an NVIDIA RTX 4090.
PAPER_DT, PAPER_ITERATIONS = 1.0 / 1200.0, 40
PAPER = [
    ("OGC, as published: AMD Ryzen 7950X, 16 cores", 0.21, 0.55),
    ("OGC, as published: NVIDIA RTX 4090", 6.3e-3, 11.5e-3),
]


@dataclass(frozen=True)
class Layers:
    """So many sheets of `side_vertices` squared vertices; the paper has 246,000 vertices and 475,000 triangles."""

    count: int = 50
    side_vertices: int = 70
    seconds: float = 1.0

    @property
    def vertices(self):
        return self.count * self.side_vertices**2

    @property
    def triangles(self):
        return 2 * self.count * (self.side_vertices - 1) ** 2

    def write(self, path):
        """A scene file without other files."""
        random = np.random.default_rng(50)
        edge = SIDE / (self.side_vertices - 1)
        lines = [f'[simulation]\nname = "layers"\ndt = {DT!r}\nframes = {round(self.seconds / DT)}\n']
        for k in range(self.count):
            along, aside, turn = random.uniform(-1.0, 1.0, 3) * [0.02, 0.05, 5.0] + [0.0, ASIDE, 0.0]
            place = f"[{along:.4f}, {aside:.4f}, {RADIUS + GAP * (k + 1):.4f}]"
            lines.append(
                f'[[body]]\nname = "sheet{k}"\nshape = {{ type = "sheet", size = [{SIDE}, {SIDE}], edge = {edge!r} }}\n'
                f"rotate = [0, 0, {turn:.3f}]\ntranslate = {place}\nfriction = 0.2\n"
            )
        lines.append(
            f'[[obstacle]]\nname = "cylinder"\nshape = {{ type = "tube", radius = {RADIUS}, length = {LENGTH} }}\n'
            "friction = 0.2\n"
        )
        lines.append(
            f'[[obstacle]]\nname = "ground"\nshape = {{ type = "half-space" }}\ntranslate = [0, 0, {GROUND}]\n'
            "friction = 0.2\n"
        )
        path.write_text("\n".join(lines), encoding="utf-8")
        return path


def run_bowknot(layers, preset, threads, folder):
    """CPU and wall seconds of the time steps, and the number of frames that intersect."""
    out = folder / "run"
    setting.clear(out)
    scene = layers.write(folder / "layers.toml")
    options = ["--out", out, "--threads", threads, "--preset", preset, "--quiet"]
    setting.call([setting.program("bowknot"), "run", scene, *options])
    cpu, wall = fall.read_steps(out / "stats.jsonl")
    intersecting = frames.intersecting(out / "frames")
    setting.clear(out)
    return np.array(cpu), np.array(wall), intersecting


def records_of(layers, threads, folder):
    """One record per setting of Bowknot and per figure of the paper."""
    records = []
    for preset, name in (("fast", "Bowknot"), ("quick", "Bowknot, quick")):
        cpu, wall, intersections = run_bowknot(layers, preset, threads, folder)
        record = {"program": name, "steps": len(cpu), "dt": DT, "intersections": intersections}
        record |= {
            "cpu_mean_s": cpu.mean(),
            "cpu_max_s": cpu.max(),
            "wall_mean_s": wall.mean(),
            "wall_max_s": wall.max(),
        }
        records.append(record)
        print(f"{name}: {record}", flush=True)
    for name, mean, largest in PAPER:
        records.append({"program": name, "dt": PAPER_DT, "wall_mean_s": mean, "wall_max_s": largest})
    return records


def table(layers, records):
    columns = ["program", "vertices", "triangles", "time_step_s", "cpu_s_per_step", "cpu_s_per_step_max"]
    columns += ["wall_s_per_step", "wall_s_per_step_max", "wall_s_per_s"]
    rows = []
    for r in records:
        ours = "cpu_mean_s" in r
        sizes = [layers.vertices, layers.triangles] if ours else ["246000", "475000"]
        cpu = [plain(r["cpu_mean_s"]), plain(r["cpu_max_s"])] if ours else ["", ""]
        wall = [plain(r["wall_mean_s"]), plain(r["wall_max_s"]), plain(r["wall_mean_s"] / r["dt"])]
        rows.append([r["program"], *sizes, plain(r["dt"]), *cpu, *wall])
    return results.Table("peers-layers", columns, rows)


def section(layers, records, threads, load_before):
    ours, quick = records[:2]
    published, device = records[2:]
    per_second = {r["program"]: number(r["wall_mean_s"] / r["dt"]) for r in records}
    bad = ours["intersections"] or quick["intersections"]
    clear = "Some frames intersect." if bad else "No frame intersects."
    return results.Section(
        name=NAME,
        title="50 layers of cloth: offset geometric contact, as published",
        question=f"""{layers.count} sheets, {layers.vertices:,} vertices and {layers.triangles:,} triangles, fall on a
            cylinder and slide to the ground, a scene of the paper on offset geometric contact (Chen et al. 2025). What
            does the first {layers.seconds:g} s cost?""",
        finding=f"""A time step of 1/100 s takes Bowknot {number(ours["cpu_mean_s"])} CPU seconds, at most
            {number(ours["cpu_max_s"])}, and *quick* {number(quick["cpu_mean_s"])}. The paper gives
            {number(published["wall_mean_s"])} s of 16 cores and {number(1e3 * device["wall_mean_s"])} ms of an RTX 4090
            for a time step of 1/1200 s. Per simulated second these are {per_second[ours["program"]]} s on {threads}
            threads here, {per_second[quick["program"]]} s (*quick*), {per_second[published["program"]]} s and
            {per_second[device["program"]]} s. {clear}""",
        caveats=f"""The stopping rules differ: the paper makes {PAPER_ITERATIONS} iterations of vertex block descent in
            each step, whatever is left of the residual; Bowknot iterates until its tolerances hold. So do the
            machines, and what is averaged: the paper's times are over its whole animation, with the pile on the
            ground, these over the time that is named. The paper does not say how large and how far apart the sheets
            are: these are 1 m wide, {1e3 * GAP:g} mm apart, of cotton, 0.5 % fewer vertices. Its table gives 1M vertices
            and 1.96M primitives for the scene, the project's page 246K vertices and 475K triangles, with the same
            times. The paper's program was not run.""",
        tables=[table(layers, records)],
        conditions=measure.conditions({"offset geometric contact": "as published"}, f"{threads} threads", load_before),
    )


def main():
    parser = setting.arguments(__doc__, threads=None)
    parser.add_argument("--layers", type=int, help="number of sheets [default: 50, quick 6]")
    parser.add_argument("--side", type=int, help="vertices along a side [default: 70, quick 12]")
    parser.add_argument("--seconds", type=float, help="simulated time [default: 1, quick 0.5]")
    parser.add_argument("--write", type=Path, metavar="FILE.toml", help="write the scene file and end")
    options = parser.parse_args()
    base = Layers(6, 12, 0.5) if options.quick else Layers()
    layers = Layers(options.layers or base.count, options.side or base.side_vertices, options.seconds or base.seconds)
    if options.write:
        layers.write(options.write)
        return
    threads = os.cpu_count()
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    load_before = measure.load()
    records = records_of(layers, threads, folder)
    results.keep(section(layers, records, threads, load_before), records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
