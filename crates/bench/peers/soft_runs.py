"""One scene in rapier's soft bodies or in Bowknot: the scenes of `rapier/src/scenes.rs` and `soft_scenes`."""

import json
import shutil
import tomllib
from dataclasses import dataclass
from pathlib import Path

import fall
import frames
import setting

SCENES = Path(__file__).with_name("soft_scenes")


@dataclass(frozen=True)
class Program:
    """A program with its settings; options are those of its command."""

    name: str
    options: tuple = ()
    dt: float = 0.01
    bowknot: bool = False


@dataclass(frozen=True)
class Case:
    """A scene in one size."""

    scene: str
    size: int
    seconds: float
    # Every so many of the frames are kept and judged.
    every: int = 1

    @property
    def name(self):
        return f"{self.scene} {self.size}"


@dataclass
class Run:
    """What a run took, and its frames."""

    cpu: float
    wall: float
    frames: frames.Frames
    intersecting: int
    # Time between two frames [s].
    interval: float


def run(case, program, folder):
    """Simulates, judges all frames that are kept, and removes them."""
    setting.clear(folder)
    folder.mkdir(parents=True, exist_ok=True)
    result = (_bowknot if program.bowknot else _rapier)(case, program, folder)
    setting.clear(folder)
    return result


def _rapier(case, program, folder):
    options = ["--out", folder, "--size", case.size, "--seconds", case.seconds, "--dt", program.dt]
    options += ["--every", case.every, *program.options]
    report = json.loads(setting.call([setting.program("rapier"), case.scene, *options]))
    return Run(report["cpu_s"], report["wall_s"], *_judge(folder, case, program))


def _bowknot(case, program, folder):
    setting.call([setting.program("rapier"), case.scene, "--meshes", "--out", folder, "--size", case.size])
    shutil.copyfile(SCENES / f"{case.scene}.toml", folder / "scene.toml")
    steps = round(case.seconds / program.dt)
    options = ["--frames", steps, "--dt", program.dt, "--threads", 1, "--quiet", *program.options]
    run = folder / "run"
    setting.call([setting.program("bowknot"), "run", folder / "scene.toml", "--out", run, *options])
    # The command writes every frame.
    for number, path in enumerate(sorted((run / "frames").glob("*.ply"))):
        if number % case.every:
            path.unlink()
    cpu, wall = fall.read_steps(run / "stats.jsonl")
    return Run(sum(cpu), sum(wall), *_judge(run, case, program))


def _judge(folder, case, program):
    kept = folder / "frames"
    return frames.read(kept), frames.intersecting(kept), case.every * program.dt


def version():
    """The version of rapier in the manifest of the program that was built."""
    manifest = (Path(__file__).with_name("rapier") / "Cargo.toml").read_text(encoding="utf-8")
    return tomllib.loads(manifest)["dependencies"]["rapier3d"]["version"].lstrip("=")
