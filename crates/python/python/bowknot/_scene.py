"""Scenes: read from TOML, built in, or put together from arrays."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native, _toml
from ._call import call
from ._errors import InputError
from ._meshes import Mesh, is_path, mesh_of, read_mesh
from ._usd import kept_text, needs_usd

#: Keys of a body or an obstacle that hold arrays.
_ARRAYS = ("faces", "tets", "edges", "particles")

#: Kinds of bodies of generated shapes; all others are cloth.
_KINDS = {
    "block": "solid",
    "tet-ball": "solid",
    "strands": "strands",
    "woven": "strands",
    "grains": "particles",
}

_Table = Mapping[str, Any]


class Scene:
    """What is simulated: bodies, obstacles, pins, parameters.

    Parameters
    ----------
    bodies, obstacles, pins : iterable of dict
        Tables of the scene reference, ``[[body]]``, ``[[obstacle]]`` and ``[[pin]]``. In bodies and obstacles the
        key ``mesh`` may also hold a mesh: arrays or an object of meshio, trimesh or pyvista; arrays have their
        elements in ``faces``, ``tets`` or ``edges``.
    simulation, contact, solver, output : dict
        The tables of these names.

    Raises
    ------
    InputError
        Unknown keys, wrong types, values out of range; every problem with its key.

    Examples
    --------
    >>> import bowknot
    >>> scene = bowknot.Scene(simulation={"frames": 10})
    >>> square = [[0.0, 0.0, 0.5], [0.2, 0.0, 0.5], [0.2, 0.2, 0.5], [0.0, 0.2, 0.5]]
    >>> scene.add_body(square, [[0, 1, 2], [0, 2, 3]], name="cloth", material="silk")
    >>> scene.add_obstacle(shape="half-space", name="ground")
    >>> scene
    Scene('scene': bodies cloth; obstacles ground; 10 frames of 0.01 s)
    """

    def __init__(
        self,
        bodies: Iterable[_Table] = (),
        obstacles: Iterable[_Table] = (),
        pins: Iterable[_Table] = (),
        *,
        simulation: _Table | None = None,
        contact: _Table | None = None,
        solver: _Table | None = None,
        output: _Table | None = None,
    ) -> None:
        self._native = _native.Scene.empty()
        self._groups: dict[str, dict[str, NDArray[np.uint32]]] = {}
        tables = {"simulation": simulation, "contact": contact, "solver": solver, "output": output}
        self._extend(bodies, obstacles, pins, {k: v for k, v in tables.items() if v is not None})

    @classmethod
    def _of(cls, native: _native.Scene, groups: Mapping[str, Any] | None = None) -> Scene:
        scene = cls.__new__(cls)
        scene._native = native
        # Of bodies whose meshes are given by arrays, which have no groups in a scene file.
        scene._groups = dict(groups or {})
        return scene

    @classmethod
    def from_toml(cls, source: str | os.PathLike[str], *, folder: str | os.PathLike[str] = "") -> Scene:
        """A scene from a TOML file or from text.

        Parameters
        ----------
        source : path or str
            A path, or the text itself: whatever has a line break or an equals sign is text.
        folder : path
            What paths of meshes in the text are relative to; a file's are relative to the file.

        Raises
        ------
        InputError
            A missing file, text that is not TOML, unknown keys, wrong types, values out of range; every problem
            with its line and key.
        """
        if isinstance(source, str) and ("\n" in source or "=" in source):
            return cls._of(call(_native.Scene.from_text, source, folder))
        if not is_path(source):
            raise InputError(f"source: expected a path or a text, got {type(source).__name__}")
        return cls._of(call(_native.Scene.load, source))

    @classmethod
    def builtin(cls, name: str, scale: float = 1.0) -> Scene:
        """A built-in scene; `builtin_scenes` lists them.

        Parameters
        ----------
        name : str
            Its name, such as ``"drape"``.
        scale : float
            Multiplies the resolution: vertices of sheets grow with its square.

        Raises
        ------
        InputError
            An unknown name, with the nearest one; a scale out of its range.
        """
        return cls._of(call(_native.Scene.builtin, name, float(scale)))

    def add_body(
        self,
        mesh: Any = None,
        faces: ArrayLike | None = None,
        *,
        tets: ArrayLike | None = None,
        edges: ArrayLike | None = None,
        **keys: Any,
    ) -> None:
        """Adds a deformable body.

        Parameters
        ----------
        mesh : array_like of float64, shape (n, 3), mesh, or path
            Vertices [m], a mesh of meshio, trimesh or pyvista, or a mesh file. Without one, ``shape`` must be given.
        faces, tets, edges : array_like of integers
            Elements of an array of vertices: triangles of a cloth (m, 3), tetrahedra of a solid (t, 4), edges of
            strands (k, 2). Without any, each vertex is a particle.
        **keys
            Keys of ``[[body]]``: ``name``, ``material``, ``translate``, ``friction``, ``shape`` and others; ``part``
            takes one part of a mesh file. ``kind`` follows from the elements or the shape.

        Raises
        ------
        InputError
            What is refused, with its key. The scene is then as it was.
        """
        self._extend(bodies=[_entry(mesh, faces, tets, edges, keys)])

    def add_obstacle(
        self,
        mesh: Any = None,
        faces: ArrayLike | None = None,
        *,
        tets: ArrayLike | None = None,
        edges: ArrayLike | None = None,
        **keys: Any,
    ) -> None:
        """Adds an obstacle, as `add_body` adds a body; ``shape="half-space"`` is the ground."""
        self._extend(obstacles=[_entry(mesh, faces, tets, edges, keys)])

    def add_pin(self, body: str, vertices: ArrayLike | None = None, **keys: Any) -> None:
        """Holds or leads vertices of a body.

        Parameters
        ----------
        body : str
            The name of the body.
        vertices : array_like of integers, optional
            Vertices of its mesh. Other keys choose them as well: ``group``, a name or a list of names of the groups of
            a mesh file, ``side``, ``box``, ``roots``.
        **keys
            Keys of ``[[pin]]``: ``motion``, ``follow``, ``start``, ``end`` and others.
        """
        if vertices is not None:
            keys["vertices"] = np.asarray(vertices)
        self._extend(pins=[{"body": body, **keys}])

    def set(self, key: str, value: Any) -> None:
        """Sets one key, such as ``scene.set("contact.delta", 0.001)`` or ``scene.set("body.cloth.material", "silk")``.

        Parameters
        ----------
        key : str
            Path of the key; entries of lists go by index or by name.
        value : number, str, list or dict
            Its value.

        Raises
        ------
        InputError
            What is refused, with its key. The scene is then as it was.
        """
        self._native = call(self._native.with_sets, [f"{key}={_toml.value(key, value)}"])

    def to_toml(self, *, short: bool = True) -> str:
        """The scene as TOML: without what is default, or with every default."""
        return self._native.to_toml(short)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene as a TOML file; paths of meshes become absolute."""
        Path(path).write_text(self._native.to_toml(False), encoding="utf-8")

    def info(self) -> dict[str, Any]:
        """Counts of vertices, edges, triangles and so on; loads the meshes."""
        return json.loads(call(self._native.info))

    @property
    def name(self) -> str:
        """Name in reports, the key ``simulation.name``."""
        return self._native.name

    @property
    def frames(self) -> int:
        """Number of time steps of a run, the key ``simulation.frames``."""
        return self._native.frames

    @property
    def dt(self) -> float:
        """Time step [s], the key ``simulation.dt``."""
        return self._native.time_step

    @property
    def bodies(self) -> list[str]:
        """Names of the deformable bodies."""
        return self._native.names[0]

    @property
    def obstacles(self) -> list[str]:
        """Names of the obstacles."""
        return self._native.names[1]

    def copy(self) -> Scene:
        """A copy, which later changes of this scene do not change."""
        return self._of(self._native, self._groups)

    def __copy__(self) -> Scene:
        return self.copy()

    def __deepcopy__(self, memo: Any) -> Scene:
        return self.copy()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._native == other._native

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._native.to_toml(False),)

    def __repr__(self) -> str:
        parts = [
            f"{what} {', '.join(names)}"
            for what, names in (("bodies", self.bodies), ("obstacles", self.obstacles))
            if names
        ]
        parts.append(f"{self.frames} frames of {self.dt:g} s")
        return f"Scene({self.name!r}: {'; '.join(parts)})"

    def _extend(
        self,
        bodies: Iterable[_Table] = (),
        obstacles: Iterable[_Table] = (),
        pins: Iterable[_Table] = (),
        tables: _Table | None = None,
    ) -> None:
        document: dict[str, Any] = dict(tables or {})
        meshes: list[tuple[Any, ...]] = []
        groups = dict(self._groups)
        for key, entries in (("body", bodies), ("obstacle", obstacles)):
            plain = []
            for index, entry in enumerate(entries):
                entry, mesh = _split(key, entry)
                if key == "body" and "kind" not in entry and (kind := _kind(entry.get("shape"))):
                    entry["kind"] = kind
                plain.append(entry)
                if mesh is not None:
                    edges = mesh.edges
                    meshes.append((key, index, mesh.vertices, mesh.faces, mesh.tets, edges))
                    if key == "body" and mesh.groups:
                        groups[entry.get("name") or f"body{len(self.bodies) + index}"] = mesh.groups
            if plain:
                document[key] = plain
        held = [_with_vertices(pin, groups) for pin in pins]
        if held:
            document["pin"] = held
        self._native = call(self._native.extended, _toml.document(document), meshes)
        self._groups = groups


