"""A pool of processes on this machine. One that is lost costs the run that it made, and no other."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from typing import IO, Any

from .._errors import BowknotError

#: What a worker executes. It has the modules of this process, wherever they come from.
_PROGRAM = "import sys, json; sys.path[:] = json.loads(sys.argv[1]); from bowknot.sweep._worker import main; main()"

#: How long a worker that is told to stop may take to write a checkpoint [s].
_GRACE = 30.0


class LocalPool:
    """Workers, each a process that makes one run at a time."""

    def __init__(self, workers: int) -> None:
        self._jobs: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._results: queue.SimpleQueue[tuple[str, dict[str, Any] | Exception]] = queue.SimpleQueue()
        self._processes: list[subprocess.Popen[bytes]] = []
        self._closing = False
        self._lock = threading.Lock()
        self._room = workers
        self._threads = [threading.Thread(target=self._serve, daemon=True) for _ in range(workers)]
        for thread in self._threads:
            thread.start()

    @property
    def has_room(self) -> bool:
        """Whether another run would begin at once."""
        return self._room > 0

    def submit(self, run: str, job: dict[str, Any]) -> None:
        """Begins a run."""
        self._room -= 1
        self._jobs.put(job)

    def next(self, seconds: float) -> tuple[str, dict[str, Any]] | None:
        """A run that has ended, and its outcome; None if none ends in so many seconds.

        Raises
        ------
        BowknotError
            Workers cannot start at all.
        """
        try:
            run, outcome = self._results.get(timeout=seconds)
        except queue.Empty:
            return None
        if isinstance(outcome, Exception):
            raise outcome
        self._room += 1
        return run, outcome

    def close(self) -> None:
        """Ends all workers. Those that make a run write a checkpoint first."""
        with self._lock:
            self._closing = True
            processes = list(self._processes)
        for _ in self._threads:
            self._jobs.put(None)
        try:
            for process in processes:
                if process.poll() is None:
                    # Windows has no such signal for one process.
                    process.kill() if os.name == "nt" else process.send_signal(signal.SIGINT)
            for process in processes:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(_GRACE)
        finally:
            for process in processes:
                process.kill()
                process.wait()

    def _serve(self) -> None:
        """Gives jobs to one process after another."""
        process, errors = None, tempfile.TemporaryFile()
        while (job := self._jobs.get()) is not None and not self._closing:
            try:
                if process is None or process.poll() is not None:
                    process = self._start(errors)
                outcome = _exchange(process, job) or _lost(process, errors)
            except Exception as error:
                self._results.put((job["run"], error))
                return
            self._results.put((job["run"], outcome))

    def _start(self, errors: IO[bytes]) -> subprocess.Popen[bytes]:
        errors.seek(0)
        errors.truncate()
        with self._lock:
            if self._closing:
                raise BowknotError("the sweep is ending")
            # Of its own session: Ctrl-C in a terminal is for this process, which then tells its workers.
            process = subprocess.Popen(
                [sys.executable, "-c", _PROGRAM, json.dumps(sys.path)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                start_new_session=True,
            )
            self._processes = [other for other in self._processes if other.poll() is None] + [process]
        # One that a signal ended is lost, as it would be later; one that ended by itself will do so again.
        if not _line(process) and process.wait() > 0:
            raise BowknotError(f"workers cannot start: {_lost(process, errors)['reason']}")
        return process


def _exchange(process: subprocess.Popen[bytes], job: dict[str, Any]) -> dict[str, Any] | None:
    """The outcome of a job, None if the worker ends before."""
    try:
        assert process.stdin is not None
        process.stdin.write(json.dumps(job).encode() + b"\n")
        process.stdin.flush()
    except OSError:
        return None
    line = _line(process)
    return json.loads(line) if line else None


def _line(process: subprocess.Popen[bytes]) -> bytes:
    assert process.stdout is not None
    line = process.stdout.readline()
    return line if line.endswith(b"\n") else b""


def _lost(process: subprocess.Popen[bytes], errors: IO[bytes]) -> dict[str, Any]:
    """The outcome of a run whose worker has ended, with what is known of why."""
    code = process.wait()
    reason = f"the worker ended with exit code {code}"
    if code < 0:
        with contextlib.suppress(ValueError):
            name = signal.Signals(-code).name
            hint = ": ended from outside, by the system if memory ran out" if name == "SIGKILL" else ""
            reason = f"the worker was ended by {name}{hint}"
    errors.seek(0, os.SEEK_END)
    errors.seek(max(errors.tell() - 2000, 0))
    lines = errors.read().decode("utf-8", "replace").strip().splitlines()
    return {"status": "lost", "reason": "; ".join([reason, *lines[-1:]]), "columns": {}}
