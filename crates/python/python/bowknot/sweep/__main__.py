"""``python -m bowknot.sweep study.toml``."""

from __future__ import annotations

import argparse
import signal
import sys
import warnings

from . import SweepResult, sweep
from .._errors import BowknotError, BowknotWarning, InputError
from ._warnings import in_short

#: How many failures are listed; the table has all.
_LISTED = 20


def main(arguments: list[str] | None = None) -> int:
    """The exit code: 0, 1 if a run failed, 2 if the study is refused, 4 on other errors, 130 after Ctrl-C."""
    parser = argparse.ArgumentParser("python -m bowknot.sweep", description="Makes all runs of a study and a table.")
    parser.add_argument("study", help="study file, TOML")
    parser.add_argument("--out", help="folder or URL of the results; default: that of the study")
    parser.add_argument("--workers", type=int, help="runs at once; default: as many as there are cores for")
    parser.add_argument("--ray", action="store_true", help="make the runs on a Ray cluster")
    parser.add_argument("--address", help="the Ray cluster; default: the one that this machine belongs to")
    parser.add_argument("--part", type=_part, metavar="I/N", help="only part I of N, from 1, without a table")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    given = parser.parse_args(arguments)
    # Batch systems end jobs by SIGTERM: as Ctrl-C does, with checkpoints.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # They are told without the place in this file.
    warnings.simplefilter("ignore", BowknotWarning)
    try:
        result = sweep(
            given.study,
            out=given.out,
            backend="ray" if given.ray else "local",
            address=given.address,
            workers=given.workers,
            part=given.part,
            progress=not given.quiet,
        )
    except KeyboardInterrupt:
        print("\ninterrupted; the same command goes on", file=sys.stderr)
        return 130
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except BowknotError as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    _tell(result)
    return 1 if result.failures else 0


def _part(text: str) -> tuple[int, int]:
    """Two numbers with a slash between them."""
    first, _, second = text.partition("/")
    return int(first), int(second)


def _tell(result: SweepResult) -> None:
    if result.warnings:
        print(f"warning: {in_short(result.warnings)}", file=sys.stderr)
    for entry in result.failures[:_LISTED]:
        print(f"run {entry['run']} failed: {entry['reason']} ({entry['folder']})", file=sys.stderr)
    if len(result.failures) > _LISTED:
        print(f"and {len(result.failures) - _LISTED} others: see the table", file=sys.stderr)
    if result.table:
        print(result.table)


if __name__ == "__main__":
    sys.exit(main())
