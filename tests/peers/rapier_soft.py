"""rapier's soft bodies, through its Python package, with the defaults of its constructors."""

import importlib.metadata

import numpy as np
import rapier3d as rapier

from scenes import DENSITY, FPS, POISSON, YOUNG

VERSION = f"rapier3d {importlib.metadata.version('rapier3d')}, soft bodies"
# Its user guide, "Soft-body contacts", recommends the thickness that the constructors choose, half the distance of
# neighbors; contacts of a body with itself must be asked for.
EXAMPLES = {"drape": "defaults", "twist": "defaults", "blocks": "defaults, corotational cells"}

CLOTH_DENSITY = 0.2


def simulate(scene):
    """Yields the positions of all bodies frame by frame."""
    world = rapier.PhysicsWorld(gravity=(0.0, 0.0, -scene.gravity))
    world.integration_parameters.dt = 1.0 / FPS
    _add_obstacles(world, scene)
    bodies = [world.soft_bodies[world.add_soft_body(_soft_body(body, scene))] for body in scene.bodies]
    yield _positions(bodies)
    for frame in range(scene.frames):
        if scene.turn:
            at = scene.held_at((frame + 1) / FPS)
            for vertex, place in zip(scene.held()[0].tolist(), at.tolist(), strict=True):
                bodies[0].set_particle_kinematic_target(vertex, place)
        world.step()
        yield _positions(bodies)


def _soft_body(body, scene):
    if body.tets is not None:
        builder = rapier.SoftBodyBuilder(body.x.tolist()).cells(body.tets.tolist())
        builder = builder.particle_radius(0.5 * body.spacing).cell_model(rapier.SoftBodyCellModel.COROTATIONAL)
        builder = builder.material(rapier.SoftBodyMaterial(young_modulus=YOUNG, poisson_ratio=POISSON))
        return builder.self_contacts(True).mass(DENSITY * body.spacing**3 * len(body.tets) / 6.0)
    along_x, along_y = (body.spacing, 0.0, 0.0), (0.0, body.spacing, 0.0)
    builder = rapier.SoftBody.cloth(body.x[0].tolist(), along_x, along_y, *body.shape)
    builder = builder.self_contacts(True).mass(CLOTH_DENSITY * body.spacing**2 * len(body.triangles) / 2.0)
    return builder.pinned_particles(scene.held()[0].tolist()) if scene.turn else builder


def _add_obstacles(world, scene):
    if scene.ground:
        world.add_body(rapier.RigidBody.fixed(), [rapier.Collider.halfspace((0.0, 0.0, 1.0))])
    if scene.ball:
        radius, center = scene.ball
        world.add_body(rapier.RigidBody.fixed(translation=center), [rapier.Collider.ball(radius)])


def _positions(bodies):
    return np.concatenate([body.particle_positions for body in bodies])
