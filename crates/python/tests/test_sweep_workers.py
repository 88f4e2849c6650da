"""Workers of sweeps: lost ones, those that are told to stop, limits, failures."""

import json
import os
import platform
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from sweeps import LONG, SMALL, begun, sweep, without_costs

import bowknot
from bowknot.sweep import _local

#: Workers that end themselves when they meet the friction 0.7.
CRASHING = _local._PROGRAM.replace(
    "main()",
    "import os, bowknot.sweep._worker as w; made = w.work; "
    "w.work = lambda job: os.abort() if 'friction = 0.7' in job['scene'] else made(job); main()",
)


def workers_of(process):
    """Numbers of the worker processes of a process."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(stat.read_text().rpartition(")")[2].split()[1])
            if parent == process and b"_worker" in (stat.parent / "cmdline").read_bytes():
                found.append(int(stat.parent.name))
        except OSError:
            continue
    return found


@pytest.fixture
def linux():
    if not sys.platform.startswith("linux"):
        pytest.skip("reads /proc")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The long runs, undisturbed."""
    return sweep(LONG, tmp_path_factory.mktemp("whole"))


def test_memory_is_that_of_each_run(tmp_path):
    if platform.libc_ver()[0] != "glibc":
        pytest.skip("other libraries may keep the memory")
    study = {**SMALL, "grid": {"scale": [2.0, 0.2]}, "set": {"simulation.frames": 2}}
    large, small = (row["cost.peak_memory_bytes"] for row in sweep(study, tmp_path, workers=1).rows)
    assert small < 0.6 * large


def test_failures_are_listed_with_reasons(tmp_path, monkeypatch):
    monkeypatch.setattr(_local, "_PROGRAM", CRASHING)
    study = {**SMALL, "retries": 1, "grid": {"body.sheet.friction": [0.1, 0.7]}}
    study["case"] = [{}, {"body.sheet.translate": [0.0, 0.0, 0.25]}]
    seen = []
    done = sweep(study, tmp_path, progress=seen.append)
    assert [row["status"] for row in done.rows] == ["done", "failed", "failed", "failed"]
    assert "intersect" in done.rows[1]["reason"] and done.rows[1]["cost.tries"] == 1
    for row in done.rows[2:]:
        assert row["reason"].startswith("lost 2 times: the worker was ended by SIGABRT")
        assert row["cost.tries"] == 2
    assert (seen[-1].failed, seen[-1].retried) == (3, 2)
    assert done.failures == done.rows[1:]
    # They are tried again by the next sweep.
    monkeypatch.undo()
    again = sweep(study, tmp_path)
    assert [row["status"] for row in again.rows] == ["done", "failed", "done", "failed"]


def test_workers_that_cannot_start_are_said_at_once(tmp_path, monkeypatch):
    monkeypatch.setattr(_local, "_PROGRAM", "raise SystemExit('no such thing')")
    with pytest.raises(bowknot.BowknotError, match="cannot start: .* exit code 1; no such thing"):
        sweep({**SMALL, "grid": {"body.sheet.friction": [0.1, 0.2, 0.3]}}, tmp_path)


def test_workers_that_are_killed_at_their_start_are_lost(tmp_path, monkeypatch):
    monkeypatch.setattr(_local, "_PROGRAM", "import os; os.kill(os.getpid(), 9)")
    rows = sweep({**SMALL, "grid": {"body.sheet.friction": [0.1, 0.2, 0.3]}}, tmp_path).rows
    assert all(row["reason"].startswith("lost 3 times: the worker was ended by SIGKILL") for row in rows)


def test_a_run_has_a_time_limit(tmp_path):
    study = {**SMALL, "set": {"simulation.frames": 100000}, "time_limit": 0.5}
    row = sweep(study, tmp_path).rows[0]
    assert (row["status"], row["reason"], row["cost.tries"]) == ("failed", "time limit of 0.5 s", 1)
    assert (tmp_path / row["folder"] / "checkpoint/state.npz").is_file()


def test_a_worker_that_is_killed_changes_nothing(tmp_path, linux, whole):
    killed = []

    def kill():
        while not begun(tmp_path / "killed"):
            time.sleep(0.01)
        killed.append(workers_of(os.getpid())[0])
        os.kill(killed[0], signal.SIGKILL)

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    done = sweep(LONG, tmp_path / "killed")
    thread.join(10)
    assert killed
    assert without_costs(done.rows) == without_costs(whole.rows)
    assert sorted(row["cost.tries"] for row in done.rows) == [1, 1, 1, 2]
    for row in done.rows:
        last = Path(row["folder"]) / "frames/000060.ply"
        assert (tmp_path / "killed" / last).read_bytes() == (Path(whole.out) / last).read_bytes()
    assert not workers_of(os.getpid())


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_a_sweep_that_is_interrupted_goes_on(tmp_path, linux, whole, how):
    file, out = tmp_path / "study.toml", tmp_path / "out"
    file.write_text(
        f"""
        scene = "drape"
        scale = 0.3
        out = {json.dumps(str(out))}
        table = "table.jsonl"
        set.simulation.frames = 60
        grid.body.sheet.friction = [0.0, 0.1, 0.2, 0.3]
        """
    )
    command = [sys.executable, "-m", "bowknot.sweep", str(file), "--workers", "2"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while not begun(out):
        time.sleep(0.01)
    workers = workers_of(process.pid)
    process.send_signal(how)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130 and "interrupted" in errors
    assert len(workers) == 2 and not any(Path(f"/proc/{worker}").exists() for worker in workers)
    rows = [json.loads(line) for line in (out / "table.jsonl").read_text().splitlines()]
    assert "pending" in [row["status"] for row in rows] and len(rows) == 4
    assert list(out.glob("runs/*/checkpoint/state.npz"))
    done = subprocess.run([*command, "--quiet"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout.strip() == str(out / "table.jsonl")
    assert done.stderr.startswith("warning: run 1 (body.sheet.friction = 0.1) and 2 other runs: body[0].friction"), done
    rows = [json.loads(line) for line in (out / "table.jsonl").read_text().splitlines()]
    assert without_costs(rows) == without_costs(whole.rows)
