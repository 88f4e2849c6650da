#!/usr/bin/env python3
"""Runs one scene in one solver, in a process of its own: python simulation.py PEER SCENE FOLDER COMMAND

Writes FOLDER/motion.npz with the positions of the surfaces of all bodies, `x[f,n,3]` in m, and FOLDER/run.json.
"""

import json
import pathlib
import resource
import sys
import time

import numpy as np

import scenes


def main():
    peer, name, folder, command = sys.argv[1:]
    folder, scene = pathlib.Path(folder), scenes.SCENES[name]()
    if peer == "bowknot":
        import bowknot_run as module

        solver, motion = module.version(command), module.simulate(scene, command, folder)
    else:
        module = __import__({"newton": "newton_vbd", "mujoco": "mujoco_flex", "rapier": "rapier_soft"}[peer])
        solver, motion = module.VERSION, module.simulate(scene)
    # The first frame is the start: making the model and compiling kernels are not counted. Bowknot's command does
    # all in one.
    frames = [next(motion)] if peer != "bowknot" else []
    cpu, wall = seconds(), time.perf_counter()
    frames += list(motion)
    cpu, wall = seconds() - cpu, time.perf_counter() - wall
    x = np.array(frames, dtype=np.float64)
    if x.shape[1] == sum(len(body.x) for body in scene.bodies):
        starts = np.cumsum([0] + [len(body.x) for body in scene.bodies])[:-1]
        x = x[:, np.concatenate([k + body.outside() for k, body in zip(starts, scene.bodies, strict=True)])]
    np.savez_compressed(folder / "motion.npz", x=x)
    run = {"solver": solver, "settings": module.EXAMPLES[name], "cpu_s": cpu, "wall_s": wall}
    (folder / "run.json").write_text(json.dumps(run, indent=1) + "\n")


def seconds():
    """User and system time of this process and those that it ran [s]."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


main()
