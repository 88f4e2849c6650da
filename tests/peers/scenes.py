"""The three scenes: meshes, obstacles and motion, the same for all solvers. SI units, z is up."""

from dataclasses import dataclass, field

import numpy as np

FPS = 60
GRAVITY = 9.81

# Material of the solids, which all solvers can express: Young's modulus [Pa], Poisson's ratio, density [kg/m3].
YOUNG, POISSON, DENSITY = 5.0e4, 0.3, 300.0


@dataclass
class Body:
    name: str
    x: np.ndarray  # [n,3], at rest
    triangles: np.ndarray  # [m,3]; of a solid: its surface
    tets: np.ndarray | None = None  # [k,4], of a solid
    spacing: float = 0.0  # distance of neighbors on the grid [m]
    shape: tuple[int, ...] = ()  # vertices along each side of the grid; the last side counts fastest


    def outside(self):
        """Vertices of the surface, in their order."""
        return np.unique(self.triangles)

    def shell(self):
        """The surface as a mesh of its own."""
        used = self.outside()
        return Body(self.name, self.x[used], np.searchsorted(used, self.triangles))


@dataclass
class Scene:
    name: str
    title: str
    bodies: list[Body]
    frames: int
    gravity: float = GRAVITY
    ground: bool = False  # the plane z = 0, which has no mesh and is not judged
    ball: tuple[float, tuple[float, float, float]] | None = None  # radius and center
    turn: float = 0.0  # rate of the two ends of body 0 about the x axis [rad/s]
    obstacles: list[Body] = field(default_factory=list)  # meshes to judge against

    def held(self):
        """Vertices of body 0 at its two ends, and the sense in which each turns."""
        side = self.bodies[0].shape[1]
        count = len(self.bodies[0].x)
        ids = np.concatenate([np.arange(side), np.arange(count - side, count)])
        return ids, np.repeat([1.0, -1.0], side)

    def held_at(self, time):
        """Positions of the held vertices."""
        ids, sense = self.held()
        x, y, z = self.bodies[0].x[ids].T
        c, s = np.cos(sense * self.turn * time), np.sin(sense * self.turn * time)
        return np.stack([x, c * y - s * z, s * y + c * z], axis=1)


def sheet(name, center, size, count):
    """A square cloth of count x count vertices; diagonals alternate."""
    along = np.linspace(-0.5 * size, 0.5 * size, count)
    x, y = np.meshgrid(along, along, indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), np.zeros(count**2)], axis=1) + center
    i, j = np.meshgrid(np.arange(count - 1), np.arange(count - 1), indexing="ij")
    i, j = i.ravel(), j.ravel()
    a, b, c, d = (count * (i + u) + j + v for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)))
    even = ((i + j) % 2 == 0)[:, None]
    first = np.where(even, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(even, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return Body(name, points, np.concatenate([first, second]), None, size / (count - 1), (count, count))


def block(name, center, yaw, size, count):
    """A cube of count^3 vertices, six tetrahedra per cell, turned about the z axis [deg]."""
    along = np.linspace(-0.5 * size, 0.5 * size, count)
    points = np.stack(np.meshgrid(along, along, along, indexing="ij"), axis=-1).reshape(-1, 3)
    corner = np.arange(count**3).reshape(count, count, count)[:-1, :-1, :-1].ravel()
    steps = {0: count * count, 1: count, 2: 1}
    tets = []
    # Kuhn's division: one tetrahedron for each order in which the three axes are walked.
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (1, 0, 2), (2, 1, 0)):
        walk = [corner]
        for axis in order:
            walk.append(walk[-1] + steps[axis])
        # Walks of odd order have negative volume.
        if order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):
            walk[0], walk[1] = walk[1], walk[0]
        tets.append(np.stack(walk, axis=1))
    tets = np.concatenate(tets)
    c, s = np.cos(np.radians(yaw)), np.sin(np.radians(yaw))
    points = points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + center
    return Body(name, points, surface(tets), tets, size / (count - 1), (count, count, count))


def surface(tets):
    """Faces of one tetrahedron only, outward."""
    faces = np.concatenate([tets[:, k] for k in ([0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3])])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]


def ball(radius, center, divisions=3):
    """An icosphere whose vertices lie on the ball."""
    g = (1.0 + 5.0**0.5) / 2.0
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    points += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4)]
    faces += [(11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8)]
    faces += [(3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    points, faces = np.array(points, float), np.array(faces)
    for _ in range(divisions):
        edges = np.sort(np.concatenate([faces[:, k] for k in ([0, 1], [1, 2], [2, 0])]), axis=1)
        edges, number = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = len(points) + number.reshape(3, -1)
        a, b, c = faces.T
        faces = np.concatenate([np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        points = np.concatenate([points, points[edges].mean(axis=1)])
    points *= radius / np.linalg.norm(points, axis=1, keepdims=True)
    return Body("ball", points + center, faces)


def drape(count=17):
    """Three cloths that fall over a ball onto each other: sizes and places of MuJoCo's model/flex/drape.xml."""
    places = [(0.0, 0.0, 0.68), (0.06, -0.04, 0.78), (-0.05, 0.05, 0.88)]
    cloths = [sheet(f"cloth{k}", place, 0.66, count) for k, place in enumerate(places, 1)]
    round_thing = (0.3, (0.0, 0.0, 0.3))
    return Scene(
        "drape", "three cloths over a ball", cloths, 120, ground=True, ball=round_thing,
        obstacles=[ball(*round_thing)],
    )


def twist(count=28):
    """A cloth whose ends turn against each other by 600 degrees: motion of Newton's example cloth_twist."""
    return Scene("twist", "a cloth twisted", [sheet("cloth", (0, 0, 0), 1.0, count)], 300, gravity=0.0, turn=np.pi / 3)


def blocks(count=6):
    """Four soft blocks that fall onto each other."""
    places = [(0.0, 0.0), (0.05, 0.02), (-0.04, 0.05), (0.03, -0.05)]
    solids = [
        block(f"block{k}", (x, y, 0.2 + 0.35 * k), 25.0 * k, 0.3, count) for k, (x, y) in enumerate(places)
    ]
    return Scene("blocks", "four soft blocks onto each other", solids, 120, ground=True)


SCENES = {"drape": drape, "twist": twist, "blocks": blocks}