def _with_vertices(pin: _Table, groups: Mapping[str, Mapping[str, NDArray[np.uint32]]]) -> dict[str, Any]:
    """A pin with the vertices of its group in place of the group, if its body has groups that the scene does not."""
    plain = dict(pin)
    of_body = groups.get(plain.get("body", ""))
    if of_body is None or "group" not in plain:
        return plain
    given = plain.pop("group")
    names = [given] if isinstance(given, str) else list(given)
    for name in names:
        if name not in of_body:
            raise InputError(f"pin of {plain['body']}: no group {name!r}; the mesh has {', '.join(of_body)}")
    own = np.asarray(plain.get("vertices", np.zeros(0, np.uint32)), np.uint32)
    plain["vertices"] = np.unique(np.concatenate([own, *(of_body[name] for name in names)]))
    return plain


def _restored(text: str) -> Scene:
    """A scene that was pickled."""
    return Scene._of(_native.Scene.from_text(text, ""))


def _kind(shape: Any) -> str | None:
    """The kind of body that a generated shape makes; None for what is cloth by default."""
    name = shape.get("type") if isinstance(shape, Mapping) else shape
    return _KINDS.get(name) if isinstance(name, str) else None


def _entry(mesh: Any, faces: Any, tets: Any, edges: Any, keys: dict[str, Any]) -> dict[str, Any]:
    given = {"mesh": mesh, "faces": faces, "tets": tets, "edges": edges}
    return {**{key: value for key, value in given.items() if value is not None}, **keys}


