"""Pictures of simulations and meshes."""

from __future__ import annotations

import base64
import html as html_text
import os
import re
import sys
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _native
from ._call import call
from ._errors import DeviceError, InputError
from ._meshes import mesh_of
from ._png import png


def render(
    what: Any,
    faces: ArrayLike | None = None,
    *,
    frame: int | None = None,
    bodies: ArrayLike | None = None,
    obstacles: ArrayLike | None = None,
    colors: Any = None,
    size: tuple[int, int] = (960, 720),
    view: str = "three-quarter",
    fov: float = 26.0,
    eye: ArrayLike | None = None,
    target: ArrayLike | None = None,
    values: ArrayLike | None = None,
    radius: float | None = None,
    quality: str = "fine",
) -> NDArray[np.uint8]:
    """Draws a simulation or a mesh as an array of pixels. It needs a graphics driver, of a GPU or in software.

    Parameters
    ----------
    what : Simulator, Run, mesh, path, or array_like of shape (n, 3)
        What is drawn. A path is that of a mesh file.
    faces : array_like of integers, shape (m, 3), optional
        Triangles of vertices that are given as an array.
    frame : int, optional
        The frame of a run that is drawn. Default: the last that it has.
    bodies : array_like of integers, shape (n,), optional
        The body of each vertex of a mesh or of arrays; each body has a color. Default: those of the mesh file.
    obstacles : array_like of bool, shape (n,), or of integers, optional
        Vertices of a mesh or of arrays that are drawn as obstacles, in gray.
    colors : sequence or dict, optional
        Colors of bodies: in the order of their numbers, or by number or name. Each is ``"#rrggbb"``, or red, green and
        blue from 0 to 255. Bodies that are left out keep their color.
    size : (int, int)
        Width and height [pixels].
    view : {"three-quarter", "front", "side", "top"}
        Where to look from; the camera is fitted to what is drawn.
    fov : float
        Vertical field of view [deg].
    eye, target : array_like of 3 numbers, optional
        Where the camera is and what it looks at [m], in place of the fitted ones.
    values : array_like of float, shape (n,), optional
        A number per vertex from 0 to 1 that the color map viridis shows; nan for none. A simulation has one per
        vertex that collides.
    radius : float, optional
        Radius of strands and particles [m]. Default: half of the contact distance, or a hundredth of the size.
    quality : {"fine", "fast"}
        ``"fast"`` takes about a tenth of the time.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        Red, green and blue, from the upper left.

    Raises
    ------
    DeviceError
        No graphics driver; the message names the package to install.
    InputError
        Shapes, types, a size that cannot be drawn.
    """
    keep_silent()
    if quality not in ("fine", "fast"):
        raise InputError(f'quality {quality!r}: it must be "fine" or "fast"')
    drawn = _drawn(what, faces, radius, frame, bodies, obstacles)
    count = len(drawn.positions)
    drawn.colors = _colors(colors, drawn)
    drawn.values = np.zeros(0, np.float32)
    if values is not None:
        drawn.values = _arrays.numbers("values", values, None, count).astype(np.float32)
    sides = np.asarray(size)
    if sides.shape != (2,) or sides.dtype.kind not in "iu" or (sides < 1).any() or (sides >= 2**31).any():
        raise InputError(f"size: expected width and height [pixels], got {size!r}")
    look = SimpleNamespace(
        size=[int(side) for side in sides],
        view=view,
        fov=float(fov),
        eye=None if eye is None else _arrays.vector("eye", eye),
        target=None if target is None else _arrays.vector("target", target),
        fine=quality == "fine",
    )
    return call(_native.render, drawn, look)


