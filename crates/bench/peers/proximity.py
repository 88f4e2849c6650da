#!/usr/bin/env python3
"""Times the search for all pairs within a radius by ipctk (candidates and distances) and by Bowknot.

Both get the same triangles and find vertex-triangle and edge-edge pairs that share no vertex; the
sets of pairs are compared too. Folded sheets, and states recorded from scenes.
"""

import json
import sys
from dataclasses import dataclass

import setting  # isort: skip  (limits the threads of what NumPy loads)
import numpy as np

import measure
import meshes
import recorded
import results
import toolkit
from measure import Timer, Times, median, number, plain, spread

NAME = "proximity"


@dataclass
class Case:
    name: str
    points: np.ndarray
    faces: np.ndarray
    radius: float


def cases(quick, out):
    """Folded sheets in layers 1.5 mm apart at 2 mm; recorded states at half an edge."""
    for vertices in (10_000,) if quick else (10_000, 50_000):
        points, faces = meshes.folded_sheet(vertices, 0.0015)
        yield Case(f"folded sheet, {vertices // 1000}k", points, faces, 0.002)
    for recording in recorded.QUICK if quick else recorded.FULL:
        state = recorded.load(recorded.path_of(recording, out))
        radius = 0.5 * meshes.mean_edge(state["x"], state["F"])
        yield Case(recording.name, state["x"], state["F"], radius)


class Peer:
    """ipctk's search on one case."""

    def __init__(self, case, threads):
        self.ipctk = toolkit.start(threads)
        self.points = toolkit.positions(case.points)
        self.mesh = toolkit.mesh_of(self.ipctk, case.points, case.faces)
        self.radius = case.radius

    def refuse_intersections(self, name):
        """Neither program works on a state with intersections."""
        if self.ipctk.has_intersections(self.mesh, self.points):
            raise setting.Unusable(f"{name}: the state intersects itself; report it as a bug")

    def candidates(self, method="LBVH"):
        """Pairs whose boxes, inflated by half the radius, meet."""
        found = self.ipctk.Candidates()
        found.build(self.mesh, self.points, 0.5 * self.radius, getattr(self.ipctk, method)())
        return found

    def collisions(self, candidates):
        """The candidates within the radius; ipctk merges those with the same closest features."""
        collisions = self.ipctk.NormalCollisions()
        collisions.build(candidates, self.mesh, self.points, self.radius)
        return collisions

    def time(self, repeats, method="LBVH"):
        """Times of the candidates, with their distances, and with the list of those within the radius."""
        boxes, near, listed = Times(), Times(), Times()
        for _ in range(repeats):
            timer = Timer()
            candidates = self.candidates(method)
            cpu, wall = timer.cpu(), timer.wall()
            boxes.add(cpu, wall)
            timer = Timer()
            candidates.compute_per_vertex_safe_distances(self.mesh, self.points, self.radius)
            near.add(cpu + timer.cpu(), wall + timer.wall())
            timer = Timer()
            self.collisions(candidates)
            listed.add(cpu + timer.cpu(), wall + timer.wall())
        return boxes, near, listed

    def pairs(self):
        """Kind and vertices of each candidate within the radius, and their distances."""
        found, distances = [], []
        edges, faces = self.mesh.edges, self.mesh.faces
        candidates = self.candidates()
        for kind, group in enumerate((candidates.fv_candidates, candidates.ee_candidates)):
            for candidate in group:
                squared = candidate.compute_distance(candidate.dof(self.points, edges, faces))
                # Slightly more than the radius, to distinguish pairs at the radius from missing ones.
                if squared <= (self.radius * (1.0 + 1e-6)) ** 2:
                    found.append((kind, *candidate.vertex_ids(edges, faces)))
                    distances.append(squared**0.5)
        return np.array(found, dtype=np.int64).reshape(-1, 5), np.array(distances)


def bowknot_search(state, case, threads, repeats, pairs=None):
    """The report of one call of the timing program."""
    command = [setting.program("peer_search"), state, "--radius", repr(case.radius)]
    command += ["--threads", threads, "--repeats", repeats]
    return json.loads(setting.call(command + (["--pairs", pairs] if pairs else [])))