def _split(what: str, entry: _Table) -> tuple[dict[str, Any], Mesh | None]:
    """The entry of a body or an obstacle without its arrays, and its mesh."""
    if not isinstance(entry, Mapping):
        raise InputError(f"{what}: expected a dict, got {type(entry).__name__}")
    plain = dict(entry)
    arrays = {key: plain.pop(key) for key in _ARRAYS if key in plain}
    mesh = plain.get("mesh")
    if is_path(mesh) and needs_usd(mesh):
        import_keys = {key: plain.pop(key) for key in ("up", "scale", "part") if key in plain}
        plain["mesh"] = mesh = read_mesh(mesh, **import_keys)
    sequence = plain.get("sequence")
    if is_path(sequence) and needs_usd(sequence):
        plain["sequence"] = kept_text(sequence)
    if mesh is None or is_path(mesh):
        if arrays:
            raise InputError(f"{what}: {', '.join(arrays)} without vertices; give them as mesh")
        return plain, None
    for other in ("shape", "sequence"):
        if other in plain:
            raise InputError(f"{what}.{other}: stands beside mesh; only one of them may be given")
    del plain["mesh"]
    found = mesh_of(mesh, **arrays, name=f"{what}.mesh")
    if "part" in plain:
        raise InputError(f"{what}.part: names a part of a mesh file, but the mesh is given by its arrays")
    if len(found.vertices) == 0:
        raise InputError(f"{what}.mesh: there are no vertices")
    return plain, found


def builtin_scenes() -> dict[str, str]:
    """The built-in scenes: what happens in each, by name."""
    return dict(_native.builtin_scenes())
