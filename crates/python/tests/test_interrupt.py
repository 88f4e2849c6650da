"""Ctrl-C ends calls at a valid state."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from conftest import two_sheets

import bowknot

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")


@pytest.fixture(autouse=True)
def heard():
    """Python hears of Ctrl-C even if the tests were started in the background of a shell, where it is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt_after(seconds):
    thread = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
    thread.start()
    return thread


def long_problem():
    """A problem that takes many steps."""
    x, faces = two_sheets(60, 0.05)
    random = np.random.default_rng(3)
    y = x + random.normal(0.0, 3.0, x.shape)
    settings = {"max_steps": 10**6, "max_seconds": 60.0, "distance": 1e-12, "stretch_tolerance": 1e-12}
    return x, y, faces, bowknot.Resolver(x, faces, **settings)


def test_a_call_stops_at_a_valid_state():
    x, y, faces, resolver = long_problem()
    state = x.copy()
    timer = interrupt_after(0.5)
    start = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        resolver.resolve_in_place(state, y)
        time.sleep(5)  # should the call have ended before
    timer.join()
    assert time.perf_counter() - start < 20.0
    assert bowknot.check(state, faces)
    # It can be used again.
    before = state.copy()
    timer = interrupt_after(0.3)
    with pytest.raises(KeyboardInterrupt):
        resolver.resolve(state, y)
        time.sleep(5)
    timer.join()
    assert (state == before).all()


def test_a_time_step_that_is_interrupted_is_taken_back():
    scene = bowknot.Scene.builtin("needle", scale=0.5)
    simulator = bowknot.Simulator(scene)
    reference = bowknot.Simulator(scene)
    timer = interrupt_after(0.7)
    with pytest.raises(KeyboardInterrupt):
        for _ in simulator.steps(10**6):
            pass
    timer.join()
    frame = simulator.frame
    for _ in reference.steps(min(frame, 3)):
        pass
    if frame <= 3:
        assert (simulator.positions == reference.positions).all()
    assert simulator.check()
    assert simulator.step().step == frame + 1


def test_a_handler_of_ones_own_is_heard():
    x, y, _, resolver = long_problem()

    class Enough(Exception):
        pass

    def handler(*_):
        raise Enough

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(Enough):
            resolver.resolve(x, y)
            time.sleep(5)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def test_other_threads_go_on_meanwhile():
    x, y, _, _ = long_problem()
    resolver = bowknot.Resolver(x, two_sheets(60)[1], max_seconds=0.6, max_steps=10**6, distance=1e-12)
    counts = [0]
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counts[0] += 1
            time.sleep(0.005)

    thread = threading.Thread(target=count)
    thread.start()
    resolver.resolve(x, y)
    stop.set()
    thread.join()
    assert counts[0] > 3


def test_a_run_that_is_interrupted_can_be_resumed(tmp_path):
    program = textwrap.dedent(
        f"""
        import signal
        import bowknot
        signal.signal(signal.SIGINT, signal.default_int_handler)
        scene = bowknot.Scene.builtin("drape", scale=0.4)
        scene.set("simulation.frames", 100000)
        print("ready", flush=True)
        bowknot.run(scene, {str(tmp_path / "run")!r})
        """
    )
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout.readline().strip() == b"ready"
    time.sleep(1.5)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert b"KeyboardInterrupt" in errors
    state = bowknot.Checkpoint.load(tmp_path / "run" / "checkpoint" / "state.npz")
    assert state.step > 0


def test_threads_survive_a_fork():
    program = textwrap.dedent(
        """
        import os, bowknot
        def frames():
            simulator = bowknot.Simulator(bowknot.Scene.builtin("drape", scale=0.2))
            simulator.step()
            return simulator.positions.sum()
        first = frames()
        child = os.fork()
        assert frames() == first
        if child:
            _, status = os.waitpid(child, 0)
            raise SystemExit(os.waitstatus_to_exitcode(status))
        """
    )
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], timeout=60, capture_output=True)
    assert done.returncode == 0, done.stderr