def keys(pairs):
    """Rows in a form that does not depend on the order of sides or of vertices within a side."""
    kinds, ids = pairs[:, :1], pairs[:, 1:]
    triangle = np.concatenate([ids[:, :1], np.sort(ids[:, 1:], axis=1)], axis=1)
    first, second = np.sort(ids[:, :2], axis=1), np.sort(ids[:, 2:], axis=1)
    swap = (
        (first[:, 0] > second[:, 0])
        | ((first[:, 0] == second[:, 0]) & (first[:, 1] > second[:, 1]))
    )[:, None]
    edges = np.where(swap, np.concatenate([second, first], 1), np.concatenate([first, second], 1))
    return np.concatenate([kinds, np.where(kinds == 0, triangle, edges)], axis=1)


def compare_pairs(peer, case, state, folder):
    """Counts pairs that only one program finds; pairs at the radius itself may differ."""
    file = folder / "pairs.u32"
    bowknot_search(state, case, 1, 1, file)
    ours = keys(np.fromfile(file, dtype="<u4").astype(np.int64).reshape(-1, 5))
    file.unlink()
    theirs, distances = peer.pairs()
    listed = set(map(tuple, keys(theirs)))
    within = set(map(tuple, keys(theirs[distances <= case.radius])))
    ours = set(map(tuple, ours))
    missing, unknown = within - ours, ours - listed
    if missing or unknown:
        print(
            f"{case.name}: {len(missing)} pairs only in ipctk, {len(unknown)} only in Bowknot, "
            f"for example {sorted(missing | unknown)[:3]}"
        )
    return len(ours), len(within), len(missing), len(unknown)


def measure_case(case, threads, turns, folder, counts, state):
    """One record: medians and ratios over the turns."""
    peer = Peer(case, threads)
    boxes, near, listed, kept, fresh = Times(), Times(), Times(), Times(), Times()

    def time_peer():
        for times, of_turn in zip((boxes, near, listed), peer.time(3), strict=True):
            times.add(median(of_turn.cpu), median(of_turn.wall))

    def time_ours():
        report = bowknot_search(state, case, threads, 10)
        for times, of_turn in ((kept, report["kept"]), (fresh, report["fresh"])):
            times.add(median(of_turn["cpu"]), median(of_turn["wall"]))

    peer.time(1)  # memory and caches
    measure.in_turn(time_peer, time_ours, turns)
    ours, theirs, missing, unknown = counts
    return {
        "state": case.name,
        "vertices": len(case.points),
        "radius_m": case.radius,
        "threads": threads,
        "pairs_bowknot": ours,
        "pairs_ipctk": theirs,
        "only_ipctk": missing,
        "only_bowknot": unknown,
        "ipctk_candidates_cpu_s": median(boxes.cpu),
        "ipctk_distances_cpu_s": median(near.cpu),
        "ipctk_list_cpu_s": median(listed.cpu),
        "ipctk_list_wall_s": median(listed.wall),
        "bowknot_made_cpu_s": median(fresh.cpu),
        "bowknot_kept_cpu_s": median(kept.cpu),
        "bowknot_kept_wall_s": median(kept.wall),
        "ratio_list": spread(measure.ratios(listed.cpu, kept.cpu)),
        "ratio_list_made": spread(measure.ratios(listed.cpu, fresh.cpu)),
        "ratio_list_wall": spread(measure.ratios(listed.wall, kept.wall)),
        "ratio_distances": spread(measure.ratios(near.cpu, kept.cpu)),
        "turns": turns,
    }


def other_methods(case, threads):
    """CPU milliseconds of ipctk's broad phases with the list, measured once after a warm-up."""
    peer = Peer(case, threads)
    names = [
        n for n in ("LBVH", "HashGrid", "SpatialHash", "SweepAndPrune") if hasattr(peer.ipctk, n)
    ]
    return {name: 1e3 * peer.time(2, name)[2].cpu[1] for name in names}


