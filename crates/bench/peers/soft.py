#!/usr/bin/env python3
"""Runs five scenes in rapier's soft bodies and by `bowknot run`, both in several settings: times, frames with
intersections, stretch, free fall, the speed on a slope, and whether a stack comes to rest.
"""

import math
import sys

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import measure
import results
import soft_runs
from measure import Kept, median, number, plain, spread
from soft_runs import Case, Program

NAME = "soft"
FULL = [
    Case("ball", 51, 1.0),
    Case("ball", 101, 1.0),
    Case("sheets", 31, 1.0),
    Case("ribbon", 13, 3.5),
    Case("slope", 7, 1.0),
    Case("stack", 7, 2.0),
]
QUICK = [
    Case("ball", 15, 0.4),
    Case("sheets", 9, 0.3),
    Case("ribbon", 5, 3.5, every=5),
    Case("slope", 4, 1.0),
    Case("stack", 4, 1.0),
]

OURS = Program("Bowknot", bowknot=True)
BOWKNOT = [
    OURS,
    Program("Bowknot, quick", ("--preset", "quick"), bowknot=True),
    Program("Bowknot, sdirk2", ("--set", "simulation.integrator=sdirk2"), bowknot=True),
    Program("Bowknot, half the time step", dt=0.005, bowknot=True),
]
MANY = Program("rapier, 64 substeps", ("--substeps", 64))
# What its constructors and `IntegrationParameters` choose, then more of what its documentation names for accuracy.
RAPIER = [
    Program("rapier"),
    Program("rapier, 16 substeps", ("--substeps", 16)),
    MANY,
    Program("rapier, a fifth of the thickness", ("--radius", 0.1)),
    Program("rapier, 16 substeps, a fifth of the thickness", ("--substeps", 16, "--radius", 0.1)),
    Program("rapier, half the time step", dt=0.005),
]
CLOTH_ALONE = [
    Program("rapier, edge speculation and crossing repulsion", ("--recovery",)),
    Program("rapier, edges of 30 Hz", ("--edge-hz", 30)),
]
SOLID_ALONE = [
    Program("rapier, neo-Hookean cells", ("--neo-hookean",)),
    Program("rapier, finite elements", ("--fem",)),
]

GRAVITY, TILT, FRICTION = 9.81, math.radians(20.0), 0.3
FALL_S = 0.1
# A vertex that stays within so much of its last place is at rest [m].
REST = 1.0e-4


def programs(case):
    """The programs that run a scene; a large one only those that do not take many minutes."""
    if case.scene == "ball" and case.size > 51:
        return BOWKNOT[:2], RAPIER[:2]
    alone = SOLID_ALONE if case.scene in ("slope", "stack") else CLOTH_ALONE
    left_out = MANY if case in QUICK or case.scene in ("sheets", "ribbon") else None
    return BOWKNOT, [p for p in RAPIER + alone if p is not left_out]


def describe(case, run):
    """Quantities of the motion; those that a scene does not have are None."""
    frames, record = run.frames, {"frames": len(run.frames.x), "intersecting": run.intersecting}
    record["max_stretch"] = frames.largest_stretch()
    record |= dict.fromkeys(["fall_error_m", "slope_speed_share", "slope_growth_share", "rest_s", "height_share"])
    if case.scene == "ball":
        frame = round(FALL_S / run.interval)
        heights = frames.x[..., 2].mean(axis=1)
        record["fall_error_m"] = float(heights[0] - heights[frame]) - 0.5 * GRAVITY * FALL_S**2
    elif case.scene == "slope":
        speed, growth = _slide(frames.x, run.interval)
        record.update(slope_speed_share=float(speed) - 1.0, slope_growth_share=float(growth) - 1.0)
    elif case.scene == "stack":
        record["rest_s"] = frames.rests_from(run.interval, REST)
        top = frames.x[..., 2].max(axis=1)
        record["height_share"] = float(top[-1] / top[0])
    return record


