# SPDX-License-Identifier: GPL-3.0-or-later
"""The materials that an artist chooses from: those of the package, and what they are like."""

from __future__ import annotations

from typing import NamedTuple


class Preset(NamedTuple):
    """A material of the package."""

    material: str
    label: str
    description: str
    #: Distance at which contacts of strands begin to press [m], about their thickness: a tenth of their edges, the
    #: default of the package, would push the neighbors of a dense groom apart, whose roots hold them.
    contact: float = 0.0


CLOTH = (
    Preset("cotton", "Cotton", "Shirts, bed sheets: medium weight, folds of medium width"),
    Preset("wool", "Wool", "Skirts, coats: thick and soft, stretches a little"),
    Preset("wool-lycra", "Wool and Lycra", "Tight and knitted clothes: stretches by a fifth, small folds"),
    Preset("polyester", "Polyester", "Linings, sportswear: light, small folds"),
    Preset("silk", "Silk", "Scarves, dresses: very light, flows, many fine folds"),
    Preset("denim", "Denim", "Jeans, jackets: heavy and stiff, few wide folds"),
)

SOLID = (
    Preset("rubber", "Rubber", "Firm: bounces, bends only if slender"),
    Preset("silicone", "Silicone", "Soft toys and skin: gives way under its own weight a little"),
    Preset("jelly", "Jelly", "Very soft: wobbles and sags"),
    Preset("foam", "Foam", "Light and soft: cushions, sponges"),
)

HAIR = (
    Preset(
        "lock", "Lock", "A strand stands for a lock of about a hundred hairs: what grooms for pictures need", 0.0005
    ),
    Preset("hair", "Single Hair", "One human hair of 0.08 mm", 0.0004),
    Preset("yarn", "Yarn", "Wool and knitting yarn, limp", 0.001),
    Preset("rope", "Rope", "Rope of 1 cm, heavy and stiff", 0.01),
    Preset("straw", "Straw", "Straw, grass and bristles of 3 mm, stiff", 0.003),
)
