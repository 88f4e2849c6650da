"""The warnings of runs, as a sweep tells them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ._drive import Case, named

#: How many warnings are told; the files of the runs have all.
_TOLD = 5


def told(cases: Iterable[Case], outcomes: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """The warnings of all runs, each with the name of its run; of runs that are the same, once."""
    first = {case.run: named(index, case.values) for index, case in reversed(list(enumerate(cases)))}
    of_run = ((first[run], outcomes[run].get("warnings", ())) for run in reversed(first) if run in outcomes)
    return [f"{name}: {text}" for name, texts in of_run for text in texts]


def in_short(warnings: list[str]) -> str:
    """The first warnings, one per line, and how many more there are."""
    more = len(warnings) - _TOLD
    rest = [f"and {more} more: the column `warnings` counts them, sweep.json of each run has them"] if more > 0 else []
    return "\n".join(warnings[:_TOLD] + rest)
