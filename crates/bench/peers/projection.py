#!/usr/bin/env python3
"""Solves recorded collision problems (x, y) by a log barrier made of ipctk's parts, and by
`bowknot resolve`: times, distances to the target, gaps.

Obstacles and pins are held, and half-spaces are left out, for both. The barrier includes SciPy's
SuperLU and Python code around ipctk: a weak baseline.
"""

import json
import sys

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import measure
import meshes
import recorded
import results
import toolkit
from measure import Times, median, number, plain, spread

NAME = "projection"

# Bowknot's defaults, in mean edge lengths: the contact distance, and the largest distance from the
# solution at which vertices may stop.
DELTA = 0.1
TOLERANCE = 0.01

# Variants of `bowknot resolve`: the problem that the barrier solves, and that of simulations.
VARIANTS = {
    "Bowknot, contacts alone": ["--set", "contact.edges=false"],
    "Bowknot, with stretch limits": [],
}


def problem_of(recording, out, folder):
    """The part of the recorded problem that both solve, and its file."""
    full = recorded.load(recorded.path_of(recording, out))
    kept = ("x", "y", "F", "rest", "mass", "fixed", "O", "body", "dt")
    problem = {name: full[name] for name in kept}
    held = problem["fixed"] | problem["O"]
    problem["y"][held] = problem["x"][held]
    path = folder / f"{recording.scene}.npz"
    np.savez(path, **problem)
    return problem, path


def resolve(path, delta, variant, threads, folder):
    """The report of `bowknot resolve`, and its result."""
    result = folder / "resolved.npz"
    options = ["--set", f"contact.delta={delta!r}", "--set", f"solver.stop.distance={TOLERANCE}"]
    options += [*VARIANTS[variant], "--threads", threads]
    text = setting.call(
        [setting.program("bowknot"), "resolve", path, "--out", result, "--json", *options]
    )
    return json.loads(text), recorded.load(result)["x"]


class Judge:
    """Measures all states of one problem alike."""

    def __init__(self, ipctk, problem, edge):
        self.ipctk, self.problem, self.edge = ipctk, problem, edge
        self.free = ~(problem["fixed"] | problem["O"])
        held = ~self.free
        self.mesh = toolkit.mesh_of(ipctk, problem["x"], problem["F"], held)
        edges = meshes.edges_of(problem["F"])
        self.edges = edges[self.free[edges].any(axis=1)]

    def judge(self, x):
        x = toolkit.positions(x)
        away = (x - self.problem["y"])[self.free]
        masses = self.problem["mass"][self.free]
        lengths = self._lengths(x) / self._lengths(self.problem["rest"])
        gap = toolkit.smallest_distance(self.ipctk, self.mesh, x, self.edge)
        return {
            "distance_rms_m": float(np.sqrt((away**2).sum(axis=1).mean())),
            "objective_J": 0.5
            * float(masses @ (away**2).sum(axis=1))
            / float(self.problem["dt"]) ** 2,
            "min_gap_m": gap,
            "max_stretch": float(lengths.max()),
            "intersects": self.ipctk.has_intersections(self.mesh, x),
        }

    def _lengths(self, x):
        a, b = self.edges.T
        return np.linalg.norm(x[a] - x[b], axis=1)


def measure_problem(recording, options, turns, folder):
    """Records of the start, the barrier and the variants of Bowknot on one problem."""
    import barrier

    threads = options.threads[0]
    ipctk = toolkit.start(threads)
    problem, path = problem_of(recording, options.out, folder)
    edge = meshes.mean_edge(problem["rest"], problem["F"])
    delta = DELTA * edge
    judge = Judge(ipctk, problem, edge)
    records = {name: {"method": name} for name in ("start", "log barrier, ipctk", *VARIANTS)}
    times = {name: Times() for name in records}
    records["start"].update(judge.judge(problem["x"]))

    def run_barrier():
        name = "log barrier, ipctk"
        tolerance, limit = TOLERANCE * edge, options.max_seconds
        out = barrier.project(ipctk, problem, delta, tolerance, options.max_iterations, limit)
        times[name].add(out.cpu, out.wall)
        records[name].update(judge.judge(out.x), iterations=out.iterations, end=out.end)
        records[name].update(solves_cpu_s=out.solves, stiffness=out.stiffness[-1:] or "")

    def run_bowknot():
        for name in VARIANTS:
            report, x = resolve(path, delta, name, threads, folder)
            times[name].add(report["cpu_seconds"], report["seconds"])
            end = "converged" if report["converged"] else "steps used up"
            records[name].update(judge.judge(x), iterations=report["steps"], end=end)

    measure.in_turn(run_barrier, run_bowknot, turns)
    common = {"problem": recording.name, "vertices": len(problem["x"]), "delta_m": delta}
    for name, record in records.items():
        if times[name].cpu:
            record.update(cpu_s=median(times[name].cpu), wall_s=median(times[name].wall))
            record["cpu"] = spread(times[name].cpu)
            quotients = measure.ratios(times["log barrier, ipctk"].cpu, times[name].cpu)
            record.update(ratio=median(quotients), ratios=spread(quotients))
    return [{**common, **record} for record in records.values()]


