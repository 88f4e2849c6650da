"""The collision stage behind anyone's dynamics."""

from __future__ import annotations

import difflib
import inspect
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _native, _toml
from ._call import call
from ._contacts import Contacts, contacts_of
from ._errors import BowknotWarning, InputError
from ._info import Info
from ._meshes import mesh_of

#: Where the parameters that go by a short name stand in `[contact]` and `[solver]`.
_TABLES = {
    "contact": (
        "preset delta min_separation range active separation_speed contacts_only form friction_model "
        "stretch_limit edge_reference edge_form"
    ),
    "solver.backward": (
        "sweeps polish_sweeps polish_distance edge_proximal contact_proximal proximal_growth "
        "coarse_correction active_rows"
    ),
    "solver.forward": "bound damping trust_region trust_region_min trust_region_max swept_travel",
    "solver.stop": ("max_steps max_seconds rule distance stretch_tolerance remaining_fraction net_residual residual"),
}
_KEYS = {name: f"{table}.{name}" for table, names in _TABLES.items() for name in names.split()}


def _assignments(params: Mapping[str, Any]) -> list[str]:
    """Parameters as assignments to keys of a scene."""
    sets = []
    for name, value in params.items():
        if name in ("contact", "solver") and isinstance(value, Mapping):
            sets += _nested(name, value)
        elif name in _KEYS:
            sets.append(f"{_KEYS[name]}={_toml.value(name, value)}")
        else:
            raise InputError(_unknown(name))
    # A preset is a set of defaults for all others.
    return sorted(sets, key=lambda text: not text.startswith("contact.preset="))


def _unknown(name: str) -> str:
    own = [key for key in inspect.signature(Resolver).parameters if key != "params"]
    known = sorted({*own, *_KEYS, "contact", "solver"})
    near = difflib.get_close_matches(name, known, 1)
    hint = f"did you mean {near[0]!r}? Known" if near else "known"
    return f"unknown parameter {name!r}; {hint} are: {', '.join(known)}"


def _nested(path: str, table: Mapping[str, Any]) -> list[str]:
    sets: list[str] = []
    for name, value in table.items():
        key = f"{path}.{name}"
        sets += _nested(key, value) if isinstance(value, Mapping) else [f"{key}={_toml.value(key, value)}"]
    return sets


def _is_list(name: str, value: Any) -> bool:
    """Whether a setting is given for each body rather than for all."""
    return value is not None and _arrays.is_list(name, value)


