#!/usr/bin/env python3
"""Makes all comparisons, or the ones named. Full runs write the block on peers of docs/benchmarks.md
and the tables peers-*.csv, from a clean git tree only.

A comparison is skipped with a message if its peer is not installed. The page shows the last full run of
each comparison; those that were not made here stay on it as they are.
"""

import subprocess
import sys
from pathlib import Path

import results
import setting

NAMES = ["proximity", "projection", "planar", "cloth", "soft", "pinch", "layers"]


def compare(name, options):
    """Makes one comparison in a process of its own; returns whether it succeeded."""
    command = [sys.executable, Path(__file__).with_name(f"{name}.py"), "--out", options.out]
    command += ["--quick"] if options.quick else []
    command += ["--turns", str(options.turns)] if options.turns else []
    # It prints its results as they come, and a reason to skip it last, on stderr.
    return subprocess.run(command, check=False).returncode == 0


def publish(out):
    """Writes the results of full runs into the page; others stay there as they are."""
    folders = {name: out / "full" / name for name in NAMES}
    found = {name: folder for name, folder in folders.items() if (folder / "section.md").exists()}
    results.publish(found, NAMES)
    print(f"wrote {', '.join(found)} to {results.PAGE}")


def main():
    parser = setting.arguments(__doc__, threads=None)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)} [default: all]"
    )
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in NAMES]
    if unknown:
        parser.error(f"no comparison {unknown[0]!r}; there are {', '.join(NAMES)}")
    if not options.quick:
        # Before the measurements, not after them.
        results.ensure_clean()
    skipped = [name for name in options.names or NAMES if not compare(name, options)]
    if not options.quick:
        publish(options.out)
    if skipped:
        sys.exit(f"error: skipped or failed, see above: {', '.join(skipped)}")


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
