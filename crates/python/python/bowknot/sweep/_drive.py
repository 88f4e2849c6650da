"""A sweep: which runs there are, which are left to make, and making them."""

from __future__ import annotations

import collections
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from .. import _native
from .._errors import InputError
from ._progress import Progress
from ._resolve import Resolver
from ._store import LocalStore, RemoteStore
from ._study import Study

#: How often progress is told while no run ends [s].
_TICK = 0.5

#: How long the first run may take to appear where machines share files [s].
_PATIENCE = 60.0

#: How many problems of a study are listed.
_LISTED = 10


class Pool(Protocol):
    """Where runs are made."""

    @property
    def has_room(self) -> bool: ...
    def submit(self, run: str, job: dict[str, Any]) -> None: ...
    def next(self, seconds: float) -> tuple[str, dict[str, Any]] | None: ...
    def close(self) -> None: ...


@dataclass(frozen=True)
class Case:
    """One row of the table."""

    #: The keys that are varied, and their values.
    values: dict[str, Any]
    #: The hash of its run. Cases that make the same scene have the same run.
    run: str


@dataclass(frozen=True)
class Plan:
    """The runs of a study."""

    cases: list[Case]
    resolver: Resolver

    @property
    def keys(self) -> list[str]:
        """The keys that are varied."""
        return list(dict.fromkeys(key for case in self.cases for key in case.values))


def plan(study: Study) -> Plan:
    """Resolves every scene of a study.

    Raises
    ------
    InputError
        What scenes are refused for, with the first case of each problem.
    """
    resolver = Resolver(study)
    cases: list[Case] = []
    problems: dict[str, str] = {}
    for index, values in enumerate(study.cases()):
        try:
            cases.append(Case(values, resolver.hash(resolver.scene(values).to_toml(short=False))))
        except InputError as error:
            problems.setdefault(str(error).removeprefix("assignment: "), named(index, values))
    if problems:
        listed = [f"{where}: {problem}" for problem, where in problems.items()]
        more = [f"and {len(listed) - _LISTED} other problems"] if len(listed) > _LISTED else []
        raise InputError("\n".join(listed[:_LISTED] + more))
    return Plan(cases, resolver)


def named(index: int, values: dict[str, Any]) -> str:
    """A run in words, with the values that it has."""
    words = ", ".join(f"{key} = {value!r}" for key, value in values.items())
    return f"run {index} ({words})" if words else f"run {index}"


def drive(
    study: Study,
    planned: Plan,
    results: LocalStore | RemoteStore,
    make_pool: Callable[[], Pool],
    part: tuple[int, int] | None,
    tell: Callable[[Progress], object],
    outcomes: dict[str, dict[str, Any]],
) -> None:
    """Makes the runs that are left, and puts the outcomes of all into `outcomes` as they become known."""
    values = {case.run: case.values for case in reversed(planned.cases)}
    runs = list(dict.fromkeys(case.run for case in planned.cases))
    if part:
        runs = runs[part[0] - 1 :: part[1]]
    outcomes.update(results.outcomes(runs))
    progress = _Counts(len(runs), len(outcomes), tell)
    waiting = collections.deque(run for run in runs if run not in outcomes)
    progress.tell()
    if not waiting:
        return
    tries: collections.Counter[str] = collections.Counter()
    left, seen = len(waiting), False
    pool = make_pool()
    try:
        while left:
            while waiting and pool.has_room:
                run = waiting.popleft()
                tries[run] += 1
                pool.submit(run, _job(study, planned, run, values[run], tries[run]))
            ended = pool.next(_TICK)
            if ended:
                run, outcome = ended
                if outcome["status"] == "done" and not seen:
                    seen = True
                    _see(study, results, run, outcome)
                if outcome["status"] == "lost" and tries[run] <= study.retries:
                    waiting.append(run)
                    progress.retried += 1
                else:
                    outcomes[run] = _final(outcome, tries[run])
                    left -= 1
                    progress.done += outcome["status"] == "done"
                    progress.failed += outcome["status"] != "done"
            progress.tell()
    finally:
        pool.close()


def _see(study: Study, results: LocalStore | RemoteStore, run: str, outcome: dict[str, Any]) -> None:
    """Refuses a folder that workers do not share with this process."""
    until = time.monotonic() + _PATIENCE
    while not results.outcomes([run]):
        if time.monotonic() > until:
            host = outcome["columns"]["cost.host"]
            raise InputError(
                f"out = {study.out!r}: run {run} of the worker on {host} is not here; give a folder that all machines "
                "share under this path, or a URL"
            )
        time.sleep(1.0)


def _job(study: Study, planned: Plan, run: str, values: dict[str, Any], tries: int) -> dict[str, Any]:
    return {
        "run": run,
        "tries": tries,
        "scene": planned.resolver.scene(values).to_toml(short=False),
        "out": study.out,
        "check": study.check,
        "keep": study.keep,
        "threads": study.threads,
        "time_limit": study.time_limit,
        "version": _native.__version__,
    }


def _final(outcome: dict[str, Any], tries: int) -> dict[str, Any]:
    """The outcome of a run that is not tried again."""
    outcome = {**outcome, "columns": {**outcome["columns"], "cost.tries": tries}}
    if outcome["status"] == "lost":
        times = "once" if tries == 1 else f"{tries} times"
        outcome.update(status="failed", reason=f"lost {times}: {outcome['reason']}")
    return outcome


class _Counts:
    """Counts of a sweep."""

    def __init__(self, total: int, found: int, tell: Callable[[Progress], object]) -> None:
        self.total, self.found, self.done = total, found, found
        self.failed = self.retried = 0
        self._tell, self._since = tell, time.monotonic()

    def tell(self) -> None:
        seconds = time.monotonic() - self._since
        self._tell(Progress(self.total, self.done, self.found, self.failed, self.retried, seconds))
