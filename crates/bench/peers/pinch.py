#!/usr/bin/env python3
"""Holds a hanging cloth between two stiff pads for a minute by `bowknot run`, in rapier's soft bodies and in NVIDIA
Newton's VBD: how far the cloth creeps out of the grip, frames with intersections, times.
"""

import sys

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import frames
import measure
import results
import soft_runs
import vbd_pinch
from measure import number, plain
from soft_runs import Case, Program, Run

NAME = "pinch"
# Vertices along the cloth's upper edge: the scene files have the contact distance for this one.
SIZE = 17
FULL, QUICK = Case("pinch", SIZE, 60.0, every=10), Case("pinch", SIZE, 1.3, every=10)
# From when on the cloth is held by the pads alone and has swung out [s].
SETTLED = 1.0

OURS = Program("Bowknot", bowknot=True)
PROGRAMS = [
    OURS,
    Program("Bowknot, quick", ("--preset", "quick"), bowknot=True),
    Program("Bowknot, no sleep", ("--set", "solver.sleep.enabled=false"), bowknot=True),
    Program("Bowknot, sdirk2", ("--set", "simulation.integrator=sdirk2"), bowknot=True),
    Program("rapier"),
    Program("rapier, 16 substeps", ("--substeps", 16)),
    Program("rapier, 16 substeps, a fifth of the thickness", ("--substeps", 16, "--radius", 0.1)),
    Program("rapier, 64 substeps", ("--substeps", 64)),
]
NEWTON = [
    vbd_pinch.Settings("Newton, 4 steps of 10", 4, 10),
    vbd_pinch.Settings("Newton, 10 steps of 10, stiffer contacts, rings", 10, 10, 1.0e5, rings=1),
]
# Those that take minutes are left out of previews, and what differs from another one only later.
QUICK_PROGRAMS = [PROGRAMS[k] for k in (0, 1, 4, 5, 6)]


def run_newton(case, settings, folder):
    """The same meshes, contact distance and motion in Newton."""
    setting.clear(folder)
    folder.mkdir(parents=True, exist_ok=True)
    setting.call([setting.program("rapier"), "pinch", "--meshes", "--out", folder, "--size", case.size])
    interval = 0.01 * case.every
    cpu, wall, motion, faces = vbd_pinch.run(vbd_pinch.read_bodies(folder), settings, case.seconds, interval)
    np.savez(folder / "frames.npz", X=motion.x, F=faces)
    bad = frames.intersecting(folder / "frames.npz")
    setting.clear(folder)
    return Run(cpu, wall, motion, bad, interval)


def describe(run):
    """How far the part of the cloth that the pads hold has gone since `SETTLED`, and from there to the end [m]."""
    x, cloth = run.frames.x, run.frames.body == 0
    start = x[0]
    pads = start[~cloth]
    low, high = pads.min(axis=0), pads.max(axis=0)
    # Within the pads' faces; the cloth hangs in the plane between them.
    inside = cloth & ((start[:, 1:] > low[1:] - 1e-6) & (start[:, 1:] < high[1:] + 1e-6)).all(axis=1)
    settled = round(SETTLED / run.interval)
    heights = x[:, inside, 2].mean(axis=1)
    creep = float(heights[settled] - heights[-1])
    return {
        "frames": len(x),
        "intersecting": run.intersecting,
        "slipped_m": float(heights[0] - heights[settled]),
        "creep_m": creep,
        # The pads are 2 cm high: what has gone by as much is out of them.
        "holds": bool(abs(heights[0] - heights[-1]) < 0.02),
        "max_stretch": run.frames.largest_stretch(),
    }


def records_of(case, programs, newton, folder):
    runs = {p.name: (lambda p=p: soft_runs.run(case, p, folder / "run")) for p in programs}
    try:
        setting.peer("newton")
        runs |= {s.name: (lambda s=s: run_newton(case, s, folder / "run")) for s in newton}
    except setting.PeerMissing as missing:
        print(f"without Newton: {missing}")
    records = []
    for name, run in runs.items():
        done = run()
        record = {"program": name, "seconds": case.seconds, "cpu_s": done.cpu / case.seconds, **describe(done)}
        records.append(record)
        print(f"{name}: {record}", flush=True)
    return records


def table(records):
    columns = ["program", "seconds", "cpu_s_per_s", "slipped_before_mm", "creep_mm", "holds", "frames"]
    columns += ["intersecting_frames", "max_stretch"]
    rows = []
    for r in records:
        gone = [f"{1e3 * r[name]:.3f}" for name in ("slipped_m", "creep_m")] if r["holds"] else ["", ""]
        rows.append(
            [r["program"], plain(r["seconds"]), plain(r["cpu_s"]), *gone, "yes" if r["holds"] else "falls"]
            + [r["frames"], r["intersecting"], f"{r['max_stretch']:.3f}"]
        )
    return results.Table("peers-pinch", columns, rows)


def section(case, records, versions, load_before):
    def of(name):
        return [r for r in records if r["program"].startswith(name)]

    def creep(name):
        held = [abs(1e3 * r["creep_m"]) for r in of(name) if r["holds"]]
        fallen = len(of(name)) - len(held)
        ends = dict.fromkeys(number(creep) for creep in (min(held), max(held))) if held else ()
        text = f"{' to '.join(ends)} mm" if held else "no setting holds it"
        return text + (f" ({fallen} of {len(of(name))} settings let it fall)" if held and fallen else "")

    newton = f", in Newton {creep('Newton')}" if of("Newton") else ""
    bad = ", ".join(f"{r['program']} ({r['intersecting']} of {r['frames']})" for r in records if r["intersecting"])
    return results.Section(
        name=NAME,
        title="A cloth held between pads: rapier and Newton",
        question=f"""Two pads of rubber, 2 by 4 cm, hold a cloth of 16 by 24 cm by friction of 0.5 for
            {case.seconds:g} s: each is pressed by half a millimeter, far more than its weight needs. How far does the
            cloth creep out of the grip from {SETTLED:g} s on, when it should be at rest?""",
        finding=f"""By Bowknot the held part creeps by {creep("Bowknot")}, in rapier by {creep("rapier")}{newton}.
            {f"Frames intersect in {bad}." if bad else "No frame intersects."}""",
        caveats="""Friction at rest is regularized in different ways. Bowknot puts bodies at rest to sleep, which ends creep; a row has that switched off. Surfaces are as thick
            as each program makes them, and pads start 1 mm away from contact in each; in Newton contacts act at
            Bowknot's distance, by a penalty; one row has it ten times as stiff and leaves out pairs within one ring only. The
            cut of motion between soft bodies is on in both. Its held vertices are led by writing their positions, as in its examples.""",
        tables=[table(records)],
        conditions=measure.conditions(versions, "1 thread", load_before),
    )


def main():
    options = setting.arguments(__doc__, threads=None).parse_args()
    case = QUICK if options.quick else FULL
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    load_before = measure.load()
    chosen = (QUICK_PROGRAMS, NEWTON[:1]) if options.quick else (PROGRAMS, NEWTON)
    records = records_of(case, *chosen, folder)
    versions = {"rapier3d": soft_runs.version()}
    if any(r["program"].startswith("Newton") for r in records):
        versions["newton"] = setting.peer("newton").__version__
    results.keep(section(case, records, versions, load_before), records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
