"""Runs on the machines of a Ray cluster."""

from __future__ import annotations

import contextlib
import importlib.util
import logging
import signal
import socket
from typing import Any

from .._call import logger
from .._errors import InputError
from ._work import failed, work

#: How many runs wait in Ray at most: enough for a cluster to see that it should grow.
_QUEUED = 1000

#: How long runs may take to write a checkpoint when all are told to stop [s].
_GRACE = 30.0

#: How long an address may take to answer [s].
_ANSWER = 10.0


class RayPool:
    """Tasks of Ray, each one run."""

    def __init__(self, address: str | None, threads: int, workers: int | None) -> None:
        if importlib.util.find_spec("ray") is None:
            raise InputError('backend = "ray": needs Ray: pip install ray')
        import ray

        self._ray = ray
        self._is_ours = not ray.is_initialized()
        if self._is_ours:
            _reach(address)
            before = signal.getsignal(signal.SIGTERM)
            try:
                ray.init(address=address, log_to_driver=False, logging_level=logging.WARNING)
            except (ConnectionError, ValueError, RuntimeError) as error:
                raise InputError(f"address = {address!r}: no Ray cluster: {error}") from error
            with contextlib.suppress(ValueError):
                # Ray puts a handler of its own there; only the main thread can.
                signal.signal(signal.SIGTERM, before)
        largest = max((node["Resources"].get("CPU", 0) for node in ray.nodes() if node["Alive"]), default=0)
        if largest < threads:
            text = "threads = %d: the largest machine of the cluster has %g CPUs; runs wait until a larger one joins"
            logger.warning(text, threads, largest)
        # Lost runs are tried again by the sweep, which counts the tries and knows the reasons.
        self._task = ray.remote(num_cpus=threads, max_retries=0)(work)
        self._running: dict[Any, str] = {}
        self._most = workers or _QUEUED

    @property
    def has_room(self) -> bool:
        """Whether another run may be submitted."""
        return len(self._running) < self._most

    def submit(self, run: str, job: dict[str, Any]) -> None:
        """Queues a run."""
        self._running[self._task.remote(job)] = run

    def next(self, seconds: float) -> tuple[str, dict[str, Any]] | None:
        """A run that has ended, and its outcome; None if none ends in so many seconds."""
        ready, _ = self._ray.wait(list(self._running), num_returns=1, timeout=seconds)
        if not ready:
            return None
        run = self._running.pop(ready[0])
        try:
            return run, self._ray.get(ready[0])
        except self._ray.exceptions.RayTaskError as error:
            return run, failed(str(error).strip().splitlines()[-1])
        except self._ray.exceptions.RayError as error:
            lines = str(error).strip().splitlines() or [""]
            return run, {"status": "lost", "reason": f"{type(error).__name__}: {lines[0]}", "columns": {}}

    def close(self) -> None:
        """Ends all tasks. Those that make a run write a checkpoint first."""
        for task in self._running:
            with contextlib.suppress(self._ray.exceptions.RayError):
                self._ray.cancel(task)
        if self._running:
            self._ray.wait(list(self._running), num_returns=len(self._running), timeout=_GRACE)
        if self._is_ours:
            self._ray.shutdown()


def _reach(address: str | None) -> None:
    """Refuses an address `host:port` where nothing answers: Ray would try for minutes."""
    host, _, port = (address or "").rpartition(":")
    if host and port.isdigit():
        try:
            socket.create_connection((host, int(port)), _ANSWER).close()
        except OSError as error:
            raise InputError(f"address = {address!r}: no Ray cluster: {error}") from error
