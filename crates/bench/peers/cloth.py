#!/usr/bin/env python3
"""Runs the same falling sheet in NVIDIA Newton's VBD solver, on the CPU, and by `bowknot run`:
times, frames with intersections, and how far the sheet fell while nothing was in its way.

Newton's kernels are compiled the first time, which takes a minute and is not counted.
"""

import json
import sys

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import fall
import measure
import meshes
import results
import toolkit
import vbd
from fall import Fall, Motion
from measure import Times, median, number, with_spread

NAME = "cloth"
OURS = "Bowknot"

FULL = [Fall("ball", 32, 30, 1.0 / 60.0), Fall("needle", 32, 30, 1.0 / 60.0)]
QUICK = [Fall("needle", 20, 20, 1.0 / 60.0)]
SETTINGS = [vbd.PLAIN, vbd.FINE, vbd.CUT, vbd.WIDE]


def run_bowknot(scene, threads, folder):
    """Moves the sheet by `bowknot run` with its defaults."""
    out = folder / "run"
    setting.clear(out)
    options = ["--out", out, "--format", "npz", "--threads", threads, "--quiet"]
    setting.call([setting.program("bowknot"), "run", scene.write(folder), *options])
    with np.load(out / "frames.npz") as archive:
        sheets = archive["X"][:, : len(scene.sheet[0])]
    return Motion(sheets, *fall.read_steps(out / "stats.jsonl"))


class Judges:
    """Which frames intersect: by `bowknot check`, and by ipctk where it is installed."""

    def __init__(self, folder):
        self.file = folder / "frames.npz"
        try:
            self.ipctk = toolkit.start(1)
        except setting.PeerMissing as missing:
            print(f"frames are judged by Bowknot alone: {missing}")
            self.ipctk = None

    def count(self, scene, sheets):
        """Frames that intersect, by each judge; None for one that is not there."""
        frames = scene.archive(sheets, self.file)
        text = setting.call([setting.program("bowknot"), "check", self.file, "--json"], (0, 1))
        ours = sum(verdict["intersections"] > 0 for verdict in json.loads(text)["files"])
        theirs = None if self.ipctk is None else self._count(scene, frames)
        self.file.unlink()
        return ours, theirs

    def prove(self, scene):
        """Both must find a sheet that cuts through the obstacle, and nothing at the start."""
        start, _ = scene.sheet
        through = start - [0.0, 0.0, fall.DROP + 0.05]
        found = self.count(scene, np.stack([start, through]))
        if found[0] != 1 or found[1] not in (1, None):
            raise setting.Unusable(
                f"a sheet through the obstacle: judges count {found}, not 1 of 2"
            )

    def _count(self, scene, frames):
        with np.load(self.file) as archive:
            faces, held = archive["F"], archive["O"]
        mesh = toolkit.mesh_of(self.ipctk, frames[0], faces, held)
        return sum(self.ipctk.has_intersections(mesh, toolkit.positions(x)) for x in frames)


def describe(scene, motion, judges):
    """How the sheet moved."""
    heights = motion.sheets[..., 2]
    fell = float((heights[0] - heights[scene.flight]).mean())
    ours, theirs = judges.count(scene, motion.sheets)
    return {
        "intersecting": ours,
        "intersecting_by_ipctk": theirs,
        "fell_m": fell,
        "fell_share": fell / scene.fallen(scene.flight, motion.substeps),
        "lowest_m": float(heights.min()),
        "max_stretch": _max_stretch(scene, motion),
    }


def _max_stretch(scene, motion):
    points, faces = scene.sheet
    a, b = meshes.edges_of(faces).T
    rest = np.linalg.norm(points[a] - points[b], axis=1)
    return max(float((np.linalg.norm(x[a] - x[b], axis=1) / rest).max()) for x in motion.sheets)


def measure_scene(scene, threads, turns, folder):
    """A record for each solver: the last turn's motion, times of all turns."""
    judges = Judges(folder)
    judges.prove(scene)
    runs = {OURS: lambda: run_bowknot(scene, threads, folder)}
    for settings in SETTINGS:
        runs[settings.name] = lambda s=settings: vbd.run(scene, s, scene.frames)
    times, records = {name: Times() for name in runs}, {}

    def run(name):
        motion = runs[name]()
        times[name].add(sum(motion.cpu), sum(motion.wall))
        records[name] = describe(scene, motion, judges)
        print(f"{scene.name}: {name}, {times[name].cpu[-1]:.2f} CPU s, {records[name]}")

    measure.in_turn(lambda: run(OURS), lambda: [run(s.name) for s in SETTINGS], turns)
    for name, record in records.items():
        record.update(cpu_s=median(times[name].cpu), wall_s=median(times[name].wall))
        quotients = measure.ratios(times[name].cpu, times[OURS].cpu)
        record.update(cpu=with_spread(times[name].cpu), ratio=median(quotients))
        record["ratios"] = with_spread(quotients)
    common = {"scene": scene.name, "frames": scene.frames, "flight_frames": scene.flight}
    return [{**common, "solver": name, **record} for name, record in records.items()]


