#!/usr/bin/env python3
"""Moves recorded states toward targets by ipctk's step filters (planar and isotropic) and by Bowknot's forward step:
share of the way per step, steps until arrival, time.

Targets are those that were recorded, which lie behind obstacles, and states without intersections, which can be
reached.
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
MAX_STEPS = 200
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
    # Steps after which the state intersects; Bowknot's are checked at the end only.
    intersecting: int


def walk_by_ipctk(problem, method, edge):
    """Steps by ipctk's trust region, searched anew when it asks for that."""
    ipctk = toolkit.start(1)
    mesh = toolkit.mesh_of(ipctk, problem["x"], problem["F"])
    x, y = toolkit.positions(problem["x"]), toolkit.positions(problem["y"])
    region = ipctk.ogc.TrustRegion(0.5 * method.radius * RADIUS * edge)
    collisions = ipctk.NormalCollisions()
    way = Way([_distances(y - x).sum()], np.inf, 0, 0.0, 0.0, x, 0)
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
        way.intersecting += ipctk.has_intersections(mesh, x)
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
    return Way(
        report["remaining"], report["largest_remaining"], report["searches"], report["cpu"], report["wall"], x, int(ends)
    )


def _distances(difference):
    return np.linalg.norm(difference, axis=1)


def describe(way, edge):
    """Shares are of the sum over all vertices."""
    remaining = np.array(way.remaining)
    shares = 1.0 - remaining[1:] / np.maximum(remaining[:-1], 1e-300)
    return {
        "steps": len(shares),
        "searches": way.searches,
        "arrived": way.largest <= TOLERANCE * edge,
        "first_share": float(shares[0]),
        "share": float(1.0 - remaining[-1] / remaining[0]),
        "left_m": way.largest,
        "intersecting": way.intersecting,
    }


def measure_problem(recording, out, turns, folder):
    """One record per method and target."""
    problem, path = projection.problem_of(recording, out, folder)
    edge = meshes.mean_edge(problem["x"], problem["F"])
    _, reached = projection.resolve(path, projection.DELTA * edge, "Bowknot, contacts alone", 1, folder)
    reachable = {**problem, "y": reached}
    reachable_path = folder / f"{recording.scene}-reachable.npz"
    np.savez(reachable_path, **reachable)
    records = []
    for target, case, file in (("recorded", problem, path), ("reachable", reachable, reachable_path)):
        times, described = {m.name: Times() for m in METHODS}, {}

        def run(method, case=case, file=file, times=times, described=described):
            if method.bowknot:
                way = walk_by_bowknot(case, file, method, edge, folder)
            else:
                way = walk_by_ipctk(case, method, edge)
            times[method.name].add(way.cpu, way.wall)
            described[method.name] = describe(way, edge)

        mine, theirs = ([m for m in METHODS if m.bowknot == ours] for ours in (True, False))
        measure.in_turn(lambda r=run: [r(m) for m in mine], lambda r=run: [r(m) for m in theirs], turns)
        base = times[OURS.name].cpu
        for method in METHODS:
            cpu = times[method.name].cpu
            record = {"problem": recording.name, "target": target, "method": method.name, **described[method.name]}
            record["vertices"] = len(problem["x"])
            record.update(cpu_s=median(cpu), cpu=spread(cpu), ratios=spread(measure.ratios(cpu, base)))
            records.append(record)
            print(f"{recording.name}, {target}: {method.name}, {record['cpu_s']:.3f} CPU s, {described[method.name]}")
    return records


def table(records):
    columns = ["problem", "target", "method", "vertices", "cpu_s", "ratio", "steps", "searches", "arrived"]
    columns += ["first_step_percent", "way_percent", "largest_left_mm", "intersecting_steps"]
    rows = []
    for r in records:
        rows.append(
            [r["problem"], r["target"], r["method"], r["vertices"], r["cpu"]]
            + ["" if r["method"] == OURS.name else r["ratios"], r["steps"], r["searches"]]
            + ["yes" if r["arrived"] else "no", plain(100.0 * r["first_share"]), plain(100.0 * r["share"])]
            + [plain(1e3 * r["left_m"]), r["intersecting"]]
        )
    return results.Table("peers-planar", columns, rows)


def section(records, versions, load_before):
    def of(method, target):
        return [r for r in records if r["method"] == method and r["target"] == target]

    def steps(method):
        rows = of(method, "reachable")
        return ", ".join(str(r["steps"]) if r["arrived"] else f"more than {MAX_STEPS}" for r in rows)

    def shares(method):
        values = [100.0 * r["first_share"] for r in of(method, "recorded")]
        return f"{number(min(values))} to {number(max(values))}"

    planar, twice, isotropic = (m.name for m in METHODS[2:])
    per_step = [
        (a["cpu_s"] / a["steps"]) / (b["cpu_s"] / b["steps"])
        for target in ("recorded", "reachable")
        for a, b in zip(of(planar, target), of(OURS.name, target), strict=True)
    ]
    bad = {m.name: sum(r["intersecting"] > 0 for r in records if r["method"] == m.name) for m in METHODS}
    runs = len(records) // len(METHODS)
    return results.Section(
        name=NAME,
        title="The forward step: ipctk's planar filter",
        question="""How far does a step go that is limited by planes between near pairs? ipctk's filter is *Planar-DAT*
            (Divide and Truncate, Chen et al. 2026, arXiv 2604.15513); its isotropic one is that of offset geometric
            contact. States and targets recorded from scenes, from which all vertices go straight ahead, with as much
            room between two searches; and targets without intersections, to be reached within a hundredth of a mean
            edge length.""",
        finding=f"""The first step goes {shares(OURS.name)} % of the way by Bowknot's forward step, {shares(planar)} %
            by ipctk's planar filter, {shares(twice)} % with twice the radius, {shares(isotropic)} % by its isotropic
            one. The reachable targets take {steps(OURS.name)} steps, {steps(planar)}, {steps(twice)} and
            {steps(isotropic)}. A step of the planar filter with its searches takes {number(min(per_step))} to
            {number(max(per_step))} times Bowknot's CPU time. States intersect in {bad[OURS.name]} of Bowknot's {runs}
            runs, in {bad[planar]} by the planar filter, in {bad[twice]} with twice the radius, and in
            {bad[isotropic]} by the isotropic one.""",
        caveats="""Both put a plane between the closest points of each near pair, nearer to the side that moves less,
            and stop vertices before it; Bowknot's planes bound a slab whose width is certified with rounding, it gives
            both sides of a pair that is not listed a ball each of half the distance searched, where the filter of
            ipctk 1.6 gives each the whole, and it searches anew as soon as one vertex meets its ball, ipctk when one
            in a hundred is held. A solver that moves its targets in each step, as those the filter is made for and as
            the two-way method, does not go straight ahead; so the number of steps alone compares them. ipctk is called
            from Python; its searches and filters are compiled.""",
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
    for recording in recorded.QUICK if options.quick else recorded.FULL:
        records += measure_problem(recording, options.out, turns, folder)
    results.keep(section(records, versions, load_before), records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