def _drawn(
    what: Any,
    faces: ArrayLike | None,
    radius: float | None,
    frame: int | None,
    bodies: ArrayLike | None,
    obstacles: ArrayLike | None,
) -> SimpleNamespace:
    given = {"faces": faces, "bodies": bodies, "obstacles": obstacles}
    layout = getattr(what, "_layout", None)
    planes_of = getattr(what, "_frame", None)
    if frame is not None and planes_of is None:
        raise InputError("frame: only a Run has several; give its folder as bowknot.Run(folder)")
    if isinstance(layout, dict) or planes_of is not None:
        for name, value in given.items():
            if value is not None:
                raise InputError(f"{name}: a simulation has its own")
    if isinstance(layout, dict):
        count = layout["collision_vertices"]
        present = np.array(call(what._native.present), np.bool_)
        names = list(layout["names"])
        is_there = present[: len(names)][layout["body"]]

        def there(elements: NDArray[np.uint32]) -> NDArray[np.uint32]:
            first = elements if elements.ndim == 1 else elements[:, 0]
            return np.ascontiguousarray(elements[is_there[first]])

        return SimpleNamespace(
            positions=np.ascontiguousarray(what.positions[:count]),
            triangles=there(layout["faces"]),
            strands=there(layout["edges"]),
            particles=there(layout["particles"]),
            obstacle=layout["obstacle"],
            body=layout["body"],
            planes=np.ascontiguousarray(layout["planes"][present[len(names) :]]),
            names=names,
            radius=float(layout["radius"] if radius is None else radius),
        )
    mesh, planes = planes_of(frame) if planes_of is not None else (mesh_of(what, faces), np.zeros((0, 4)))
    if len(mesh.vertices) == 0:
        raise InputError("vertices: there are none")
    extent = np.ptp(mesh.vertices, axis=0)
    if not np.isfinite(extent).all():
        raise InputError("vertices: some are not finite")
    return SimpleNamespace(
        positions=mesh.vertices,
        triangles=np.concatenate([mesh.faces, _surface(mesh.tets)]),
        strands=mesh.edges,
        particles=mesh.particles,
        obstacle=mesh.obstacles if obstacles is None else _arrays.flags("obstacles", obstacles, len(mesh.vertices)),
        body=mesh.bodies if bodies is None else _arrays.whole("bodies", bodies, len(mesh.vertices), 2**32 - 1),
        planes=planes,
        names=mesh.names,
        radius=float(0.01 * extent.max() if radius is None else radius),
    )


def _colors(colors: Any, drawn: SimpleNamespace) -> NDArray[np.uint8]:
    """The color of each vertex; none if none are given."""
    none = np.zeros((0, 3), np.uint8)
    if colors is None:
        return none
    if isinstance(colors, str) or not isinstance(colors, (Mapping, Sequence, np.ndarray)):
        raise InputError(f"colors: expected a list of colors, or a dict by body, got {type(colors).__name__}")
    count = len(drawn.positions)
    body = drawn.body if len(drawn.body) == count else np.zeros(count, np.uint32)
    obstacle = drawn.obstacle if len(drawn.obstacle) == count else np.zeros(count, np.bool_)
    numbers, places = np.unique(body, return_inverse=True)
    own = np.array([list(_native.body_color(int(number))) for number in numbers], np.uint8)[places.ravel()]
    own[obstacle] = list(_native.body_color(None))
    by_body = colors.items() if isinstance(colors, Mapping) else enumerate(colors)
    for key, color in by_body:
        if isinstance(key, str):
            if key not in drawn.names:
                raise InputError(f"colors: no body {key!r}; there are {', '.join(drawn.names) or 'none with names'}")
            key = drawn.names.index(key)
        elif not isinstance(key, (int, np.integer)):
            raise InputError(f"colors: a body goes by its number or its name, not by {key!r}")
        own[body == int(key)] = _color(color)
    return np.ascontiguousarray(own)


def _color(color: Any) -> tuple[int, int, int]:
    """Red, green and blue of a color."""
    if isinstance(color, str):
        if re.fullmatch("#[0-9a-fA-F]{6}", color):
            return int(color[1:3], 16), int(color[3:5], 16), int(color[5:7], 16)
    else:
        shares = np.asarray(color)
        if shares.shape == (3,) and shares.dtype.kind in "iu" and ((shares >= 0) & (shares <= 255)).all():
            return int(shares[0]), int(shares[1]), int(shares[2])
    raise InputError(f'colors: expected "#rrggbb" or three whole numbers from 0 to 255, got {color!r}')


def _surface(tets: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """The faces that only one tetrahedron has."""
    sides = np.concatenate([tets[:, [0, 2, 1]], tets[:, [0, 1, 3]], tets[:, [1, 2, 3]], tets[:, [0, 3, 2]]])
    _, first, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    return np.ascontiguousarray(sides[np.sort(first[count == 1])])


def keep_silent() -> None:
    """Keeps a layer of Mesa's drivers from looking for a display where there can be none, as the command does."""
    is_set = any(os.environ.get(name) for name in ("XDG_RUNTIME_DIR", "MESA_VK_DEVICE_SELECT"))
    if sys.platform == "linux" and not is_set:
        os.environ.setdefault("NODEVICE_SELECT", "1")


def html(simulator: Any) -> str:
    """A small picture for a notebook, or the text where there is no graphics driver."""
    caption = html_text.escape(repr(simulator))
    try:
        picture = png(render(simulator, size=(480, 360), quality="fast"))
    except DeviceError:
        return f"<pre>{caption}</pre>"
    data = base64.b64encode(picture).decode("ascii")
    return f'<figure><img src="data:image/png;base64,{data}"/><figcaption>{caption}</figcaption></figure>'