def table(records):
    columns = ["scene", "solver", "CPU s", "ratio", "frames that intersect", "by ipctk"]
    columns += ["fell in flight, mm", "of g h² n (n + 1)/2, %", "lowest point, mm", "stretch"]
    rows = []
    for r in records:
        by_ipctk = "" if r["intersecting_by_ipctk"] is None else str(r["intersecting_by_ipctk"])
        rows.append(
            [r["scene"], r["solver"], r["cpu"], "" if r["solver"] == OURS else r["ratios"]]
            + [str(r["intersecting"]), by_ipctk, number(1e3 * r["fell_m"])]
            + [
                number(100.0 * r["fell_share"]),
                number(1e3 * r["lowest_m"]),
                f"{r['max_stretch']:.3f}",
            ]
        )
    frames = f"{records[0]['frames']} frames of 1/60 s"
    return results.Table(f"{frames}: CPU seconds of all time steps.", columns, rows, plain=2)


def section(records, versions, threads, load_before):
    peers = [r for r in records if r["solver"] != OURS]
    ours = [r for r in records if r["solver"] == OURS]
    frames = sum(r["frames"] + 1 for r in ours)
    shares = [100.0 * r["fell_share"] for r in peers]
    arrived = [r for r in peers if r["fell_share"] > 0.5]
    crossing = [r for r in arrived if r["intersecting"]]
    worst = max((r["intersecting"] for r in crossing), default=0)
    ours_crossing = sum(r["intersecting"] for r in ours)
    ours_share = number(min(100.0 * r["fell_share"] for r in ours))
    least, most = number(min(shares)), number(max(shares))
    quotients = [r["ratio"] for r in arrived]
    cheapest, dearest = number(min(quotients)), number(max(quotients))
    runs, per_run, flight = len(arrived), ours[0]["frames"] + 1, ours[0]["flight_frames"]
    return results.Section(
        name=NAME,
        title="Falling cloth: NVIDIA Newton's VBD on the CPU",
        question="""One sheet, 1 m wide, falls 12 cm onto a ball of 25 cm radius or onto a
            needle: same mesh, masses, membrane, bending and frames. What does it cost, which
            frames intersect, and does the sheet fall as far as gravity says while it is in the
            air?""",
        finding=f"""Bowknot has {ours_crossing} intersecting frames of {frames} and falls
            {ours_share} % of the way; Newton has some in {len(crossing)} of the {runs} runs
            that reach the obstacle (up to {worst} of {per_run} frames) and falls {least} to
            {most} %, least with one step a frame, where its bound on motion stops it. The runs
            that reach the obstacle take {cheapest} to {dearest} times Bowknot's CPU time.""",
        tables=[table(records)],
        notes=f"""Seconds are of the time steps alone: no scene, files, nor compilation
            (Newton's kernels, up to a minute the first time). Newton is driven from Python,
            which launches compiled kernels; on a CPU they run on one thread and Newton is made
            for GPUs, so that its times say little about it there. Bowknot takes one implicit
            Euler step a frame with its defaults, a stretch limit of 1.1 among them, which
            Newton does not have. Newton's settings are those of its examples (contacts act at 2
            mm, pairs are sought 1.5 mm beyond, buffers twice the default) or, to raise its
            bound on motion, pairs to 12 mm with buffers of 512 and 1024; *cut at obstacles* is
            `rigid_soft_enable_dat`, off by default. Materials are alike, not equal: both
            membranes have the same Lame parameters at small strain, Newton's iterations do not
            reach the equilibrium of a step. *Fell in flight* is the mean over the sheet after
            {flight} frames, compared with implicit Euler of as many steps; most of what Bowknot
            lacks is its stopping rule, which counts a step as solved when no vertex is farther
            than 0.01 of an edge from where it should be. All frames, the start too, were judged
            by `bowknot check`, again by ipctk; both were first shown a sheet through the
            obstacle, and found it.""",
        conditions=measure.conditions(versions, f"{threads} thread", load_before),
    )


def main():
    parser = setting.arguments(__doc__, threads=None)
    options = parser.parse_args()
    # Newton's CPU kernels run on one thread; so does Bowknot here.
    threads = 1
    turns = options.turns or (1 if options.quick else 2)
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    versions = {
        "newton": setting.peer("newton").__version__,
        "warp": setting.peer("warp").__version__,
    }
    load_before = measure.load()
    records = []
    for scene in QUICK if options.quick else FULL:
        records += measure_scene(scene, threads, turns, folder)
    results.keep(section(records, versions, threads, load_before), records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