TIMES = {
    "ipctk_list_ms": "ipctk_list_cpu_s",
    "ipctk_distances_ms": "ipctk_distances_cpu_s",
    "bowknot_made_ms": "bowknot_made_cpu_s",
    "bowknot_kept_ms": "bowknot_kept_cpu_s",
}
RATIOS = {
    "list_to_made": "ratio_list_made",
    "list_to_kept": "ratio_list",
    "distances_to_kept": "ratio_distances",
    "list_to_kept_wall": "ratio_list_wall",
}


def tables(records, others):
    rows = []
    for r in records:
        row = [r["state"], r["vertices"], r["pairs_bowknot"], r["threads"]]
        row += [plain(1e3 * r[name]) for name in TIMES.values()]
        rows.append(row + [r[name] for name in RATIOS.values()])
    columns = ["state", "vertices", "pairs", "threads", *TIMES, *RATIOS]
    methods = [[name, plain(ms)] for name, ms in others.items()]
    return [
        results.Table("peers-proximity", columns, rows),
        results.Table("peers-proximity-broad-phases", ["method", "ipctk_list_ms"], methods),
    ]


def section(records, others, versions, threads, load_before):
    def span(above, rows):
        of_rows = [r[above] / r["bowknot_kept_cpu_s"] for r in rows]
        return f"{number(min(of_rows))} to {number(max(of_rows))}"

    folded = [r for r in records if r["state"].startswith("folded")]
    scenes = [r for r in records if r not in folded]
    folded_list, folded_near = (span(f"ipctk_{n}_cpu_s", folded) for n in ("list", "distances"))
    scenes_list, scenes_near = (span(f"ipctk_{n}_cpu_s", scenes) for n in ("list", "distances"))
    differing = sum(r["only_ipctk"] + r["only_bowknot"] for r in records)
    sets = "The sets of pairs are equal" if differing == 0 else f"{differing} pairs differ"
    return results.Section(
        name=NAME,
        title="Search for all pairs within a radius: ipctk",
        question="""How long do the vertex-triangle and edge-edge pairs within a radius take,
            distances included? Folded sheets in layers 1.5 mm apart with a radius of 2 mm, and
            states recorded from scenes with half a mean edge length.""",
        finding=f"""ipctk's LBVH with its list of collisions takes {folded_list} times the CPU
            time of Bowknot's search on folded sheets and {scenes_list} times on recorded states.
            Its candidates with a distance each, without a list, take {folded_near} and
            {scenes_near} times. {sets}.""",
        caveats="""On folded sheets most of ipctk's time goes into the list, in which it merges
            pairs with equal closest features; Bowknot's search does not.""",
        tables=tables(records, others),
        conditions=measure.conditions(versions, _words(threads), load_before),
    )


def _words(threads):
    return f"{' and '.join(map(str, threads))} {'thread' if threads == [1] else 'threads'}"


def main():
    parser = setting.arguments(__doc__, threads=[2, 1])
    options = parser.parse_args()
    turns = options.turns or (2 if options.quick else 5)
    folder = options.out / ("quick" if options.quick else "full") / NAME
    folder.mkdir(parents=True, exist_ok=True)
    load_before = measure.load()
    records, others = [], {}
    for case in cases(options.quick, options.out):
        peer = Peer(case, options.threads[0])
        peer.refuse_intersections(case.name)
        others = others or other_methods(case, options.threads[0])
        state = folder / "state.npz"
        np.savez(state, x=case.points, y=case.points, F=case.faces)
        counts = compare_pairs(peer, case, state, folder)
        for threads in options.threads:
            records.append(measure_case(case, threads, turns, folder, counts, state))
            print({k: v for k, v in records[-1].items() if k in ("state", "threads", "ratio_list")})
        state.unlink()
    versions = {"ipctk": setting.peer("ipctk").__version__}
    text = section(records, others, versions, options.threads, load_before)
    results.keep(text, records, folder)


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
