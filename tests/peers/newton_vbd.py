"""NVIDIA Newton's VBD on the CPU, with the settings of its examples."""

import newton
import numpy as np
import warp as wp

from scenes import DENSITY, FPS, POISSON, YOUNG

VERSION = f"Newton {newton.__version__}, SolverVBD"
# Which example of Newton a scene's material, contact and solver settings are taken from.
EXAMPLES = {"drape": "vbd_dat_rigid_soft", "twist": "cloth_twist", "blocks": "softbody_dropping_to_cloth"}

# Pairs that a vertex can hold, and twice as many that an edge can. Newton drops what is more, so these are larger
# than in the examples, whose meshes are coarser.
BUFFER = 512

CLOTH = {
    "drape": {
        "density": 0.25 / 1.5**2, "tri_ke": 4.0e3, "tri_ka": 4.0e3, "tri_kd": 2.0e-1, "edge_ke": 1.0,
        "particle_radius": 6.0e-3,
    },
    "twist": {
        "density": 0.2, "tri_ke": 1.0e3, "tri_ka": 1.0e3, "tri_kd": 2.0e-4, "edge_ke": 1.0e-3, "edge_kd": 1.0e-2,
    },
}
SOLID = {
    "density": DENSITY, "k_mu": 0.5 * YOUNG / (1.0 + POISSON),
    "k_lambda": YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), "k_damp": 1.0e2, "particle_radius": 0.03,
}
# Stiffness, damping and friction of contacts.
CONTACT = {"drape": (2.0e4, 1.0e-4, 0.6), "twist": (1.0e3, 1.0e-1, 0.2), "blocks": (1.0e5, 1.0, 1.0)}
# Substeps per frame, iterations, distance at which contacts act and how much farther pairs are searched [m].
SOLVER = {"drape": (4, 8, 1.2e-2, 4.0e-2), "twist": (10, 4, 2.0e-3, 1.5e-3), "blocks": (10, 10, 0.01, 0.01)}


def simulate(scene):
    """Yields the positions of all bodies frame by frame."""
    wp.config.quiet = True
    with wp.ScopedDevice("cpu"):
        yield from _simulate(scene)


def _simulate(scene):
    substeps, iterations, margin, gap = SOLVER[scene.name]
    model = _model(scene)
    # With `rigid_soft_enable_dat`, as in the example, the solver detects contacts with obstacles itself.
    cut = scene.name == "drape"
    pipeline = newton.CollisionPipeline(
        model, **({"soft_contact_gap": 0.06, "enable_rigid_soft_full_surface_contact": True} if cut else {})
    )
    solver = newton.solvers.SolverVBD(
        model, iterations=iterations, particle_enable_self_contact=True, particle_self_contact_margin=margin,
        particle_self_contact_gap=gap, particle_vertex_contact_buffer_size=BUFFER,
        particle_edge_contact_buffer_size=2 * BUFFER,
        **({"rigid_soft_enable_dat": True, "collision_pipeline": pipeline} if cut else {}),
    )
    contacts = None if cut else pipeline.contacts()
    now, following, control = model.state(), model.state(), model.control()
    dt = 1.0 / (FPS * substeps)
    # On the CPU, arrays of NumPy share the memory of the state.
    yield now.particle_q.numpy().copy()
    for frame in range(scene.frames):
        solver.rebuild_bvh(now)
        for step in range(substeps):
            now.clear_forces()
            if scene.turn:
                _turn(scene, (frame + (step + 1) / substeps) / FPS, (now, following))
            if contacts is not None:
                pipeline.collide(now, contacts)
            solver.step(now, following, control, contacts, dt)
            now, following = following, now
        yield now.particle_q.numpy().copy()


def _model(scene):
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -scene.gravity))
    if scene.ground:
        builder.add_ground_plane()
    if scene.ball:
        radius, center = scene.ball
        builder.add_shape_sphere(body=-1, xform=wp.transform(wp.vec3(*center), wp.quat_identity()), radius=radius)
    for body in scene.bodies:
        place = {"pos": wp.vec3(0.0), "rot": wp.quat_identity(), "scale": 1.0, "vel": wp.vec3(0.0)}
        points = [wp.vec3(*point) for point in body.x]
        if body.tets is None:
            indices = body.triangles.ravel().tolist()
            builder.add_cloth_mesh(**place, vertices=points, indices=indices, **CLOTH[scene.name])
        else:
            builder.add_soft_mesh(**place, vertices=points, indices=body.tets.ravel().tolist(), **SOLID)
    builder.color()
    model = builder.finalize()
    model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu = CONTACT[scene.name]
    if scene.turn:
        flags = model.particle_flags.numpy()
        flags[scene.held()[0]] &= ~int(newton.ParticleFlags.ACTIVE)
        model.particle_flags.assign(flags)
    return model


def _turn(scene, time, states):
    ids, at = scene.held()[0], scene.held_at(time).astype(np.float32)
    for state in states:
        q = state.particle_q.numpy()
        q[ids] = at
        state.particle_q.assign(q)
