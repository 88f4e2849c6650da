"""The repository, its programs, the peers, and the options of all comparisons."""

import argparse
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[3]
REQUIREMENTS = "crates/bench/peers/requirements.txt"

# The libraries below NumPy and SciPy read these when they are loaded. CPU seconds must not include
# threads that only wait. So this module is imported before NumPy.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

if importlib.util.find_spec("numpy") is None:
    sys.exit(f"error: numpy is not installed: pip install -r {REQUIREMENTS}")


class Unusable(Exception):
    """A comparison that cannot be made; the message says what is missing and how to get it."""


class PeerMissing(Unusable):
    """The other program is not installed."""


def peer(name):
    """The module `name` of a peer."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise PeerMissing(
            f"{name} cannot be imported ({error}): pip install -r {REQUIREMENTS}"
        ) from error


_RAPIER = "crates/bench/peers/rapier"
# Where a program's target folder is, its path in there, and how it is built.
_PROGRAMS = {
    "bowknot": ("", "bowknot", "cargo build --release"),
    "peer_search": ("", "examples/peer_search", "cargo build --release -p bowknot-bench --example peer_search"),
    "peer_forward": ("", "examples/peer_forward", "cargo build --release -p bowknot-bench --example peer_forward"),
    "rapier": (_RAPIER, "bowknot-peer-rapier", f"cargo build --release --manifest-path {_RAPIER}/Cargo.toml"),
}


def program(name):
    """Path of a built program: `bowknot`, an example of `bowknot-bench`, or `rapier`, which is a workspace of its own."""
    workspace, place, build = _PROGRAMS[name]
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / workspace / "target"))
    path = target / "release" / place
    for candidate in (path, path.with_suffix(".exe")):
        if candidate.exists():
            return candidate
    raise Unusable(f"{path} is not there: {build}")


def call(command, accept=(0,)):
    """Standard output of a program that must end with one of the exit codes `accept`."""
    command = [str(word) for word in command]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in accept:
        last = (done.stderr.strip() or done.stdout.strip() or "no message")[-2000:]
        raise Unusable(f"{' '.join(command)}\nended with exit code {done.returncode}: {last}")
    return done.stdout


def clear(folder):
    """Removes the files of an earlier run: `bowknot run` refuses a folder with a run in it."""
    for path in sorted(folder.rglob("*"), reverse=True):
        if path.is_dir():
            path.rmdir()
        else:
            path.unlink()


def arguments(description, threads):
    """The options that all comparisons have."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="smaller inputs, about a minute")
    parser.add_argument(
        "--turns", type=_count, help="number of turns in which both are timed [default: 1 to 5]"
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=REPOSITORY / "out" / "bench" / "peers",
        help="folder for results and inputs [default: out/bench/peers]",
    )
    if threads:
        parser.add_argument(
            "--threads",
            type=_count,
            nargs="+",
            default=threads,
            help=f"numbers of threads that both are limited to [default: {threads}]",
        )
    return parser


def _count(text):
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise argparse.ArgumentTypeError("must be a whole number from 1")
    return number
