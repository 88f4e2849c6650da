"""Many runs: parameter studies and data sets, on the cores of this machine or on a Ray cluster.

The module is the function `bowknot.sweep`. ``python -m bowknot.sweep study.toml`` does the same from a shell.
"""

from __future__ import annotations

import inspect
import os
import sys
import types
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from .. import _native
from .._errors import BowknotWarning, InputError
from .._runs import Run
from . import _study, _table
from ._drive import drive, plan
from ._local import LocalPool
from ._progress import Printer, Progress
from ._store import place, store
from ._warnings import in_short, told

__all__ = ["Progress", "SweepResult", "sweep"]


class SweepResult:
    """What came of a sweep.

    Parameters
    ----------
    out : str
        The folder, or the URL.
    table : str
        The table in it; empty if none was written.
    rows : list of dict
        One per run, in the order of the study.
    warnings : iterable of (str, str)
        Runs and their warnings.
    """

    def __init__(
        self, out: str, table: str, rows: list[dict[str, Any]], warnings: Iterable[tuple[str, str]] = ()
    ) -> None:
        #: The folder of the study, or its URL.
        self.out = out
        #: Path or URL of the table; empty if the sweep was of one part.
        self.table = table
        #: The rows of the table.
        self.rows = rows
        #: The warnings of all runs, each behind the name of its run; `runs/HASH/sweep.json` has those of one.
        self.warnings = list(warnings)

    @property
    def failures(self) -> list[dict[str, Any]]:
        """The rows of runs that failed; ``reason`` says why."""
        return [entry for entry in self.rows if entry["status"] != "done"]

    def run(self, index: int) -> Run:
        """The folder of a run, by the index of its row; not of a URL."""
        return Run(os.path.join(self.out, self.rows[index]["folder"]))

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        return f"SweepResult({self.out!r}: {len(self.rows)} runs, {len(self.failures)} failed)"


def sweep(
    study: Mapping[str, Any] | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    backend: str = "local",
    address: str | None = None,
    workers: int | None = None,
    part: tuple[int, int] | None = None,
    progress: bool | Callable[[Progress], object] = True,
) -> SweepResult:
    """Makes the runs of a study that are not finished yet, and a table of all.

    Parameters
    ----------
    study : dict or path
        A study file, or a dict of its content: ``scene``, ``scale``, ``set``; ``grid``, ``case``, ``latin``, whose
        combinations are run; ``table``, ``check``, ``keep``, ``threads``, ``retries``, ``time_limit``.
    out : path, optional
        The folder, or a URL of fsspec. Default: that of the study.
    backend : {"local", "ray"}
        Where runs are made: processes of this machine, or tasks of Ray.
    address : str, optional
        The Ray cluster. Default: the one that runs on this machine, else a new one of this machine alone.
    workers : int, optional
        Number of runs at once. Default: as many as there are cores for.
    part : (int, int), optional
        Only the part ``i`` of ``n``, from 1; no table is written then.
    progress : bool or callable
        Whether progress is printed to the standard error stream, or what is called with it.

    Returns
    -------
    SweepResult
        The table and its rows.

    Warns
    -----
    BowknotWarning
        The first warnings of the runs, and how many more there are.

    Raises
    ------
    InputError
        What the study or a scene of it is refused for, before any run begins.
    KeyboardInterrupt
        Ctrl-C. Runs that are finished stay, others have a checkpoint; the same call goes on.

    Examples
    --------
    >>> import bowknot, tempfile
    >>> study = {"scene": "drape", "scale": 0.1, "set": {"simulation.frames": 2}, "table": "table.csv"}
    >>> study["grid"] = {"body.sheet.friction": [0.1, 0.3]}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = bowknot.sweep(study, out=folder, progress=False)
    >>> [(row["body.sheet.friction"], row["status"], row["last.converged"]) for row in done.rows]
    [(0.1, 'done', True), (0.3, 'done', True)]
    """
    if backend not in ("local", "ray"):
        raise InputError(f'backend: {backend!r} must be "local" or "ray"')
    if address is not None and backend != "ray":
        raise InputError('address: is that of a Ray cluster; give backend="ray" too')
    if workers is not None and not 1 <= int(workers) <= 10000:
        raise InputError(f"workers {workers}: it must be a whole number from 1 to 10000")
    if part is not None and not 1 <= part[0] <= part[1]:
        raise InputError(f"part {part[0]} of {part[1]}: the first number must be from 1 to the second")
    read = _study.read(study, out)
    _table.require(read.table)
    results = store(read.out)
    planned = plan(read)

    def pool() -> Any:
        if backend == "ray":
            from ._ray import RayPool

            return RayPool(address, read.threads, workers)
        return LocalPool(workers or max(1, _native.threads() // read.threads))

    tell = progress if callable(progress) else Printer() if progress else lambda _: None
    outcomes: dict[str, dict[str, Any]] = {}

    def finish() -> SweepResult:
        rows = [
            _table.row(index, case.values, case.run, place(case.run), outcomes.get(case.run, _PENDING))
            for index, case in enumerate(planned.cases)
            if not part or case.run in outcomes
        ]
        if not part:
            results.write(read.table, _table.content(read.table, rows, planned.keys))
        return SweepResult(read.out, "" if part else results.path(read.table), rows, told(planned.cases, outcomes))

    try:
        drive(read, planned, results, pool, part, tell, outcomes)
    except KeyboardInterrupt:
        # The table says what is left.
        finish()
        raise
    result = finish()
    if result.warnings:
        warnings.warn(in_short(result.warnings), BowknotWarning, stacklevel=2)
    return result


#: The outcome of a run that was not made.
_PENDING: dict[str, Any] = {"status": "pending", "reason": "", "columns": {}}


class _Module(types.ModuleType):
    """A module that is called as its function."""

    __call__ = staticmethod(sweep)


sys.modules[__name__].__class__ = _Module
#: What help and editors show of a call.
__signature__ = inspect.signature(sweep)
