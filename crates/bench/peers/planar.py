#!/usr/bin/env python3
"""Moves recorded states toward targets by ipctk's step filters (planar and isotropic) and by Bowknot's forward step:
share of the way after so many steps, steps for nearly all of it, time per step.

Targets are those that were recorded, which lie beyond what is in the way, and the states without intersections that
`bowknot resolve` makes of them.
"""

import json
import sys
from dataclasses import dataclass

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import measure
import meshes
import projection
import recorded
import results
import toolkit
from measure import Timer, Times, median, number, plain, spread

NAME = "planar"
MAX_STEPS = 40
# Steps after which the share of the way is shown, and the share that counts as nearly all of it.
SHOWN, NEARLY = (1, 4, 16), 0.95
# Largest remaining distance of a vertex that has arrived, and how far a vertex may go between two searches, in mean
# edge lengths: Bowknot's defaults.
TOLERANCE, RADIUS = 0.01, 0.35


@dataclass(frozen=True)
class Method:
    """How steps are made; radii in units of `RADIUS`."""

    name: str
    radius: float = 1.0
    isotropic: bool = False
    bowknot: bool = False


OURS = Method("Bowknot", bowknot=True)
METHODS = [
    OURS,
    Method("Bowknot, isotropic bound", isotropic=True, bowknot=True),
    Method("ipctk, planar filter"),
    Method("ipctk, planar filter, twice the radius", radius=2.0),
    Method("ipctk, isotropic filter", isotropic=True),
]


@dataclass
class Way:
    """The sum of all remaining distances before each step and at the end; what the steps took."""

    remaining: list
    largest: float
    searches: int
    cpu: float
    wall: float
    x: np.ndarray
    # The first step after which the state intersects, which is the last one; Bowknot's are checked at the end only.
    intersects: int | None


def walk_by_ipctk(problem, method, edge):
    """Steps by ipctk's trust region, searched anew when it asks for that."""
    ipctk = toolkit.start(1)
    mesh = toolkit.mesh_of(ipctk, problem["x"], problem["F"])
    x, y = toolkit.positions(problem["x"]), toolkit.positions(problem["y"])
    region = ipctk.ogc.TrustRegion(0.5 * method.radius * RADIUS * edge)
    collisions = ipctk.NormalCollisions()
    way = Way([_distances(y - x).sum()], np.inf, 0, 0.0, 0.0, x, None)
    region.should_update_trust_region = True
    while len(way.remaining) <= MAX_STEPS and way.largest > TOLERANCE * edge:
        timer = Timer()
        way.searches += region.should_update_trust_region
        region.update_if_needed(mesh, x, collisions)
        dx = toolkit.positions(y - x)
        (region.filter_step if method.isotropic else region.planar_filter_step)(mesh, x, dx)
        x = toolkit.positions(x + dx)
        way.cpu, way.wall = way.cpu + timer.cpu(), way.wall + timer.wall()
        left = _distances(y - x)
        way.largest = float(left.max())
        way.remaining.append(left.sum())
        if ipctk.has_intersections(mesh, x):
            way.intersects = len(way.remaining) - 1
            break
    way.x = x
    return way


def walk_by_bowknot(problem, path, method, edge, folder):
    """Steps by `Forward`."""
    result = folder / "forward.f64"
    options = ["--radius", method.radius * RADIUS * edge, "--tolerance", TOLERANCE * edge]
    options += ["--max-steps", MAX_STEPS, "--positions", result, *["--isotropic"][: method.isotropic]]
    report = json.loads(setting.call([setting.program("peer_forward"), path, *options]))
    x = np.fromfile(result, "<f8").reshape(-1, 3)
    ipctk = toolkit.start(1)
    mesh = toolkit.mesh_of(ipctk, problem["x"], problem["F"])
    ends = ipctk.has_intersections(mesh, toolkit.positions(x))
    steps = len(report["remaining"]) - 1
    times = report["cpu"], report["wall"]
    return Way(report["remaining"], report["largest_remaining"], report["searches"], *times, x, steps if ends else None)


def _distances(difference):
    return np.linalg.norm(difference, axis=1)


def describe(way, y, edge):
    """Shares are of the sum over all vertices."""
    shares = 1.0 - np.array(way.remaining) / way.remaining[0]
    nearly = np.flatnonzero(shares >= NEARLY)
    return {
        "steps": len(shares) - 1,
        "searches": way.searches,
        "shares": [float(shares[min(step, len(shares) - 1)]) for step in SHOWN],
        "steps_to_nearly": int(nearly[0]) if len(nearly) else None,
        "arrived_share": float((_distances(y - way.x) <= TOLERANCE * edge).mean()),
        "intersects": way.intersects,
    }


