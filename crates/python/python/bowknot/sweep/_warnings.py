"""The warnings of runs, as a sweep tells them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ._drive import Case, named

#: How many different warnings are told; the files of the runs have all.
_TOLD = 5


def told(cases: Iterable[Case], outcomes: Mapping[str, Mapping[str, Any]]) -> list[tuple[str, str]]:
    """The warnings of all runs, each with the name of its run before it; of runs that are the same, once."""
    first = {case.run: named(index, case.values) for index, case in reversed(list(enumerate(cases)))}
    of_run = ((first[run], outcomes[run].get("warnings", ())) for run in reversed(first) if run in outcomes)
    return [(name, text) for name, texts in of_run for text in texts]


def in_short(warnings: list[tuple[str, str]]) -> str:
    """The first warnings, one per line, with the first run that has it, and how many more there are."""
    runs: dict[str, list[str]] = {}
    for name, text in warnings:
        runs.setdefault(text, []).append(name)
    lines = []
    for text, names in list(runs.items())[:_TOLD]:
        others = len(names) - 1
        also = f" and {others} other {'run' if others == 1 else 'runs'}" if others else ""
        lines.append(f"{names[0]}{also}: {text}")
    if len(runs) > _TOLD:
        more = len(runs) - _TOLD
        lines.append(f"and {more} more: the column `warnings` counts them, sweep.json of each run has them")
    return "\n".join(lines)
