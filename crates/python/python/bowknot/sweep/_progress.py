"""How far a sweep is."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass

#: How often a line is printed where lines cannot be written over [s].
_EVERY = 10.0


@dataclass(frozen=True)
class Progress:
    """How far a sweep is."""

    #: Runs of the study, without those that are the same as another one.
    total: int
    #: Finished runs, those found included.
    done: int
    #: Runs that were finished before.
    found: int
    #: Runs that failed.
    failed: int
    #: Runs whose worker was lost and that are tried again, each time counted.
    retried: int
    #: Since the sweep began [s].
    seconds: float

    @property
    def left(self) -> int:
        """Runs that are made or wait."""
        return self.total - self.done - self.failed

    @property
    def seconds_left(self) -> float | None:
        """What the rest may take at the rate so far [s]; None before a run has ended."""
        ended = self.done - self.found + self.failed
        return self.seconds / ended * self.left if ended else None

    def __str__(self) -> str:
        parts = [f"{self.done} of {self.total} runs done"]
        parts += [f"{self.found} of them before"] if self.found else []
        parts += [f"{self.failed} failed"] if self.failed else []
        parts += [f"{self.retried} lost and tried again"] if self.retried else []
        parts += [f"{self.left} left"] if self.left else []
        parts += [f"{_clock(self.seconds)} so far"]
        if self.left and self.seconds_left is not None:
            parts += [f"about {_clock(self.seconds_left)} to go"]
        return ", ".join(parts)


class Printer:
    """Prints progress: over one line on a terminal, else a line at times."""

    def __init__(self) -> None:
        self._last = -_EVERY
        self._width = 0

    def __call__(self, progress: Progress) -> None:
        text = str(progress)
        if sys.stderr.isatty():
            end = "\n" if progress.left == 0 else ""
            print(f"\r{text.ljust(self._width)}", end=end, file=sys.stderr, flush=True)
            self._width = len(text)
        elif progress.left == 0 or time.monotonic() - self._last >= _EVERY:
            self._last = time.monotonic()
            print(text, file=sys.stderr, flush=True)


def _clock(seconds: float) -> str:
    whole = int(seconds + 0.5)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"
