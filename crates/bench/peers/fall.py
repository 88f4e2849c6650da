"""The scene of both cloth solvers: a sheet falls on a ball, or on a needle."""

import json
from dataclasses import dataclass

import numpy as np

import meshes

GRAVITY = 9.81
SIDE = 1.0
DROP = 0.12

# The first cloth material of Bowknot. Newton gets the Lame parameters of the membrane in plane stress, and a hinge
# stiffness with which a grid of this edge length bends about as much.
DENSITY, YOUNG, POISSON, BEND = 0.1503, 261.078, 0.243, 2.34e-6


@dataclass(frozen=True)
class Fall:
    obstacle: str
    side_vertices: int
    frames: int
    dt: float

    @property
    def name(self):
        return f"{self.obstacle}, {self.side_vertices} x {self.side_vertices} vertices"

    @property
    def edge(self):
        return SIDE / (self.side_vertices - 1)

    @property
    def sheet(self):
        """Points and triangles where it starts, above the obstacle's top at z = 0."""
        points, faces = meshes.flat_sheet(SIDE, self.side_vertices)
        # Off the center, so that no vertex is right above a tip.
        return points + [0.004, 0.002, DROP], faces

    @property
    def obstacle_mesh(self):
        if self.obstacle == "needle":
            return meshes.needle(0.05, 0.4)
        points, faces = meshes.ball(0.25)
        return points - [0.0, 0.0, 0.25], faces

    @property
    def lame(self):
        """mu and lambda of the membrane [N/m]."""
        return 0.5 * YOUNG / (1.0 + POISSON), YOUNG * POISSON / (1.0 - POISSON**2)

    @property
    def hinge_stiffness(self):
        return 3.0 * BEND / self.edge

    @property
    def flight(self):
        """Number of time steps before the sheet has fallen nine tenths of the way."""
        frames = 0
        while self.fallen(frames + 1) < 0.9 * DROP:
            frames += 1
        return frames

    def fallen(self, frames, substeps=1):
        """The distance that implicit Euler falls [m]: g h² n (n + 1) / 2."""
        steps, h = frames * substeps, self.dt / substeps
        return 0.5 * GRAVITY * h * h * steps * (steps + 1)

    def write(self, folder):
        """Meshes and a scene file for Bowknot."""
        for name, (points, faces) in (("sheet", self.sheet), ("obstacle", self.obstacle_mesh)):
            lines = ["v {!r} {!r} {!r}".format(*map(float, p)) for p in points]
            lines += ["f {} {} {}".format(*(f + 1)) for f in faces]
            (folder / f"{name}.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
        material = {
            "density": DENSITY,
            "stretch_stiffness": YOUNG,
            "poisson_ratio": POISSON,
            "bend_stiffness": BEND,
        }
        values = ", ".join(f"{key} = {value!r}" for key, value in material.items())
        text = [f"[simulation]\ndt = {self.dt!r}\nframes = {self.frames}\n"]
        text += [f'[[body]]\nname = "sheet"\nmesh = "sheet.obj"\nmaterial = {{ {values} }}\n']
        text += ['[[obstacle]]\nname = "obstacle"\nmesh = "obstacle.obj"\n']
        path = folder / "scene.toml"
        path.write_text("\n".join(text), encoding="utf-8")
        return path

    def archive(self, sheets, path):
        """Frames of the sheet with the obstacle, as `bowknot check` reads them."""
        (_, faces), (points, more) = self.sheet, self.obstacle_mesh
        n = sheets.shape[1]
        still = np.broadcast_to(points, (len(sheets), *points.shape))
        obstacle = np.arange(n + len(points)) >= n
        frames = np.concatenate([sheets, still], axis=1)
        np.savez(path, X=frames, F=np.concatenate([faces, more + n]), O=obstacle)
        return frames


@dataclass
class Motion:
    """A motion: frames of the sheet, the start included; seconds of each time step."""

    sheets: np.ndarray
    cpu: list
    wall: list
    substeps: int = 1


def read_steps(path):
    """CPU and wall seconds of each time step of a run of Bowknot."""
    with open(path, encoding="utf-8") as file:
        steps = [json.loads(line) for line in file]
    return [s["cpu_seconds"] for s in steps], [s["seconds"]["total"] for s in steps]
