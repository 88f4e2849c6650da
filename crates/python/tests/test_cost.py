"""What the package costs: time of calls and of runs beside the time that the library measures of itself."""

import time

import numpy as np
import pytest
from conftest import two_sheets

import bowknot


def share(calls):
    """Part of the wall time that is not the library's, over (wall, own) seconds of calls."""
    walls, owns = np.array(calls).T
    return float(np.median((walls - owns) / walls))


def test_the_binding_costs_little_at_ten_thousand_vertices(capsys):
    x, faces = two_sheets(71, 0.02)
    assert len(x) > 10_000
    resolver = bowknot.Resolver(x, faces)
    v, calls = np.zeros_like(x), []
    v[: len(x) // 2, 2] = 1.0
    for _ in range(8):
        y = x + 0.01 * v
        start = time.perf_counter()
        x, info = resolver.resolve(x, y, dt=0.01)
        calls.append((time.perf_counter() - start, info.seconds["total"]))
    of_resolver = share(calls[1:])

    scene = bowknot.Scene(simulation={"frames": 100})
    scene.add_body(x, faces, name="cloth")
    simulator = bowknot.Simulator(scene)
    calls = []
    for _ in range(4):
        start = time.perf_counter()
        info = simulator.step()
        simulator.positions, simulator.velocities, info.solved
        calls.append((time.perf_counter() - start, info.seconds["total"]))
    of_simulator = share(calls[1:])
    with capsys.disabled():
        print(f"\nbinding: {100 * of_resolver:.2f} % of resolve, {100 * of_simulator:.2f} % of step", end=" ")
    # The aim is 2 %; a busy machine may take the processor away between two clocks.
    assert of_resolver < 0.1 and of_simulator < 0.1


def test_a_sweep_costs_little_per_run(tmp_path, capsys):
    resource = pytest.importorskip("resource")

    def cpu():
        used = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
        return sum(usage.ru_utime + usage.ru_stime for usage in used)

    def cost(samples):
        """CPU seconds beside those of the runs, and of the same sweep again."""
        study = {"scene": "drape", "scale": 0.2, "set": {"simulation.frames": 3}, "table": "table.csv"}
        study["latin"] = {"samples": samples, "keys": {"body.sheet.friction": {"low": 0.0, "high": 0.5}}}
        spent = []
        for _ in range(2):
            start = cpu()
            rows = bowknot.sweep(study, out=tmp_path / str(samples), workers=1, progress=False).rows
            spent.append(cpu() - start)
        return spent[0] - sum(row["cost.cpu_seconds"] for row in rows), spent[1]

    (alone, _), (many, again) = cost(1), cost(201)
    per_run = (many - alone) / 200
    with capsys.disabled():
        found = f"{1000 * again / 201:.2f} ms per finished one"
        print(f"\nsweep: {alone:.2f} s per worker, {1000 * per_run:.2f} ms per run, {found}", end=" ")
    # Seconds of the processor, but a busy machine makes these longer too.
    assert alone < 5.0 and per_run < 0.05
