"""Tests of what needs no solver: python -m unittest test_peers, in this folder."""

import unittest

import numpy as np

import judging
import page
import scenes


class Scenes(unittest.TestCase):
    def test_cloths_cover_their_square(self):
        cloth = scenes.sheet("cloth", (0.0, 0.0, 0.0), 1.0, 5)
        a, b, c = (cloth.x[cloth.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        self.assertAlmostEqual(0.5 * normals[:, 2].sum(), 1.0)
        self.assertTrue((normals[:, 2] > 0.0).all())

    def test_blocks_are_filled_by_tetrahedra_of_positive_volume(self):
        cube = scenes.block("cube", (0.0, 0.0, 1.0), 30.0, 0.3, 4)
        a, b, c, d = (cube.x[cube.tets[:, k]] for k in range(4))
        volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0
        self.assertTrue((volumes > 0.0).all())
        self.assertAlmostEqual(volumes.sum(), 0.3**3)

    def test_surfaces_are_closed_and_outward(self):
        cube = scenes.block("cube", (0.0, 0.0, 1.0), 0.0, 0.3, 4)
        for body, volume in ((cube, 0.3**3), (scenes.ball(1.0, (0.0, 0.0, 0.0)), 4.0 / 3.0 * np.pi)):
            edges = np.concatenate([body.triangles[:, k] for k in ([0, 1], [1, 2], [2, 0])])
            self.assertEqual(len(np.unique(edges, axis=0)), len(edges))
            self.assertEqual(len(np.unique(np.sort(edges, axis=1), axis=0)), len(edges) // 2)
            a, b, c = (body.x[body.triangles[:, k]] for k in range(3))
            enclosed = np.einsum("ij,ij->", np.cross(a, b), c) / 6.0
            self.assertTrue(0.97 * volume < enclosed <= volume * (1.0 + 1e-12))

    def test_shells_are_the_surfaces(self):
        cube = scenes.block("cube", (0.0, 0.0, 1.0), 0.0, 0.3, 4)
        shell = cube.shell()
        self.assertEqual(len(shell.x), 4**3 - 2**3)
        np.testing.assert_array_equal(shell.x[shell.triangles], cube.x[cube.triangles])

    def test_ends_start_at_the_cloth_and_keep_their_length(self):
        scene = scenes.twist(6)
        ids, _ = scene.held()
        np.testing.assert_allclose(scene.held_at(0.0), scene.bodies[0].x[ids])
        turned = scene.held_at(1.5)
        np.testing.assert_allclose(np.linalg.norm(turned[0] - turned[5]), 1.0)
        # A quarter of a turn each, to opposite sides.
        np.testing.assert_allclose(turned[0], [-0.5, 0.0, -0.5], atol=1e-12)
        np.testing.assert_allclose(turned[6], [0.5, 0.0, 0.5], atol=1e-12)


class Figures(unittest.TestCase):
    def test_stretch_is_that_of_the_longest_edge(self):
        scene = scenes.twist(3)
        start = scene.bodies[0].x
        self.assertEqual(judging.largest_stretch(scene, start, start), 1.0)
        self.assertAlmostEqual(judging.largest_stretch(scene, start, start * [1.5, 1.0, 1.0]), 1.5)

    def test_numbers_have_three_digits(self):
        for value, text in ((0, "0"), (0.01234, "0.0123"), (5.678, "5.68"), (12345.6, "12,346")):
            self.assertEqual(page.number(value), text)


if __name__ == "__main__":
    unittest.main()
