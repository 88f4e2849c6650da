# SPDX-License-Identifier: GPL-3.0-or-later
"""What needs no Blender: arrays to scenes, the bake in the background, caches, tetrahedra."""