def table(records):
    columns = ["problem", "method", "vertices", "cpu_s", "ratio", "iterations", "superlu_percent"]
    columns += ["rms_to_target_mm", "objective_mj", "min_gap_mm", "max_stretch", "end"]
    rows = []
    for r in records:
        share = plain(100.0 * r["solves_cpu_s"] / r["cpu_s"], 2) if "solves_cpu_s" in r else ""
        end = "intersects" if r["intersects"] else r.get("end", "")
        # Empty: no pair is nearer than a mean edge length.
        gap = "" if r["min_gap_m"] is None else plain(1e3 * r["min_gap_m"])
        rows.append(
            [r["problem"], r["method"], r["vertices"], r.get("cpu", ""), r.get("ratios", "")]
            + [r.get("iterations", ""), share, plain(1e3 * r["distance_rms_m"], 4)]
            + [plain(1e3 * r["objective_J"], 4), gap, f"{r['max_stretch']:.3f}", end]
        )
    return results.Table("peers-projection", columns, rows)


def section(records, versions, options, load_before):
    ours, limits = ([r for r in records if r["method"] == name] for name in VARIANTS)
    theirs = [r for r in records if r["method"].startswith("log")]
    quotients = [r["ratio"] for r in ours]
    both = list(zip(theirs, ours, strict=True))
    nearer = sum(a["objective_J"] < b["objective_J"] for a, b in both)
    gaps = [a["min_gap_m"] / b["min_gap_m"] for a, b in both if a["min_gap_m"] and b["min_gap_m"]]
    closer = (
        f", with gaps of {number(min(gaps))} to {number(max(gaps))} times Bowknot's" if gaps else ""
    )
    least, most = number(min(quotients)), number(max(quotients))
    left = [r["problem"] for r in theirs if r["end"] != "converged"]
    unfinished = f" The barrier did not converge in {'; '.join(left)}." if left else ""
    mine = [f"{r['problem']} ({r['method']})" for r in ours + limits if r["end"] != "converged"]
    unfinished += f" Bowknot did not converge in {'; '.join(mine)}." if mine else ""
    bad = [f"{r['method']} on {r['problem']}" for r in records if r["intersects"]]
    clear = f"Intersecting: {'; '.join(bad)}." if bad else "No result intersects."
    threads = options.threads[0]
    return results.Section(
        name=NAME,
        title="Projection by a log barrier made of ipctk's parts",
        question=f"""What does the state cost that is nearest to a target y without
            intersections? States and targets recorded from scenes. For both, contacts act below a
            tenth of a mean edge length, and both stop when no vertex would move by more than
            {TOLERANCE:g} of one.""",
        finding=f"""The barrier takes {least} to {most} times the CPU time of `bowknot resolve`
            with contacts alone, and ends nearer to the target in {nearer} of {len(both)}
            problems{closer}. {clear}{unfinished}""",
        caveats="""The two allow different states: Bowknot separates contacts to the distance
            below which the barrier acts, while the barrier lets them come nearer under load. The
            barrier's time includes SciPy's SuperLU and Python between ipctk's parts: it does not
            show what a barrier written as one program would take. *Contacts alone* is the
            problem that the barrier solves; *with stretch limits* adds edges of at most 1.1 times
            their rest length, as in simulations.""",
        tables=[table(records)],
        conditions=measure.conditions(
            versions, f"{threads} thread{'s' if threads > 1 else ''}", load_before
        ),
    )


def main():
    parser = setting.arguments(__doc__, threads=[1])
    parser.add_argument("--max-iterations", type=int, default=1000, help="of the barrier")
    parser.add_argument("--max-seconds", type=float, help="of the barrier [default: 60, quick 10]")
    options = parser.parse_args()
    options.max_seconds = options.max_seconds or (10.0 if options.quick else 60.0)
    turns = options.turns or (2 if options.quick else 5)
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    versions = {name: setting.peer(name).__version__ for name in ("ipctk", "scipy")}
    load_before = measure.load()
    records = []
    for recording in recorded.QUICK if options.quick else recorded.FULL:
        print(f"solving {recording.name}")
        records += measure_problem(recording, options, turns, folder)
    results.keep(section(records, versions, options, load_before), records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
