"""One run of a study, in a worker."""

from __future__ import annotations

import _thread
import contextlib
import ctypes
import logging
import socket
import threading
import time
import warnings
from pathlib import Path
from typing import Any

from .. import _native
from .._call import logger
from .._errors import BowknotError, BowknotWarning, InputError
from .._runs import Run, run
from .._scene import Scene
from ._store import clear, store
from ._table import columns

#: How long a folder is waited for that a lost worker may still write to [s].
_PATIENCE = 60.0


def work(job: dict[str, Any]) -> dict[str, Any]:
    """Makes a run and returns its outcome, which may be a failure.

    Parameters
    ----------
    job : dict
        ``run`` (its hash), ``tries`` (this one included), ``scene`` (TOML), ``version``, and of the study ``out``,
        ``check``, ``keep``, ``threads``, ``time_limit``.

    Raises
    ------
    KeyboardInterrupt
        The worker was told to stop. The folder has a checkpoint.
    """
    if job["version"] != _native.__version__:
        return failed(f"the worker on {socket.gethostname()} has bowknot {_native.__version__}, not {job['version']}")
    if _native.threads() != job["threads"]:
        _native.set_threads(job["threads"])
    limit = _Limit(job["time_limit"])
    try:
        with limit:
            return _made(job)
    except KeyboardInterrupt:
        if not limit.is_over:
            raise
        return failed(f"time limit of {job['time_limit']:g} s")
    except (BowknotError, OSError) as error:
        return failed(str(error))
    except Exception as error:
        return failed(f"{type(error).__name__}: {error}")


def failed(reason: str) -> dict[str, Any]:
    """The outcome of a run that is not finished."""
    return {"status": "failed", "reason": reason, "columns": {}}


def _made(job: dict[str, Any]) -> dict[str, Any]:
    results = store(job["out"])
    scene = Scene.from_toml(job["scene"] + "\n")
    _forget_memory()
    cpu, wall = time.process_time(), time.perf_counter()
    with _warnings() as told, results.folder(job["run"], job["keep"]) as folder:
        done = _run(scene, folder, job["check"])
        found = columns(done.summary, done.stats)
    cost = {
        "cost.wall_seconds": time.perf_counter() - wall,
        "cost.cpu_seconds": time.process_time() - cpu,
        "cost.host": socket.gethostname(),
        "cost.tries": job["tries"],
    }
    outcome = {
        "status": "done",
        "reason": "",
        "version": job["version"],
        "warnings": list(told),
        "findings": done.findings,
        "columns": {"warnings": len(told), **found, **cost},
    }
    results.finish(job["run"], outcome)
    return outcome


def _run(scene: Scene, folder: Path, check: bool) -> Run:
    """The run in a folder, which may have the first part of it. It goes on from there, unless all states are to be
    judged: what was found before is not known."""
    since = time.monotonic()
    goes_on = folder.exists()
    while True:
        try:
            return run(scene, folder, resume=True) if goes_on and not check else run(scene, folder, check=check)
        except InputError as error:
            if "in use by another run" in str(error):
                # A worker that was given up, as on a machine that is cut off, may go on for a while.
                if time.monotonic() - since > _PATIENCE:
                    raise
                time.sleep(1.0)
            elif goes_on:
                clear(folder)
                goes_on = False
            else:
                raise


class _Limit:
    """Ends a block with KeyboardInterrupt after some seconds."""

    def __init__(self, seconds: float | None) -> None:
        self.is_over = False
        self._timer = threading.Timer(seconds, self._end) if seconds is not None else None

    def __enter__(self) -> None:
        if self._timer:
            self._timer.daemon = True
            self._timer.start()

    def __exit__(self, *_: object) -> None:
        if self._timer:
            self._timer.cancel()

    def _end(self) -> None:
        self.is_over = True
        _thread.interrupt_main()


@contextlib.contextmanager
def _warnings() -> Any:
    """The warnings of a block, in words, each once: a run that is tried again repeats them."""
    found: dict[str, None] = {}

    class Keep(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            found[record.getMessage()] = None

    show = warnings.showwarning

    def keep(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if issubclass(category, BowknotWarning):
            found[str(message)] = None
        else:
            show(message, category, *place)

    handler, before = Keep(logging.WARNING), logger.propagate
    logger.addHandler(handler)
    logger.propagate = False
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", BowknotWarning)
            warnings.showwarning = keep  # type: ignore[assignment]
            yield found
    finally:
        logger.removeHandler(handler)
        logger.propagate = before


def _forget_memory() -> None:
    """Gives back the memory of runs before, and forgets how much it was, where the system can: malloc_trim(3) of the
    GNU C library, proc_pid_clear_refs(5) of Linux."""
    with contextlib.suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