class Resolver:
    """Moves positions toward targets without intersections, whatever computes the targets.

    Parameters
    ----------
    rest : array_like of float64, shape (n, 3), or mesh
        Rest positions [m], of the undeformed bodies: default lengths and stretch limits follow from them. A mesh of
        meshio, trimesh or pyvista, or the path of a mesh file, has its faces with it.
    faces : array_like of integers, shape (m, 3), optional
        Vertices of the triangles.
    edges : array_like of integers, shape (k, 2), optional
        Vertices of the edges of strands, which are no edges of triangles.
    particles : array_like of integers, shape (p,), optional
        Vertices that are particles.
    masses : float or array_like of shape (n,)
        Masses [kg]: heavy vertices yield less.
    fixed : array_like of bool, shape (n,), or of integers, optional
        Vertices that go to their targets and yield to nothing, as pins do; they wait where they would cut through
        something. Truth values, or the numbers of the vertices.
    bodies : array_like of integers, shape (n,), optional
        The body of each vertex. Default: 0, and 1 for obstacles.
    obstacles : array_like of bool, shape (n,), or of integers, optional
        Vertices of obstacles, whole bodies of them. An obstacle goes to its target as one and yields to nothing; two
        obstacles do not meet.
    planes : array_like of float64, shape (h, 4), optional
        Half-spaces that everything stays above: an outward normal and the offset of the plane along it [m].
        ``(0, 0, 1, 0)`` is the ground z = 0.
    groups : array_like of integers, shape (n,), optional
        Fixed vertices that move and wait together: the number of their group, -1 for none.
    friction, thickness : float or array_like of shape (b,), optional
        Coefficient of Coulomb friction [1] and guaranteed smallest gap [m], of all bodies or of each, nan for none.
        A pair has the geometric mean of both frictions and the mean of both thicknesses.
    plane_friction, plane_thickness : float or array_like of shape (h,), optional
        The same of the half-spaces. Default: the friction of bodies if that is one number, and no thickness.
    delta, stretch_limit : float or array_like of shape (b,), optional
        Contact distance [m], and the largest ratio of an edge's length to its rest length [1], of all bodies or of
        each. Defaults: a tenth of the mean edge, and 1.1; inf is no limit.
    **params
        Settings of `[contact]` and `[solver]` by their documented names and units, as in
        ``Resolver(..., max_steps=100, preset="quick", min_separation=1e-4)``. Names that are taken stand in dicts:
        ``contact={"edges": False}``.

    Raises
    ------
    InputError
        What is refused, with its name, and what was expected.

    Notes
    -----
    **Edges are limited to 1.1 times their rest length by default**; ``stretch_limit=math.inf`` switches that off.

    Calls release the interpreter's lock. One resolver serves one thread at a time. A pickle holds what the resolver was
    made of, not the state that it returned last: the next call judges its start.

    Examples
    --------
    >>> import numpy as np, bowknot
    >>> corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    >>> x = np.concatenate([corners, corners + [0.0, 0.0, 0.1]])
    >>> resolver = bowknot.Resolver(x, [[0, 1, 2], [3, 4, 5]])
    >>> y = x[[3, 4, 5, 0, 1, 2]]  # the target swaps the two triangles
    >>> x, info = resolver.resolve(x, y)
    >>> bool(info.converged and x[3, 2] > x[0, 2])
    True
    """

    def __init__(
        self,
        rest: Any,
        faces: ArrayLike | None = None,
        edges: ArrayLike | None = None,
        particles: ArrayLike | None = None,
        masses: ArrayLike = 1.0,
        fixed: ArrayLike | None = None,
        bodies: ArrayLike | None = None,
        obstacles: ArrayLike | None = None,
        *,
        planes: ArrayLike | None = None,
        groups: ArrayLike | None = None,
        friction: ArrayLike | None = None,
        thickness: ArrayLike | None = None,
        plane_friction: ArrayLike | None = None,
        plane_thickness: ArrayLike | None = None,
        delta: ArrayLike | None = None,
        stretch_limit: ArrayLike | None = None,
        **params: Any,
    ) -> None:
        mesh = mesh_of(rest, faces, edges=edges, particles=particles, name="rest")
        if len(mesh.tets) > 0:
            raise InputError("rest: tetrahedra do not collide; give the triangles of their surface as faces")
        count = len(mesh.vertices)
        if count == 0:
            raise InputError("rest: there are no vertices")
        obstacle = _arrays.flags("obstacles", obstacles, count)
        body = _arrays.bodies(bodies, obstacle)
        if bodies is None:
            for name, rows in (("face", mesh.faces), ("edge", mesh.edges)):
                marked = obstacle[rows]
                mixed = np.flatnonzero(marked.any(axis=1) & ~marked.all(axis=1))
                if len(mixed) > 0:
                    raise InputError(
                        f"obstacles: {name} {mixed[0]} has vertices that are marked and others that are not; mark all "
                        "vertices of an obstacle"
                    )
        body_count = int(body.max()) + 1
        planes = np.zeros((0, 4)) if planes is None else _arrays.numbers("planes", planes, 4)

        # One number is the setting of all, one number per body is each body's own.
        for name, given in (("delta", delta), ("stretch_limit", stretch_limit)):
            if given is not None and not _is_list(name, given):
                params[name] = float(_arrays.column(name, given, 1)[0])
        own = [
            _arrays.column("thickness", thickness, body_count),
            _arrays.column("delta", delta if _is_list("delta", delta) else None, body_count),
            _arrays.column("friction", friction, body_count),
            _arrays.column(
                "stretch_limit",
                stretch_limit if _is_list("stretch_limit", stretch_limit) else None,
                body_count,
            ),
        ]
        if plane_friction is None and not _is_list("friction", friction):
            plane_friction = friction
        own_of_planes = [
            _arrays.column("plane_thickness", plane_thickness, len(planes)),
            _arrays.column("plane_friction", plane_friction, len(planes)),
        ]
        no_groups = np.zeros(0, np.uint32)
        arrays: list[NDArray[Any]] = [
            mesh.vertices,
            mesh.faces,
            mesh.edges,
            mesh.particles,
            _arrays.column("masses", masses, count),
            _arrays.flags("fixed", fixed, count),
            obstacle,
            body,
            no_groups if groups is None else _arrays.whole("groups", groups, count, 2**32 - 2, none=-1),
            planes,
            np.ascontiguousarray(np.column_stack(own)),
            np.ascontiguousarray(np.column_stack(own_of_planes)),
        ]
        # Copies, as what was given may change before a pickle is made.
        self._make([array.copy() for array in arrays], _assignments(params))

    def _make(self, arrays: list[NDArray[Any]], sets: list[str]) -> None:
        self._count = len(arrays[0])
        self._warned = False
        self._native = call(_native.Resolver, *arrays, sets)
        self._made_of = (arrays, sets)

    def __getstate__(self) -> tuple[list[NDArray[Any]], list[str]]:
        return self._made_of

    def __setstate__(self, state: tuple[list[NDArray[Any]], list[str]]) -> None:
        self._make(*state)

    @property
    def vertex_count(self) -> int:
        """Number of vertices, n."""
        return self._count

    @property
    def lengths(self) -> dict[str, float]:
        """The lengths in force: ``edge``, ``delta``, ``min_separation``, ``contact_range`` [m], and
        ``separation_speed`` [m/s]."""
        return dict(self._native.lengths)

    def resolve(
        self,
        x: ArrayLike,
        y: ArrayLike,
        *,
        dt: float | None = None,
        fixed: ArrayLike | None = None,
        start: ArrayLike | None = None,
        check: bool = True,
        out: NDArray[np.float64] | None = None,
    ) -> tuple[NDArray[np.float64], Info]:
        """Moves from a state toward a target. All straight paths on the way are free of intersections.

        Parameters
        ----------
        x : array_like of float64, shape (n, 3)
            The state [m], free of intersections.
        y : array_like of float64, shape (n, 3)
            The target [m], as far away and as deep in penetration as it may be.
        dt : float, optional
            Time step that the call stands for [s]. It limits the speed at which contacts are separated.
        fixed : array_like, optional
            Prescribed vertices of this call, in place of those of the resolver.
        start : array_like of float64, shape (n, 3), optional
            Positions at the start of the time step [m], from which friction measures slip if a time step makes
            several calls. Default: ``x``.
        check : bool
            Whether a state that the last call did not return is judged first, which costs about as much as a
            step. Without, surfaces that pass through each other at the start stay so, or worse.
        out : ndarray of float64, shape (n, 3), optional
            Where the result is written; it may be ``x`` itself.

        Returns
        -------
        x : ndarray of float64, shape (n, 3)
            The new state [m]: `out` if it is given.
        info : Info
            What was done: ``converged``, ``steps``, ``min_gap_m``, ``remaining_m``, and others. ``max_stretch`` and
            ``max_target_stretch`` are the largest ratios of an edge to its rest length in the result and in the target.

        Warns
        -----
        BowknotWarning
            A target in which an edge between free vertices is more than 100 times as long as at rest, and as the mean
            edge: the solver that computes targets most likely explodes. Once for each resolver.

        Raises
        ------
        IntersectionError
            The state intersects, with the first pairs.
        InputError
            Wrong shapes and types, numbers that are not finite, coordinates too large.
        KeyboardInterrupt
            Ctrl-C. `out`, if given, then holds the valid state that was reached.
        """
        if out is not None:
            _check_out(out, self._count)
        given_x = _arrays.points("x", x, self._count)
        given_y = _arrays.points("y", y, self._count)
        given_start = None if start is None else _arrays.points("start", start, self._count)
        given_fixed = None if fixed is None else _arrays.flags("fixed", fixed, self._count)
        result, text, long, signal = call(
            self._native.resolve, given_x, given_y, given_fixed, given_start, dt, bool(check)
        )
        if long is not None and not self._warned:
            self._warned = True
            _warn_of(*long)
        if out is not None:
            np.copyto(out, result)
            result = out
        if signal is not None:
            raise signal
        return result, Info(text)

    def resolve_in_place(self, x: NDArray[np.float64], y: ArrayLike, **options: Any) -> Info:
        """As `resolve` with ``out=x``: moves the array ``x`` itself, and returns what was done."""
        if not isinstance(x, np.ndarray):
            raise InputError(f"x: expected an ndarray to move in place, got {type(x).__name__}")
        return self.resolve(x, y, out=x, **options)[1]

    def contacts(self, dt: float) -> Contacts:
        """The contacts that press at the end of the last call, which stood for a time step ``dt`` [s].

        Their forces are what, beside those of your dynamics, leads to where the call ended. They follow from ``masses``,
        which are 1 kg per vertex if they were not given. Stretch limits pull as well, which is not among them. A call
        that has not converged, or that ``start=`` splits into several, tells less than that. Where obstacles press a body
        to less than its contact distance ``delta``, not all contacts can be met: forces then grow without meaning
        (``info.complementarity_m`` far above 1e-6); take a smaller ``delta``. The velocity filter has no friction here.

        Raises
        ------
        InputError
            A time step that is not above 0.
        """
        return contacts_of(call(self._native.contacts, float(dt)))

    def __repr__(self) -> str:
        return f"Resolver({self._count} vertices)"


def _warn_of(edge: Sequence[int], stretch: float) -> None:
    text = (
        f"y: the target stretches the edge between vertices {edge[0]} and {edge[1]} to {stretch:.3g} times its rest "
        "length: the solver that computes targets most likely explodes. Results have no intersections, but no meaning "
        "either. What helps: velocities from where calls end, (new - x) / dt; a smaller time step; softer springs or "
        "an implicit solver; the same unit for rest, x and y. info.max_target_stretch has this ratio of each call."
    )
    warnings.warn(text, BowknotWarning, stacklevel=3)


def _check_out(out: Any, rows: int) -> None:
    expected = f"a writable ndarray of shape ({rows}, 3) of float64"
    if not isinstance(out, np.ndarray):
        raise InputError(f"out: expected {expected}, got {type(out).__name__}")
    if out.shape != (rows, 3) or out.dtype != np.float64:
        raise InputError(f"out: expected {expected}, got shape {out.shape} of {out.dtype}")
    if not out.flags.writeable:
        raise InputError(f"out: expected {expected}, got one that is read-only")
