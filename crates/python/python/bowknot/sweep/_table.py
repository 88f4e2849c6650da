"""The table of a study: one row per run."""

from __future__ import annotations

import csv
import importlib.util
import io
import json
from collections.abc import Iterable, Mapping
from typing import Any

from .._errors import InputError

#: What the names of columns begin with that may differ from one sweep to the next: times, memory, work, machines.
COST = "cost."

#: Columns that each row has.
FIRST = ("run", "hash", "folder", "status", "reason")

#: Numbers of summaries and statistics that depend on the machine, or on what is remembered of time steps before:
#: after a run goes on from a checkpoint, more pairs may be looked at for the same result.
_COSTS = ("seconds", "cpu_seconds", "peak_memory_bytes", "threads", "device", "pairs", "searches", "skipped")

#: Parts of a summary that have columns of another name, or are the same in each line of statistics.
_LEFT_OUT = ("scene", "step", "time")


def columns(summary: Mapping[str, Any], stats: list[dict[str, Any]]) -> dict[str, Any]:
    """The numbers of a finished run by column: those of its summary, with `mean.` and `max.` of its statistics, and
    `last.` of the last time step."""
    found = _numbers(summary, "")
    if stats:
        found.update(_numbers(stats[-1], "last."))
    return found


def _numbers(value: Any, name: str) -> dict[str, Any]:
    """Numbers and texts within `value` by their path. Vectors have components x, y, z; other lists are left out."""
    if isinstance(value, Mapping):
        found: dict[str, Any] = {}
        for key, entry in value.items():
            if key not in _LEFT_OUT or name not in ("", "last."):
                is_cost = key in _COSTS and not name.startswith(COST)
                found.update(_numbers(entry, f"{COST if is_cost else ''}{name}{key}."))
        return found
    if isinstance(value, list):
        if len(value) != 3 or not all(isinstance(entry, (int, float)) for entry in value):
            return {}
        return {f"{name}{axis}": float(entry) for axis, entry in zip("xyz", value)}
    return {name[:-1]: value}


def row(index: int, values: Mapping[str, Any], run: str, folder: str, outcome: Mapping[str, Any]) -> dict[str, Any]:
    """The row of a run."""
    first = dict(zip(FIRST, (index, run, folder, outcome["status"], outcome["reason"])))
    return {**first, **values, **outcome["columns"]}


def ordered(rows: Iterable[Mapping[str, Any]], keys: Iterable[str]) -> list[str]:
    """The columns of a table: what each row has, the keys that are varied, results by name, costs."""
    head = list(dict.fromkeys([*FIRST, *keys]))
    rest = {name for entry in rows for name in entry} - set(head)
    return head + sorted(rest, key=lambda name: (name.startswith(COST), name))


def require(name: str) -> None:
    """Refuses a table that could not be written."""
    if name.endswith(".parquet") and importlib.util.find_spec("pyarrow") is None:
        raise InputError(f"table = {name!r}: needs pyarrow: pip install pyarrow, or a name that ends in .csv or .jsonl")


def content(name: str, rows: list[dict[str, Any]], keys: Iterable[str]) -> bytes:
    """The file of a table; the ending of its name decides the format."""
    names = ordered(rows, keys)
    data = {column: _uniform([entry.get(column) for entry in rows]) for column in names}
    if name.endswith(".parquet"):
        import pyarrow
        import pyarrow.parquet

        table = pyarrow.table({column: pyarrow.array(values) for column, values in data.items()})
        buffer = pyarrow.BufferOutputStream()
        pyarrow.parquet.write_table(table, buffer)
        return bytes(buffer.getvalue())
    text = io.StringIO()
    if name.endswith(".csv"):
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(names)
        writer.writerows(zip(*data.values()))
    else:
        for values in zip(*data.values()):
            text.write(json.dumps(dict(zip(names, values))) + "\n")
    return text.getvalue().encode()


def _uniform(values: list[Any]) -> list[Any]:
    """Values of one type: numbers, flags, texts. Others become JSON."""
    given = [value for value in values if value is not None]
    if all(isinstance(value, bool) for value in given) or all(isinstance(value, str) for value in given):
        return values
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in given):
        if all(isinstance(value, int) and abs(value) < 2**63 for value in given):
            return values
        return [None if value is None else float(value) for value in values]
    return [None if value is None else json.dumps(value, default=str) for value in values]
