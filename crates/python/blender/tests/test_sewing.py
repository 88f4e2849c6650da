# SPDX-License-Identifier: GPL-3.0-or-later
"""Where points go that are sewn to a surface."""

import numpy as np
from bl_ext.user_default.bowknot import sewing

import bowknot


def test_a_rigid_motion_is_followed_exactly_and_skin_that_stretches_is_never_entered():
    tube = bowknot.shape("tube", radius=0.1, length=0.8, edge=0.02)
    first, triangles = tube.vertices.copy(), tube.faces.astype(np.int64)
    corners = first[triangles]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if (outward[:, 1:] * corners.mean(axis=1)[:, 1:]).sum() < 0:
        triangles = triangles[:, ::-1].copy()
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.column_stack([np.zeros(60), 0.11 * np.cos(angle), 0.11 * np.sin(angle)])
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    # A joint at the ring: the upper half bends by 30 degrees about y, the skin at it stretches and shrinks.
    share = 1.0 / (1.0 + np.exp(-first[:, 0] / 0.04))
    bend = np.pi / 6 * share
    bent = first.copy()
    bent[:, 0] = np.cos(bend) * first[:, 0] + np.sin(bend) * first[:, 2]
    bent[:, 2] = -np.sin(bend) * first[:, 0] + np.cos(bend) * first[:, 2]
    places = sewing.carried(ring, [first, first @ turn.T + [0.1, 0.2, 0.3], bent], triangles)
    assert (places[0] == ring).all()
    assert np.abs(places[1] - (ring @ turn.T + [0.1, 0.2, 0.3])).max() < 1e-6
    heights = sewing._heights(places[2], sewing._tree(bent, triangles))[0]
    assert heights.min() > 0.69 * 0.01
    sides = np.linalg.norm(np.roll(places[2], -1, axis=0) - places[2], axis=1)
    assert sides.max() < 1.5 * 2 * 0.11 * np.sin(np.pi / 60)
