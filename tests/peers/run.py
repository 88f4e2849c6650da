#!/usr/bin/env python3
"""Simulates three scenes in four solvers and judges them all: `cargo xtask peers` runs it.

    python run.py --bowknot COMMAND [--out DIR] [--again] [PEER/SCENE ..]

A run that is in DIR already is judged again, but not made again unless --again is given; names limit what is made to
these. The table of docs/judge.md, its CSV and pictures are written from all runs in DIR, if there is one of each.
"""

import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

import judging
import page
from scenes import SCENES

PEERS = ("bowknot", "newton", "mujoco", "rapier")
ROOT = pathlib.Path(__file__).resolve().parents[2]


def simulate(peer, scene, folder, command):
    """Makes the run; returns whether it succeeded. What the solver prints goes to a file."""
    print(f"{peer}/{scene}: simulates", flush=True)
    script = pathlib.Path(__file__).with_name("simulation.py")
    with open(folder / "log.txt", "w") as log:
        arguments = [sys.executable, script, peer, scene, ".", command]
        done = subprocess.run(arguments, cwd=folder, stdout=log, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        last = (folder / "log.txt").read_text().strip().splitlines()[-1:]
        print(f"{peer}/{scene}: failed: {' '.join(last)}; see {folder / 'log.txt'}", file=sys.stderr)
    return done.returncode == 0


def measure(peer, name, folder, command):
    """One row of the table."""
    scene = SCENES[name]()
    with np.load(folder / "motion.npz") as archive:
        motion = archive["x"]
    judging.write_frames(scene, motion, folder / "frames")
    report = judging.judge(scene, command, folder / "frames", folder)
    run = json.loads((folder / "run.json").read_text())
    row = {"scene": name, "solver": run["solver"], "settings": run["settings"]}
    row |= judging.figures(scene, motion, report) | {"cpu_s": run["cpu_s"]}
    print(f"{peer}/{name}: {row}", flush=True)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bowknot", type=pathlib.Path, required=True, metavar="COMMAND")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "peers", help="default: out/peers")
    parser.add_argument("--again", action="store_true", help="simulate again what is there")
    names = [f"{peer}/{scene}" for scene in SCENES for peer in PEERS]
    parser.add_argument("names", nargs="*", metavar="PEER/SCENE", help=f"of {', '.join(names)} [default: all]")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in names]
    if unknown:
        parser.error(f"no run {unknown[0]!r}; there are {', '.join(names)}")
    command, failed, rows = options.bowknot.resolve(), [], []
    for name in names:
        peer, scene = name.split("/")
        folder = options.out.resolve() / f"{peer}-{scene}"
        made = (folder / "run.json").exists()
        if (not options.names or name in options.names) and (options.again or not made):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "run.json").unlink(missing_ok=True)
            made = simulate(peer, scene, folder, command)
            if not made:
                failed.append(name)
        if made:
            rows.append((measure(peer, scene, folder, command), folder))
    if len(rows) == len(names):
        page.write(ROOT, rows)
    else:
        print(f"docs/judge.md is not written: {len(rows)} of {len(names)} runs are there")
    if failed:
        sys.exit(f"error: {', '.join(failed)} failed")


if __name__ == "__main__":
    main()