def _slide(x, interval):
    """Speed down the slope at the end of the run, and its growth over the second half, both relative to theory: an
    acceleration of g (sin t - mu cos t) from the start on."""
    theory = GRAVITY * (math.sin(TILT) - FRICTION * math.cos(TILT))
    down = x.mean(axis=1) @ np.array([math.cos(TILT), 0.0, -math.sin(TILT)])
    speeds = np.diff(down) / interval
    count = max(len(speeds) // 10, 1)
    early, late = speeds[5 * count : 6 * count].mean(), speeds[9 * count : 10 * count].mean()
    return late / (theory * 9.5 * count * interval), (late - early) / (theory * 4.0 * count * interval)


def measure_case(case, turns, folder, kept):
    """One record per program: the motion of the last turn, times of all turns."""
    ours, theirs = programs(case)
    times, records = {p.name: [] for p in ours + theirs}, {}

    def measured(program):
        done = soft_runs.run(case, program, folder / "run")
        record = describe(case, done)
        print(f"{case.name}: {program.name}, {done.cpu:.2f} CPU s, {record}", flush=True)
        return {"cpu": done.cpu, "record": record}

    def run(program):
        turn = len(times[program.name])
        found = kept.get(f"{case.name}: {program.name}, turn {turn}", lambda: measured(program))
        times[program.name].append(found["cpu"] / case.seconds)
        records[program.name] = dict(found["record"])

    measure.in_turn(lambda: [run(p) for p in ours], lambda: [run(p) for p in theirs], turns)
    base = times[OURS.name]
    for name, record in records.items():
        record.update(cpu_s=median(times[name]), cpu=spread(times[name]))
        record["ratios"] = spread(measure.ratios(times[name], base))
    common = {"scene": case.scene, "size": case.size, "seconds": case.seconds}
    return [{**common, "solver": p.name, **records[p.name]} for p in ours + theirs]


def table(records):
    columns = ["scene", "size", "solver", "cpu_s_per_s", "ratio", "frames", "intersecting_frames"]
    columns += ["max_stretch", "fall_error_mm", "slope_speed_error_percent", "slope_acceleration_error_percent"]
    columns += ["rest_from_s", "height_percent"]
    rows = []
    for r in records:
        fall = "" if r["fall_error_m"] is None else plain(round(1e3 * r["fall_error_m"], 3))
        slope = growth = ""
        if r["slope_speed_share"] is not None:
            slope, growth = (_percent(r[name]) for name in ("slope_speed_share", "slope_growth_share"))
        rest = height = ""
        if r["height_share"] is not None:
            rest = "moves" if r["rest_s"] is None else plain(r["rest_s"])
            height = plain(100.0 * r["height_share"])
        rows.append(
            [r["scene"], r["size"], r["solver"], r["cpu"], "" if r["solver"] == OURS.name else r["ratios"]]
            + [r["frames"], r["intersecting"], f"{r['max_stretch']:.3f}", fall, slope, growth, rest, height]
        )
    return results.Table("peers-soft", columns, rows)


def _percent(share):
    # The sum turns a negative zero into a zero.
    return f"{round(100.0 * share, 1) + 0.0:.1f}"


def _range(values):
    return f"{number(min(values))} to {number(max(values))}"


def section(records, versions, load_before, commits):
    mine = [r for r in records if r["solver"].startswith("Bowknot")]
    theirs = [r for r in records if not r["solver"].startswith("Bowknot")]

    def fall(rows):
        return _range([round(abs(1e3 * r["fall_error_m"]), 3) for r in rows if r["fall_error_m"] is not None])

    def slope(rows, name):
        shares = [r[name] for r in rows if r[name] is not None]
        return f"{_percent(min(shares))} to {_percent(max(shares))} %"

    def bad(rows):
        return sum(r["intersecting"] > 0 for r in rows), len(rows), max(r["intersecting"] for r in rows)

    base = {(r["scene"], r["size"]): r["cpu_s"] for r in mine if r["solver"] == OURS.name}
    plain_rows = [r for r in theirs if r["solver"] == "rapier"]
    quotients = [r["cpu_s"] / base[r["scene"], r["size"]] for r in plain_rows]
    faster = sum(r["cpu_s"] < base[r["scene"], r["size"]] for r in theirs)
    moving = {
        name: sum(r["height_share"] is not None and r["rest_s"] is None for r in rows)
        for name, rows in (("ours", mine), ("theirs", theirs))
    }
    ours_bad, ours_runs, _ = bad(mine)
    theirs_bad, theirs_runs, worst = bad(theirs)
    return results.Section(
        name=NAME,
        title="Soft bodies: rapier",
        question="""Cloth on a ball, five sheets on a ball, a ribbon that is twisted until it coils, a cube of jelly on
            a slope, a stack of five cubes. What do rapier's soft bodies and Bowknot cost per simulated second, each in
            several settings, and what is wrong with the motion?""",
        finding=f"""Bowknot has intersecting frames in {ours_bad} of {ours_runs} runs, rapier in {theirs_bad} of
            {theirs_runs}, up to {worst} frames. With the defaults of both, rapier takes {_range(quotients)} times
            Bowknot's CPU time; {faster} of rapier's {theirs_runs} runs take less than Bowknot's defaults. Edges are
            stretched to at most {_range([r["max_stretch"] for r in mine])} times their length by Bowknot's settings,
            {_range([r["max_stretch"] for r in theirs])} by rapier's. After {FALL_S:g} s in free fall Bowknot is off by
            {fall(mine)} mm, rapier by {fall(theirs)} mm. The speed on the slope is off by
            {slope(mine, "slope_speed_share")} and {slope(theirs, "slope_speed_share")}, its growth in the second half,
            without the landing, by {slope(mine, "slope_growth_share")} and {slope(theirs, "slope_growth_share")}. The stack still
            moves at the end in {moving["ours"]} of Bowknot's runs and in {moving["theirs"]} of rapier's.""",
        caveats="""Rapier computes in single precision and its cloth is of springs, so its material cannot equal
            Bowknot's; the stiffness along a side does. Bowknot's cloth has a stretch limit of 1.05, rapier's none.
            Its own default, springs of 30 Hz, is a row as well. Its constructors make a sheet as thick as its edges are
            long, which keeps layers apart and makes piles thick;
            rows with a fifth of that come near the distance that Bowknot keeps. It integrates by substeps, Bowknot by
            one implicit step per frame, which costs Bowknot accuracy in free fall; rows with half the time step and
            with a method of second order say how much. Bodies at rest fall asleep in both. Ball and ground are analytic
            for rapier, and frames are judged against a ball mesh that lies within; ground and slope are not judged. Rapier
            is made for scenes with rigid bodies and joints at interactive rates, of which nothing is measured here, nor its threads.""",
        tables=[table(records)],
        conditions=measure.conditions(versions, "1 thread", load_before, commits),
    )


def main():
    options = setting.arguments(__doc__, threads=None).parse_args()
    turns = options.turns or 1
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    load_before, records = measure.load(), []
    kept = Kept(folder / "kept.json")
    for case in QUICK if options.quick else FULL:
        records += measure_case(case, turns, folder, kept)
    versions = {"rapier3d": soft_runs.version()}
    results.keep(section(records, versions, load_before, kept.commits), records, folder)
    kept.clear()


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