def measure_problem(recording, out, turns, folder):
    """One record per method and target."""
    problem, path = projection.problem_of(recording, out, folder)
    edge = meshes.mean_edge(problem["x"], problem["F"])
    _, reached = projection.resolve(path, projection.DELTA * edge, "Bowknot, contacts alone", 1, folder)
    resolved = {**problem, "y": reached}
    resolved_path = folder / f"{recording.scene}-resolved.npz"
    np.savez(resolved_path, **resolved)
    mine, theirs = ([m for m in METHODS if m.bowknot == ours] for ours in (True, False))
    records = []
    for target, case, file in (("recorded", problem, path), ("resolved", resolved, resolved_path)):
        times, described = {m.name: Times() for m in METHODS}, {}

        def run(method, case=case, file=file, times=times, described=described):
            if method.bowknot:
                way = walk_by_bowknot(case, file, method, edge, folder)
            else:
                way = walk_by_ipctk(case, method, edge)
            steps = len(way.remaining) - 1
            times[method.name].add(way.cpu / steps, way.wall / steps)
            described[method.name] = describe(way, case["y"], edge)

        measure.in_turn(lambda r=run: [r(m) for m in mine], lambda r=run: [r(m) for m in theirs], turns)
        base = times[OURS.name].cpu
        for method in METHODS:
            cpu = times[method.name].cpu
            record = {"problem": recording.name, "target": target, "method": method.name, **described[method.name]}
            record["vertices"] = len(problem["x"])
            record.update(cpu_s=median(cpu), cpu=spread(cpu), ratios=spread(measure.ratios(cpu, base)))
            records.append(record)
            print(
                f"{recording.name}, {target}: {method.name}, {record['cpu_s']:.4f} CPU s per step, {described[method.name]}"
            )
    return records


def table(records):
    columns = ["problem", "target", "method", "vertices", "cpu_s_per_step", "ratio"]
    columns += [f"way_percent_{step}" for step in SHOWN]
    columns += ["steps_to_95_percent", "arrived_percent", "steps", "searches", "intersects_from_step"]
    rows = []
    for r in records:
        nearly = f"more than {r['steps']}" if r["steps_to_nearly"] is None else r["steps_to_nearly"]
        rows.append(
            [r["problem"], r["target"], r["method"], r["vertices"], r["cpu"]]
            + ["" if r["method"] == OURS.name else r["ratios"], *(plain(100.0 * share) for share in r["shares"])]
            + [nearly, plain(100.0 * r["arrived_share"]), r["steps"], r["searches"]]
            + ["" if r["intersects"] is None else r["intersects"]]
        )
    return results.Table("peers-planar", columns, rows)


def section(records, versions, load_before):
    def of(method):
        return [r for r in records if r["method"] == method.name]

    def shares(method, place):
        values = [100.0 * r["shares"][place] for r in of(method)]
        return f"{number(min(values))} to {number(max(values))} %"

    def intersects(method):
        steps = [r["intersects"] for r in of(method) if r["intersects"] is not None]
        first = f", from step {min(steps)} on at the earliest" if steps else ""
        return f"in {len(steps)} of {len(of(method))} runs{first}"

    _, _, planar, twice, isotropic = METHODS
    per_step = [a["cpu_s"] / b["cpu_s"] for a, b in zip(of(planar), of(OURS), strict=True)]
    later = SHOWN[-1]
    return results.Section(
        name=NAME,
        title="The forward step: ipctk's planar filter",
        question="""How far does a step go that is limited by planes between near pairs? ipctk's filter is *Planar-DAT*
            (Divide and Truncate, Chen et al. 2026, arXiv 2604.15513); its isotropic one is that of offset geometric
            contact. From recorded states all vertices go straight to recorded targets, or to states without
            intersections that were made of these.""",
        finding=f"""The first step goes {shares(OURS, 0)} of the way by Bowknot's forward step, {shares(planar, 0)} by
            ipctk's planar filter with as large a radius per vertex, {shares(twice, 0)} with twice that, and
            {shares(isotropic, 0)} by its isotropic filter. After {later} steps it is {shares(OURS, -1)},
            {shares(planar, -1)}, {shares(twice, -1)} and {shares(isotropic, -1)}. A step of the planar filter with its
            searches takes {number(min(per_step))} to {number(max(per_step))} times Bowknot's CPU time. States intersect
            by the planar filter {intersects(planar)}, with twice the radius {intersects(twice)}, by the isotropic
            filter {intersects(isotropic)}, and by Bowknot {intersects(OURS)}.""",
        caveats=f"""What differs: both put a plane between the closest points of each near pair, nearer to the side that
            moves less, and stop vertices at nine tenths of the way to it; but Bowknot's planes bound a slab whose
            width is certified with rounding, and whose pair is held above what rounding can resolve, so that a gap
            that is pressed on cannot shrink until rounding decides. It searches anew as soon as one vertex meets its
            ball, ipctk when one in a hundred is held. Runs end at {MAX_STEPS} steps or when a state
            intersects; one that ends early keeps its last share. Nothing presses back here: a solver
            with contact forces, as those that the filter is made for, would not press on for so long, and moves its
            targets. ipctk is called from Python; its searches and filters are compiled.""",
        tables=[table(records)],
        conditions=measure.conditions(versions, "1 thread", load_before),
    )


def main():
    options = setting.arguments(__doc__, threads=None).parse_args()
    turns = options.turns or (1 if options.quick else 5)
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    versions = {"ipctk": setting.peer("ipctk").__version__}
    load_before, records = measure.load(), []
    for recording in recorded.QUICK[:1] if options.quick else recorded.FULL:
        records += measure_problem(recording, options.out, turns, folder)
    results.keep(section(records, versions, load_before), records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
