"""Simulations, step by step."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _movie, _native, _pictures, _toml
from ._call import call
from ._contacts import Contacts, contacts_of
from ._errors import InputError
from ._files import count_of
from ._info import StepInfo
from ._movie import Movie
from ._progress import Callback
from ._scene import Scene, _entry
from ._tools import CheckReport


class Checkpoint:
    """The state of a simulation between two time steps, in full: a simulation restored from it goes on to the same
    bits. It can be pickled, and saved in the format that runs write."""

    def __init__(self, native: _native.Checkpoint) -> None:
        self._native = native

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Checkpoint:
        """Reads a file, such as ``checkpoint/state.npz`` in the folder of a run.

        Raises
        ------
        InputError
            A missing or damaged file.
        """
        return cls(call(_native.Checkpoint.load, path))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it as an NPZ archive."""
        call(self._native.save, path)

    @property
    def step(self) -> int:
        """Number of time steps made."""
        return self._native.step

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Checkpoint) and self._native == other._native

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "state.npz"
            self.save(path)
            return _unpickled, (path.read_bytes(),)

    def __repr__(self) -> str:
        return f"Checkpoint(step {self.step})"


def _unpickled(content: bytes) -> Checkpoint:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "state.npz"
        path.write_bytes(content)
        return Checkpoint.load(path)


