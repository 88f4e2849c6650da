"""Designs of experiments: grids, lists, Latin hypercubes."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Range:
    """Where the values of a key lie."""

    low: float
    high: float
    #: Whether logarithms are spread evenly, not the values.
    log: bool = False
    #: Whether the values are whole numbers, both ends included.
    integer: bool = False

    @staticmethod
    def problem(given: Any) -> str | None:
        """What is wrong with a range as it is given, if anything."""
        if not isinstance(given, Mapping) or not {"low", "high"} <= given.keys():
            return "expected a table with low and high"
        unknown = sorted(given.keys() - {"low", "high", "log", "integer"})
        if unknown:
            return f"{unknown[0]}: unknown key; known here: low, high, log, integer"
        for key in ("log", "integer"):
            if not isinstance(given.get(key, False), bool):
                return f"{key}: expected true or false"
        low, high = given["low"], given["high"]
        for value in (low, high):
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
                return f"{value!r} must be a finite number"
        if low >= high:
            return f"low = {low} must be below high = {high}"
        if given.get("log") and low <= 0:
            return f"low = {low} must be above 0 with log"
        whole = all(float(value).is_integer() for value in (low, high))
        return None if whole or not given.get("integer") else "low and high must be whole numbers with integer"

    def at(self, share: float) -> float | int:
        """The value at a share of the range, from 0 to below 1."""
        low, high = float(self.low), float(self.high) + self.integer
        if self.log:
            value = math.exp(math.log(low) + share * (math.log(high) - math.log(low)))
            # The last digits of logarithms differ between systems, and another value is another run.
            value = float(f"{value:.12g}")
        else:
            value = low + share * (high - low)
        value = min(max(value, low), high)
        return min(math.floor(value), int(self.high)) if self.integer else value


def cases(
    grid: Mapping[str, list[Any]],
    listed: list[dict[str, Any]],
    ranges: Mapping[str, Range],
    samples: int,
    seed: int,
) -> Iterator[dict[str, Any]]:
    """Keys and values of each run: each combination of the grid with each entry of the list and each sample."""
    points = latin_hypercube(ranges, samples, seed) if ranges else [{}]
    for combination in itertools.product(*grid.values()):
        for entry in listed or [{}]:
            for point in points:
                yield {**dict(zip(grid, combination)), **entry, **point}


def latin_hypercube(ranges: Mapping[str, Range], samples: int, seed: int) -> list[dict[str, float | int]]:
    """Points of which each key has one in each of as many equal parts of its range: McKay, Beckman and Conover,
    Technometrics 21 (1979), 239-245. The values of a key depend on the seed and its name alone."""
    columns = {}
    for key, spread in ranges.items():
        # Of the generator only `random` is the same in all versions of Python.
        generator = random.Random(f"{seed} {key}")
        order = [generator.random() for _ in range(samples)]
        parts = sorted(range(samples), key=order.__getitem__)
        columns[key] = [spread.at((part + generator.random()) / samples) for part in parts]
    return [{key: column[index] for key, column in columns.items()} for index in range(samples)]
