"""What the binding costs: time of a call from Python against the time that the library measures of itself."""

import time

import numpy as np
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
