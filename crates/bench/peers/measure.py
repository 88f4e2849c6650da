"""Times two programs in turns, and describes the machine."""

import json
import os
import platform
import statistics
import subprocess
import time
from dataclasses import dataclass, field

from setting import REPOSITORY


@dataclass
class Times:
    """Seconds of several runs; CPU seconds are user and system time of all threads."""

    cpu: list = field(default_factory=list)
    wall: list = field(default_factory=list)

    def add(self, cpu, wall):
        self.cpu.append(cpu)
        self.wall.append(wall)


class Timer:
    """CPU and wall seconds of this process since it was made."""

    def __init__(self):
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def cpu(self):
        return time.process_time() - self._cpu

    def wall(self):
        return time.perf_counter() - self._wall


def in_turn(first, second, turns):
    """Calls both, in reverse order every second time: a machine that slows down slows both."""
    for turn in range(turns):
        for run in (first, second) if turn % 2 == 0 else (second, first):
            run()


def ratios(above, below):
    """Quotients of what was measured in the same turn."""
    return [a / b for a, b in zip(above, below, strict=True)]


median = statistics.median


@dataclass(frozen=True)
class Spread:
    """The median of several values, and the smallest and largest, as text."""

    median: str
    low: str
    high: str

    def __str__(self):
        return self.median if self.low == self.high else f"{self.median} ({self.low} to {self.high})"


def spread(values):
    """The spread of values with three significant digits."""
    return Spread(*(plain(value) for value in (median(values), min(values), max(values))))


def plain(value, digits=3):
    """A number for a CSV file, with so many significant digits."""
    return number(value, digits).replace(",", "")


def number(value, digits=3):
    """A number with so many significant digits, in plain notation."""
    if value is None:
        return ""
    if value == 0:
        return "0"
    size = len(str(int(abs(value)))) if abs(value) >= 1 else 0
    if size >= digits:
        return f"{value:,.0f}"
    text = f"{value:.{digits}g}"
    return text if "e" in text else f"{value:.{max(digits - size, 0)}f}" if size else text


class Kept:
    """What was measured so far, in a file, so that a run that was stopped goes on."""

    def __init__(self, path):
        self._path = path
        self._values = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        # The commits of what was asked for.
        self.commits = []

    def get(self, key, make):
        """The value of that name, which is made now if it is not there."""
        if key not in self._values:
            self._values[key] = {"commit": _commit(), "value": make()}
            self._path.write_text(json.dumps(self._values, indent=1), encoding="utf-8")
        if self._values[key]["commit"] not in self.commits:
            self.commits.append(self._values[key]["commit"])
        return self._values[key]["value"]

    def clear(self):
        """Forgets all: the run is over."""
        self._path.unlink(missing_ok=True)


def conditions(versions, threads, load_before, commits=None):
    """The commits, by default the present one, the versions and the machine, in one line."""
    info = _lines("/proc/cpuinfo")
    cpu = next((line.split(":", 1)[1].strip() for line in info if "model name" in line), None)
    peers = ", ".join(f"{name} {version}" for name, version in versions.items())
    return (
        f"Commit {', '.join(commits or [_commit()])}; {peers}, Python {platform.python_version()}; {threads} of "
        f"{os.cpu_count()} cores, {cpu or platform.processor() or 'an unknown CPU'}; "
        f"load average {load_before} before, {load()} after."
    )


def load():
    """The load average of the last minute."""
    return f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"


def _commit():
    hash_of_head = _git("rev-parse", "--short", "HEAD")
    changes = _git("status", "--porcelain", "--", "crates", "Cargo.toml", "Cargo.lock")
    if hash_of_head is None or changes is None:
        return "unknown"
    return f"{hash_of_head} with changes" if changes else hash_of_head


def _git(*words):
    try:
        done = subprocess.run(
            ["git", *words], cwd=REPOSITORY, capture_output=True, text=True, check=False
        )
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def _lines(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read().splitlines()
    except OSError:
        return []
