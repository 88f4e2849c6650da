#!/usr/bin/env python3
"""Makes all comparisons, or the ones named; full runs rewrite section peers of docs/benchmarks.md.

A peer that is not installed is skipped. The page takes each comparison from its last full run.
"""

import subprocess
import sys
from pathlib import Path

import results
import setting

NAMES = ["proximity", "projection", "cloth"]


def compare(name, options):
    """Makes one comparison in a process of its own; whether it came to an end."""
    command = [sys.executable, Path(__file__).with_name(f"{name}.py"), "--out", options.out]
    command += ["--quick"] if options.quick else []
    command += ["--turns", str(options.turns)] if options.turns else []
    # Its figures go to the terminal as they come; a reason to skip it comes last, on stderr.
    return subprocess.run(command, check=False).returncode == 0


def rewrite_page(out):
    """From the sections that full runs left."""
    files = {name: out / "full" / name / "section.md" for name in NAMES}
    missing = [name for name, file in files.items() if not file.exists()]
    if missing:
        print(f"{results.PAGE} is left alone: no full run of {', '.join(missing)} in {out} yet")
        return
    results.rewrite([file.read_text(encoding="utf-8") for file in files.values()])
    print(f"rewrote section peers of {results.PAGE}")


def main():
    parser = setting.arguments(__doc__, threads=None)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)} [default: all]"
    )
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in NAMES]
    if unknown:
        parser.error(f"no comparison {unknown[0]!r}; there are {', '.join(NAMES)}")
    skipped = [name for name in options.names or NAMES if not compare(name, options)]
    if not options.quick:
        rewrite_page(options.out)
    if skipped:
        sys.exit(f"error: not made, see above: {', '.join(skipped)}")


if __name__ == "__main__":
    try:
        main()
    except setting.Unusable as error:
        sys.exit(f"error: {error}")
