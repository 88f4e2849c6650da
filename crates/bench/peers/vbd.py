"""The falling sheet in NVIDIA Newton: its VBD solver on the CPU, called as in its examples."""

import io
from contextlib import redirect_stdout
from dataclasses import dataclass, replace

import numpy as np

from fall import DENSITY, GRAVITY, Motion
from measure import Timer
from setting import peer

# Lengths of Newton's cloth examples [m]: the distance at which contacts act, how much farther pairs
# are searched, and the thickness of the sheet towards obstacles.
MARGIN, GAP, RADIUS = 0.002, 0.0015, 0.002


@dataclass(frozen=True)
class Settings:
    name: str
    substeps: int
    iterations: int
    # Contacts of the sheet with itself, and with them the cut of its motion at planes between its parts.
    self_contact: bool = True
    # Whether motion is cut at planes against the obstacle too; Newton's default is not to.
    cut_at_obstacle: bool = False
    # How much farther than the margin pairs are searched [m]; a part of it bounds a step.
    gap: float = GAP
    # Number of pairs that a vertex can hold; an edge can hold twice as many. More are dropped silently.
    buffer: int = 64
    # Pairs within so many rings of each other are left out.
    rings: int = 2
    # Pairs are searched anew before each iteration, not twice per step.
    search_each: bool = False


# Without any switch: what the constructor of the solver chooses.
BARE = Settings("Newton, constructor's defaults: no self-contact", 10, 10, self_contact=False)
# The switches of its cloth examples.
PLAIN = Settings("Newton, 1 step of 10 iterations", 1, 10)
TWO = Settings("Newton, 2 steps of 10 iterations", 2, 10)
FOUR = Settings("Newton, 4 steps of 10 iterations", 4, 10)
FINE = Settings("Newton, 10 steps of 4", 10, 4)
CUT = Settings("Newton, 10 steps of 4, cut at obstacles", 10, 4, cut_at_obstacle=True)
WIDE = replace(CUT, name="Newton, 10 steps of 4, cut, pairs to 12 mm", gap=0.01, buffer=512)
# All that its documentation names against tunneling.
ALL = replace(WIDE, name="Newton, 10 steps of 4, all switches", rings=1, search_each=True)


def run(scene, settings, frames):
    """Moves the sheet. Before the timing, one discarded step compiles the kernels."""
    newton, wp = peer("newton"), peer("warp")
    wp.config.quiet = True
    with redirect_stdout(io.StringIO()), wp.ScopedDevice("cpu"):
        _steps(newton, wp, scene, settings, 1)
        return _steps(newton, wp, scene, settings, frames)


def _steps(newton, wp, scene, settings, frames):
    model = _model(newton, wp, scene)
    solver = _solver(newton, model, settings)
    now, following, control = model.state(), model.state(), model.control()
    motion = Motion([now.particle_q.numpy().copy()], [], [], settings.substeps)
    h = scene.dt / settings.substeps
    for _ in range(frames):
        timer = Timer()
        solver.rebuild_bvh(now)
        for _ in range(settings.substeps):
            now.clear_forces()
            solver.step(now, following, control, None, h)
            now, following = following, now
        motion.cpu.append(timer.cpu())
        motion.wall.append(timer.wall())
        motion.sheets.append(now.particle_q.numpy().copy())
    motion.sheets = np.array(motion.sheets, dtype=np.float64)
    return motion


def _model(newton, wp, scene):
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
    points, faces = scene.obstacle_mesh
    shape = newton.ModelBuilder.ShapeConfig(mu=0.0, ke=1.0e3, kd=1.0e-1, margin=0.0)
    obstacle = newton.Mesh(points.astype(np.float32), faces.ravel())
    builder.add_shape_mesh(body=-1, mesh=obstacle, cfg=shape)
    points, faces = scene.sheet
    mu, lame = scene.lame
    builder.add_cloth_mesh(
        pos=wp.vec3(0.0),
        rot=wp.quat_identity(),
        scale=1.0,
        vel=wp.vec3(0.0),
        vertices=[wp.vec3(*point) for point in points],
        indices=faces.ravel().tolist(),
        density=DENSITY,
        tri_ke=mu,
        tri_ka=lame,
        tri_kd=0.0,
        edge_ke=scene.hinge_stiffness,
        edge_kd=0.0,
        particle_radius=RADIUS,
    )
    builder.color(include_bending=True)
    model = builder.finalize(device="cpu")
    model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu = 1.0e3, 1.0e-1, 0.0
    return model


def _solver(newton, model, settings):
    pipeline = newton.CollisionPipeline(
        model,
        soft_contact_gap=MARGIN + settings.gap,
        enable_rigid_soft_full_surface_contact=True,
        contact_matching="latest",
    )
    base = newton.solvers.SolverBase
    slots = [base.CollisionSlot.RIGID, base.CollisionSlot.SOFT_SELF_CONTACT] if settings.search_each else []
    return newton.solvers.SolverVBD(
        model,
        iterations=settings.iterations,
        particle_enable_self_contact=settings.self_contact,
        particle_self_contact_margin=MARGIN,
        particle_self_contact_gap=settings.gap,
        particle_vertex_contact_buffer_size=settings.buffer,
        particle_edge_contact_buffer_size=2 * settings.buffer,
        particle_topological_contact_filter_threshold=settings.rings,
        rigid_soft_enable_dat=settings.cut_at_obstacle,
        collision_pipeline=pipeline,
        collision_frequency=dict.fromkeys(slots, 1),
        collision_frequency_type=dict.fromkeys(slots, base.CollisionFrequencyType.ITERATIONS),
    )
