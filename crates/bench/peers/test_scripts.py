"""Tests of what needs no other program: python -m unittest test_scripts, in this folder."""

import math
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

import frames
import layers
import results
import soft


def write_ply(path, x, faces):
    """One body of triangles, and a plane's quad as Bowknot writes it."""
    count = len(x)
    vertices = np.zeros(count + 4, frames._KIND)
    vertices["x"][:count] = x
    vertices["obstacle"][count:] = 1
    vertices["body"][count:] = 1
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {count + 4}\nelement face {len(faces) + 1}\nend_header\n"
    )
    data = b"".join(b"\x03" + np.array(face, "<i4").tobytes() for face in faces)
    quad = b"\x04" + np.arange(count, count + 4, dtype="<i4").tobytes()
    path.write_bytes(header.encode() + vertices.tobytes() + data + quad)


class Page(unittest.TestCase):
    def test_sections_that_were_not_measured_stay(self):
        first = "### One\n\nText.\n\n`python crates/bench/peers/one.py`. Commit 1.\n"
        second = "### Two\n\n#### Part\n\n`python crates/bench/peers/two.py`. Commit 2.\n"
        block = "\n".join(["## Peers\n\nHeading.\n", second, first])
        self.assertEqual(results.sections_of(block, ["one", "two"]), {"one": first, "two": second})


class Frames(unittest.TestCase):
    def test_frames_are_read_without_obstacles(self):
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        with tempfile.TemporaryDirectory() as folder:
            for number, factor in enumerate((1.0, 1.5, 1.25)):
                write_ply(Path(folder) / f"{number:06}.ply", factor * x, [[0, 1, 2]])
            read = frames.read(Path(folder))
        np.testing.assert_array_equal(read.x[1], 1.5 * x)
        self.assertEqual(read.edges.tolist(), [[0, 1], [0, 2], [1, 2]])
        self.assertAlmostEqual(read.largest_stretch(), 1.5)

    def test_rest_begins_after_the_last_motion(self):
        x = np.zeros((21, 2, 3))
        x[:6, 0, 2] = np.linspace(1.0, 0.5, 6)
        read = frames.Frames(x, np.zeros(2), np.zeros((0, 2), int))
        self.assertAlmostEqual(read.rests_from(0.1, 1e-4), 0.6)
        x[19, 1, 0] = 1.0
        self.assertIsNone(read.rests_from(0.1, 1e-4))


class Slope(unittest.TestCase):
    def test_motion_as_in_theory_has_no_error(self):
        time = 0.005 * np.arange(201)
        growth = soft.GRAVITY * (math.sin(soft.TILT) - soft.FRICTION * math.cos(soft.TILT))
        down = np.array([math.cos(soft.TILT), 0.0, -math.sin(soft.TILT)])
        x = (0.5 * growth * time**2)[:, None, None] * down
        speed, acceleration = soft._slide(x, 0.005)
        self.assertAlmostEqual(speed, 1.0)
        self.assertAlmostEqual(acceleration, 1.0)


class Layers(unittest.TestCase):
    def test_the_full_size_is_that_of_the_paper(self):
        full = layers.Layers()
        self.assertLess(abs(full.vertices / 246_000 - 1.0), 0.01)
        self.assertLess(abs(full.triangles / 475_000 - 1.0), 0.01)

    def test_sheets_start_apart(self):
        with tempfile.TemporaryDirectory() as folder:
            path = layers.Layers(3, 5, 0.2).write(Path(folder) / "layers.toml")
            scene = tomllib.loads(path.read_text(encoding="utf-8"))
        self.assertEqual(scene["simulation"]["frames"], 20)
        heights = [body["translate"][2] for body in scene["body"]]
        np.testing.assert_allclose(np.diff([layers.RADIUS, *heights]), layers.GAP)
        self.assertAlmostEqual(scene["body"][0]["shape"]["edge"], layers.SIDE / 4)


if __name__ == "__main__":
    unittest.main()