class Simulator:
    """A running simulation: ``for info in simulator`` makes the time steps of its scene.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    backend : {"cpu", "gpu"}
        What computes. Results of the CPU have the same bits for any number of threads.
    device : int, optional
        Number of the GPU, as in `gpus`; default: the first that can be used.

    Raises
    ------
    IntersectionError
        Bodies intersect at the start, with the first pairs and what helps.
    InputError
        Whatever else is wrong with the scene or its meshes.
    DeviceError
        No such GPU, or it lacks what the scene needs.

    Notes
    -----
    Arrays are snapshots that cannot be written to: they keep their values when the simulation goes on, and asking
    twice between two time steps makes no second copy. Vertices of the simulation stand in the order of its bodies;
    `positions_of` has those of one body in the order of its mesh.

    No setter makes an intersection: pins and obstacles are led and wait while something is in their way, and what is
    put somewhere at once is judged.

    Examples
    --------
    >>> import bowknot
    >>> simulator = bowknot.Simulator(bowknot.Scene.builtin("drape", scale=0.2))
    >>> infos = [simulator.step() for _ in range(3)]
    >>> simulator.frame, simulator.positions.shape == simulator.velocities.shape
    (3, True)
    """

    def __init__(self, scene: Scene, *, backend: str = "cpu", device: int | None = None) -> None:
        if not isinstance(scene, Scene):
            raise InputError(f"scene: expected a Scene, got {type(scene).__name__}")
        if device is not None and not 0 <= int(device) < 2**32:
            raise InputError(f"device {device}: it must be a whole number from 0 up")
        if backend == "gpu":
            _pictures.keep_silent()
        self._scene = scene.copy()
        self._options = (backend, device)
        self._native = call(_native.Simulator, scene._native, backend, device)
        self._forget()

    def _forget(self, *, layout: bool = True) -> None:
        """Drops the arrays of the state, and those of what is fixed as well."""
        self._positions: NDArray[np.float64] | None = None
        self._velocities: NDArray[np.float64] | None = None
        if layout:
            self._layout_now: dict[str, Any] | None = None
            self._orders: dict[str, NDArray[np.int64]] = {}

    def _change(self, function: Any, *arguments: object, layout: bool = False) -> Any:
        """Calls what changes the simulation."""
        try:
            return call(function, *arguments)
        finally:
            self._forget(layout=layout)

    # Time

    def step(self) -> StepInfo:
        """Makes one time step.

        Returns
        -------
        StepInfo
            What it did.

        Raises
        ------
        InputError
            The dynamics has no finite target. The simulation is then as it was before the step.
        KeyboardInterrupt
            Ctrl-C. The step is then taken back, unless it was done already.
        """
        return StepInfo(self._change(self._native.step))

    def steps(self, count: int) -> Iterator[StepInfo]:
        """Makes so many time steps, one each time that it is asked for one."""
        for _ in range(count):
            yield self.step()

    def __iter__(self) -> Iterator[StepInfo]:
        """Makes time steps up to the number of frames of the scene."""
        while self.frame < self._scene.frames:
            yield self.step()

    @property
    def frame(self) -> int:
        """Number of time steps made."""
        return self._native.step_index

    @property
    def time(self) -> float:
        """Time of the state [s]."""
        return self._native.time

    # What there is

    @property
    def _layout(self) -> dict[str, Any]:
        if self._layout_now is None:
            layout = dict(call(self._native.layout))
            for value in layout.values():
                if isinstance(value, np.ndarray):
                    _arrays.read_only(value)
            self._layout_now = layout
        return self._layout_now

    @property
    def scene(self) -> Scene:
        """The scene as it is now, a copy."""
        return Scene._of(call(self._native.scene))

    @property
    def backend(self) -> str:
        """What computes the collisions: "cpu", or "gpu: " and the device."""
        return self._native.backend

    @property
    def names(self) -> list[str]:
        """Names of bodies, obstacles and half-spaces, in the order of their numbers."""
        return [*self._layout["names"], *self._layout["plane_names"]]

    @property
    def pins(self) -> list[str]:
        """Names of the pins."""
        return list(self._layout["pins"])

    @property
    def faces(self) -> NDArray[np.uint32]:
        """Triangles of all bodies and obstacles, by vertices of the simulation, shape (m, 3); read-only."""
        return self._layout["faces"]

    @property
    def edges(self) -> NDArray[np.uint32]:
        """Edges of strands, likewise, shape (k, 2); read-only."""
        return self._layout["edges"]

    @property
    def particles(self) -> NDArray[np.uint32]:
        """Vertices that are particles, shape (p,); read-only."""
        return self._layout["particles"]

    @property
    def tets(self) -> NDArray[np.uint32]:
        """Tetrahedra of solids, shape (t, 4); read-only."""
        return self._layout["tets"]

    @property
    def planes(self) -> NDArray[np.float64]:
        """Half-spaces: unit normal and offset [m], shape (h, 4); read-only."""
        return self._layout["planes"]

    @property
    def obstacle_vertices(self) -> NDArray[np.bool_]:
        """Whether each vertex that collides belongs to an obstacle, shape (c,); read-only."""
        return self._layout["obstacle"]

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions of all vertices [m], shape (n, 3); read-only. Those inside of solids come last."""
        if self._positions is None:
            self._positions = _arrays.read_only(self._native.positions())
        return self._positions

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities of all vertices [m/s], shape (n, 3); read-only."""
        if self._velocities is None:
            self._velocities = _arrays.read_only(self._native.velocities())
        return self._velocities

    def _body(self, name: str) -> int:
        names = self._layout["names"]
        if name in self._layout["plane_names"]:
            raise InputError(f'"{name}" is a half-space: it has no vertices; `planes` has its normal and offset')
        if name not in names:
            raise InputError(f'no body or obstacle with a mesh "{name}"; there are: {", ".join(names)}')
        return names.index(name)

    def vertices_of(self, name: str) -> NDArray[np.int64]:
        """The vertices of a body or an obstacle in the order of its mesh, by their numbers in the simulation; -1 for
        vertices that no element names. Shape (v,); read-only."""
        if name not in self._orders:
            order = call(self._native.mesh_order, self._body(name))
            self._orders[name] = _arrays.read_only(order)
        return self._orders[name]

    def _rows(self, array: NDArray[np.float64], name: str) -> NDArray[np.float64]:
        order = self.vertices_of(name)
        if len(order) > 0 and order[0] >= 0 and (np.diff(order) == 1).all():
            return array[order[0] : order[-1] + 1]
        rows = np.where((order >= 0)[:, None], array[order], np.nan)
        return _arrays.read_only(rows)

    def positions_of(self, name: str) -> NDArray[np.float64]:
        """Positions of a body or an obstacle in the order of its mesh [m], shape (v, 3); nan for vertices that no
        element names. Read-only, and a view without a copy where the orders agree."""
        return self._rows(self.positions, name)

    def velocities_of(self, name: str) -> NDArray[np.float64]:
        """Velocities of a body or an obstacle [m/s], as `positions_of` has its positions."""
        return self._rows(self.velocities, name)

    def faces_of(self, name: str) -> NDArray[np.uint32]:
        """Triangles of a body or an obstacle, by the vertices of its mesh, shape (f, 3). Of a solid, its surface."""
        order = self.vertices_of(name)
        numbers = np.zeros(len(self.positions), np.uint32)
        named = np.flatnonzero(order >= 0)
        numbers[order[named]] = named
        start, end = self._layout["ranges"][self._body(name)][:2]
        first = self.faces[:, 0]
        return numbers[self.faces[(first >= start) & (first < end)]]

    def check(self, *, limit: int = 100, distance: bool = True) -> CheckReport:
        """Judges the present state by exact predicates, with the collision groups of its bodies.

        Parameters
        ----------
        limit : int
            How many intersections are listed; all are counted.
        distance : bool
            Whether the smallest distance is found, which costs about as much again.

        Returns
        -------
        CheckReport
            True, as no state of a simulation intersects.
        """
        return CheckReport(*call(self._native.check, count_of("limit", limit), bool(distance)))

    def mass_of(self, name: str) -> float:
        """Mass of a body [kg]: what its material and mesh make. Obstacles have none, which is 0."""
        return call(self._native.mass_of, name)

    # Forces

    def contacts(self) -> Contacts:
        """The contacts that carried a force at the end of the last time step."""
        return contacts_of(call(self._native.contacts))

    def contact_wrench(
        self, name: str, about: ArrayLike = (0.0, 0.0, 0.0), *, by: str | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Force [N] and torque [N m] about a point that contacts exert on a body, an obstacle or a half-space: all of
        them, or those with ``by`` alone."""
        force, torque = call(self._native.contact_wrench, name, _arrays.vector("about", about), by)
        return np.array(force), np.array(torque)

    def pin_forces(self, name: str) -> NDArray[np.float64]:
        """Forces that a pin exerted on its vertices in the last time step [N], shape (p, 3); empty if none."""
        return call(self._native.pin_forces, name)

    def pin_wrench(
        self, name: str, about: ArrayLike = (0.0, 0.0, 0.0)
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Force [N] and torque [N m] about a point that a pin exerted on its body in the last time step."""
        force, torque = call(self._native.pin_wrench, name, _arrays.vector("about", about))
        return np.array(force), np.array(torque)

    # Changes

    def add_pin(self, name: str, body: str, vertices: ArrayLike) -> None:
        """Adds a pin that holds vertices of a body where they are, until it is led or removed.

        Parameters
        ----------
        name : str
            A name that no pin has.
        body : str
            The body.
        vertices : array_like of integers, shape (p,)
            Vertices of its mesh.
        """
        count = len(self.vertices_of(body))
        self._change(self._native.add_pin, name, body, _arrays.elements("vertices", vertices, None, count), layout=True)

    def remove_pin(self, name: str) -> None:
        """Removes a pin: its vertices are free from the next time step on."""
        self._change(self._native.remove_pin, name, layout=True)

    def set_pin_targets(self, name: str, targets: ArrayLike) -> None:
        """Leads the vertices of a pin to targets [m] at the end of the next time step, shape (p, 3)."""
        self._change(self._native.set_pin_targets, name, _arrays.points("targets", targets))

    def set_pin_pose(self, name: str, pose: ArrayLike) -> None:
        """Leads the vertices of a pin as a rigid body: to where the matrix ``pose`` of shape (4, 4) takes the places
        that they had when the pin was added."""
        self._change(self._native.set_pin_pose, name, _arrays.pose("pose", pose))

    def set_obstacle_targets(self, name: str, targets: ArrayLike) -> None:
        """Leads the vertices of an obstacle to targets [m] at the end of the next time step, in the order of its mesh,
        shape (v, 3). It stays there until it is led elsewhere."""
        self._change(self._native.set_obstacle_targets, name, _arrays.points("targets", targets))

    def set_obstacle_pose(self, name: str, pose: ArrayLike) -> None:
        """Leads an obstacle as a rigid body: to where the matrix ``pose`` of shape (4, 4) takes it from its place in
        the scene."""
        self._change(self._native.set_obstacle_pose, name, _arrays.pose("pose", pose))

    def set_gravity(self, gravity: ArrayLike) -> None:
        """Sets the gravity [m/s^2], three numbers."""
        self._change(self._native.set_gravity, _arrays.vector("gravity", gravity))

    def set_wind(self, wind: ArrayLike) -> None:
        """Sets the wind [m/s], three numbers; it acts where ``simulation.air_density`` is above 0."""
        self._change(self._native.set_wind, _arrays.vector("wind", wind))

    def set_external_forces(self, forces: ArrayLike) -> None:
        """Sets a force on each vertex of the simulation [N], shape (n, 3), which stays until it is set again."""
        self._change(self._native.set_external_forces, _arrays.points("forces", forces, len(self.positions)))

    def set_velocities(self, body: str, velocities: ArrayLike) -> None:
        """Sets the velocities of a deformable body [m/s], in the order of its mesh, shape (v, 3)."""
        self._change(self._native.set_velocities, body, _arrays.points("velocities", velocities))

    def place(self, name: str, positions: ArrayLike) -> None:
        """Puts a body or an obstacle somewhere else at once [m], in the order of its mesh, shape (v, 3).

        Raises
        ------
        IntersectionError
            Something would intersect there. Nothing has changed then.
        """
        self._change(self._native.place, name, _arrays.points("positions", positions))

    def add_body(
        self,
        mesh: Any = None,
        faces: ArrayLike | None = None,
        *,
        tets: ArrayLike | None = None,
        edges: ArrayLike | None = None,
        **keys: Any,
    ) -> None:
        """Adds a body as `Scene.add_body` does; it must have a name and intersect nothing. It takes as long as a new
        simulation."""
        scene = Scene()
        scene._extend(bodies=[_named(_entry(mesh, faces, tets, edges, keys))])
        self._change(self._native.add, scene._native, layout=True)

    def add_obstacle(
        self,
        mesh: Any = None,
        faces: ArrayLike | None = None,
        *,
        tets: ArrayLike | None = None,
        edges: ArrayLike | None = None,
        **keys: Any,
    ) -> None:
        """Adds an obstacle, as `add_body` adds a body."""
        scene = Scene()
        scene._extend(obstacles=[_named(_entry(mesh, faces, tets, edges, keys))])
        self._change(self._native.add, scene._native, layout=True)

    def remove(self, name: str) -> None:
        """Removes a body, with its pins, an obstacle or a half-space."""
        self._change(self._native.remove, name, layout=True)

    def set_material(self, body: str, material: str | Mapping[str, Any]) -> None:
        """Gives a body another material of its kind: a name, or a dict of its numbers over those of ``base``. It takes
        as long as a new simulation."""
        text = _toml.value("material", material)
        self._change(self._native.set_material, body, text, layout=True)

    def set_friction(self, name: str, friction: float) -> None:
        """Sets the coefficient of Coulomb friction of a body, an obstacle or a half-space [1]."""
        self._change(self._native.set_friction, name, float(friction), layout=True)

    def set_measured(self, measured: bool) -> None:
        """Whether time steps measure energies and the like, which costs some hundredths and changes no result."""
        self._change(self._native.set_measured, bool(measured))

    # State

    def checkpoint(self) -> Checkpoint:
        """The state, with all that was changed."""
        return Checkpoint(call(self._native.checkpoint))

    def restore(self, checkpoint: Checkpoint, *, check: bool = True) -> None:
        """Goes on from a state of the scene that this simulation was made of: its own, or one of another `Simulator`
        or `run` of that scene, on any backend. Gravity, pins, bodies and materials are then those of the state, not
        those changed since.

        A state of another scene is refused if it has other numbers of vertices, of bodies, obstacles and half-spaces,
        or of pins and their vertices. Other differences, such as of materials or shapes, are not seen.

        Parameters
        ----------
        checkpoint : Checkpoint
            The state.
        check : bool
            Whether it is judged, as one from elsewhere must be; it costs about as much as a two-way step.

        Raises
        ------
        InputError
            A state that does not fit, or that intersects. The simulation is then as it was.
        """
        if not isinstance(checkpoint, Checkpoint):
            raise InputError(f"checkpoint: expected a Checkpoint, got {type(checkpoint).__name__}")
        self._change(self._native.restore, checkpoint._native, bool(check), layout=True)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes `checkpoint` to a file."""
        self.checkpoint().save(path)

    def __reduce__(self) -> tuple[Any, ...]:
        return _resumed, (self._scene, self.checkpoint(), self._options)

    # Looks

    def render(self, **options: Any) -> NDArray[np.uint8]:
        """Draws the present state; see `bowknot.render`."""
        return _pictures.render(self, **options)

    def play(
        self,
        frames: int | None = None,
        *,
        every: int = 1,
        speed: float = 1.0,
        progress: bool | Callback | None = None,
        **options: Any,
    ) -> Movie:
        """Makes time steps and a picture of each. A notebook shows them while they are computed, with a bar.

        Parameters
        ----------
        frames : int, optional
            How many time steps. Default: up to the number of frames of the scene.
        every : int
            Every how many time steps a picture is made; the first and the last state have one.
        speed : float
            How fast the movie plays: 1 is the time of the simulation.
        progress : bool or function, optional
            As of `bowknot.run`. With a function, or False, a notebook shows nothing meanwhile.
        **options
            Options of `bowknot.render`, by default ``size=(480, 360)`` and ``quality="fast"``.

        Returns
        -------
        Movie
            As the last line of a notebook's cell it plays; `Movie.save` writes a file that browsers play.

        Raises
        ------
        DeviceError
            No graphics driver.
        InputError, KeyboardInterrupt
            As of `step`.
        """
        return _movie.play(self, frames, every=every, speed=speed, progress=progress, **options)

    def __repr__(self) -> str:
        return f"Simulator({self._scene.name!r}: frame {self.frame} at {self.time:g} s, {len(self.positions)} vertices)"

    def _repr_html_(self) -> str:
        return _pictures.html(self)


def _named(entry: dict[str, Any]) -> dict[str, Any]:
    if not entry.get("name"):
        raise InputError("name: a body or an obstacle that is added to a simulation needs one")
    return entry


def _resumed(scene: Scene, checkpoint: Checkpoint, options: tuple[str, int | None]) -> Simulator:
    """A simulation that was pickled."""
    backend, device = options
    simulator = Simulator(scene, backend=backend, device=device)
    simulator.restore(checkpoint, check=False)
    return simulator
