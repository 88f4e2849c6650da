"""The cloth between two pads in NVIDIA Newton: its VBD solver on the CPU, all three of them soft bodies."""

import io
from contextlib import redirect_stdout
from dataclasses import dataclass

import numpy as np

import fall
import meshes
from frames import Frames
from measure import Timer
from setting import peer

FRICTION = 0.5
# The distance at which contacts act, and how much farther pairs are searched [m]: that of Bowknot's scene, and the
# slack of as much that the documentation recommends.
MARGIN = GAP = 1.25e-3
# Pads: Young's modulus [Pa], Poisson's ratio, density [kg/m3].
YOUNG, POISSON, PAD_DENSITY = 1.0e6, 0.4, 1000.0
BUFFER = 256


@dataclass(frozen=True)
class Settings:
    name: str
    substeps: int
    iterations: int
    # Stiffness of contacts [N/m].
    contact: float = 1.0e4
    # Pairs within so many rings of each other are left out.
    rings: int = 2


@dataclass
class Body:
    """A mesh; tetrahedra, of a pad; the vertices that are led, how far along x, and when they are there and let go."""

    points: np.ndarray
    triangles: np.ndarray
    tets: np.ndarray | None
    held: np.ndarray
    along: float
    end: float


def read_bodies(folder):
    """The cloth and both pads, from the meshes that the program for rapier writes for Bowknot."""
    points, faces = _read_obj(folder / "cloth.obj")
    upper = np.flatnonzero(points[:, 2] > points[:, 2].max() - 1e-9)
    bodies = [Body(points, faces, None, upper, 0.0, 0.5)]
    for name, sign in (("left", -1.0), ("right", 1.0)):
        points, tets = _read_msh(folder / f"{name}.msh")
        back = np.flatnonzero(sign * points[:, 0] > (sign * points[:, 0]).max() - 1e-9)
        bodies.append(Body(points, _surface(tets), tets, back, -sign * 1.5e-3, np.inf))
    return bodies


def run(bodies, settings, seconds, interval):
    """CPU and wall seconds of the time steps, and the frames of the surfaces, `interval` apart."""
    newton, wp = peer("newton"), peer("warp")
    wp.config.quiet = True
    with redirect_stdout(io.StringIO()), wp.ScopedDevice("cpu"):
        # One discarded step compiles the kernels.
        _steps(newton, wp, bodies, settings, 0.01, 0.01)
        return _steps(newton, wp, bodies, settings, seconds, interval)


def _steps(newton, wp, bodies, settings, seconds, interval):
    model = _model(newton, wp, bodies)
    solver = newton.solvers.SolverVBD(
        model,
        iterations=settings.iterations,
        particle_enable_self_contact=True,
        particle_self_contact_margin=MARGIN,
        particle_self_contact_gap=GAP,
        particle_vertex_contact_buffer_size=BUFFER,
        particle_edge_contact_buffer_size=2 * BUFFER,
        particle_topological_contact_filter_threshold=settings.rings,
    )
    now, following, control = model.state(), model.state(), model.control()
    model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu = settings.contact, 1.0e-3, FRICTION
    starts = np.cumsum([0] + [len(body.points) for body in bodies])[:-1]
    flags, active = model.particle_flags.numpy(), int(newton.ParticleFlags.ACTIVE)
    kept = np.concatenate([first + np.unique(body.triangles) for first, body in zip(starts, bodies, strict=True)])
    x, cpu, wall = [now.particle_q.numpy()[kept].copy()], 0.0, 0.0
    dt = 0.01 / settings.substeps
    steps, between = round(seconds / dt), round(interval / dt)
    for step in range(1, steps + 1):
        timer = Timer()
        if step % settings.substeps == 1 % settings.substeps:
            solver.rebuild_bvh(now)
        now.clear_forces()
        for first, body in zip(starts, bodies, strict=True):
            led = first + body.held
            if step * dt <= body.end:
                goal = body.points[body.held] + [body.along * min(step * dt / 0.3, 1.0), 0.0, 0.0]
                for state in (now, following):
                    q = state.particle_q.numpy()
                    q[led] = goal
                    state.particle_q.assign(q)
            elif not flags[led[0]] & active:
                flags[led] |= active
                model.particle_flags.assign(flags)
        solver.step(now, following, control, None, dt)
        now, following = following, now
        cpu, wall = cpu + timer.cpu(), wall + timer.wall()
        if step % between == 0:
            x.append(now.particle_q.numpy()[kept].copy())
    faces = np.concatenate([first + body.triangles for first, body in zip(starts, bodies, strict=True)])
    owner = np.repeat(np.arange(len(bodies)), [len(np.unique(body.triangles)) for body in bodies])
    faces = np.searchsorted(kept, faces)
    return cpu, wall, Frames(np.array(x, dtype=np.float64), owner, meshes.edges_of(faces)), faces


def _model(newton, wp, bodies):
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -fall.GRAVITY))
    place = {"pos": wp.vec3(0.0), "rot": wp.quat_identity(), "scale": 1.0, "vel": wp.vec3(0.0)}
    for body in bodies:
        points = [wp.vec3(*point) for point in body.points]
        if body.tets is None:
            edge = np.linalg.norm(body.points[1] - body.points[0])
            builder.add_cloth_mesh(
                **place,
                vertices=points,
                indices=body.triangles.ravel().tolist(),
                density=fall.DENSITY,
                tri_ke=0.5 * fall.YOUNG / (1.0 + fall.POISSON),
                tri_ka=fall.YOUNG * fall.POISSON / (1.0 - fall.POISSON**2),
                tri_kd=0.0,
                edge_ke=3.0 * fall.BEND / edge,
                edge_kd=0.0,
                particle_radius=0.5 * MARGIN,
            )
        else:
            builder.add_soft_mesh(
                **place,
                vertices=points,
                indices=body.tets.ravel().tolist(),
                density=PAD_DENSITY,
                k_mu=0.5 * YOUNG / (1.0 + POISSON),
                k_lambda=YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)),
                k_damp=0.0,
                particle_radius=0.5 * MARGIN,
            )
    builder.color(include_bending=True)
    model = builder.finalize(device="cpu")
    flags, first = model.particle_flags.numpy(), 0
    for body in bodies:
        flags[first + body.held] &= ~int(newton.ParticleFlags.ACTIVE)
        first += len(body.points)
    model.particle_flags.assign(flags)
    return model


def _read_obj(path):
    words = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    points = np.array([w[1:] for w in words if w[0] == "v"], dtype=np.float64)
    return points, np.array([w[1:] for w in words if w[0] == "f"], dtype=np.int64) - 1


def _read_msh(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    nodes, elements = lines.index("$Nodes") + 1, lines.index("$Elements") + 1
    points = np.array([line.split()[1:] for line in lines[nodes + 1 : nodes + 1 + int(lines[nodes])]], dtype=np.float64)
    chosen = lines[elements + 1 : elements + 1 + int(lines[elements])]
    return points, np.array([line.split()[3:] for line in chosen], dtype=np.int64) - 1


def _surface(tets):
    """Faces of one tetrahedron only, outward."""
    faces = np.concatenate([tets[:, k] for k in ([0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3])])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]
