"""MuJoCo's flex, with the settings of the models that it comes with."""

import mujoco
import numpy as np

from scenes import DENSITY, FPS, POISSON, YOUNG

VERSION = f"MuJoCo {mujoco.__version__}, flex"
# Which of MuJoCo's models a scene's material, contact and solver settings are taken from.
EXAMPLES = {"drape": "flex/drape.xml", "twist": "flex/drape.xml", "blocks": "flex/jelly.xml"}

# Version 4 refuses the example's integrator "implicitfast" for passive contact of flexes and asks for "discrete".
CLOTH_OPTION = 'timestep="0.002" solver="CG" tolerance="1e-6" iterations="400" integrator="discrete"'
CLOTH = """<contact selfcollide="auto" passive="true" solref="0.01 1" solimp=".95 .99 .0001"/>
<elasticity young="2e4" poisson=".2" thickness="1e-3" elastic2d="both" damping="1e-2"/>"""
CLOTH_RADIUS, CLOTH_DENSITY = 0.004, 0.25 / 0.66**2
SOLID_OPTION = 'timestep="0.001" solver="CG" tolerance="1e-6" integrator="Euler"'
SOLID = f"""<edge damping="1"/><contact selfcollide="none"/>
<elasticity young="{YOUNG}" poisson="{POISSON}"/>"""
SOLID_RADIUS = 0.005


def simulate(scene):
    """Yields the positions of all bodies frame by frame."""
    model = mujoco.MjModel.from_xml_string(_model(scene))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    yield data.flexvert_xpos.copy()
    steps = round(1.0 / FPS / model.opt.timestep)
    # Whole time steps per frame, of at most the example's length.
    model.opt.timestep = 1.0 / FPS / steps
    for frame in range(scene.frames):
        for step in range(steps):
            if scene.turn:
                _turn(scene, (frame + (step + 1) / steps) / FPS, data)
            mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_flex(model, data)
        yield data.flexvert_xpos.copy()


def _model(scene):
    solid = scene.bodies[0].tets is not None
    parts = []
    if scene.ground:
        parts.append('<geom type="plane" size="0 0 1" condim="1"/>')
    if scene.ball:
        radius, center = scene.ball
        parts.append(f'<geom type="sphere" size="{radius}" pos="{_numbers(center)}"/>')
    parts += [_flex(body) for body in scene.bodies]
    ends = _ends(scene, parts) if scene.turn else ""
    return f"""<mujoco><option {SOLID_OPTION if solid else CLOTH_OPTION} gravity="0 0 {-scene.gravity}"/>
<size memory="500M"/><worldbody>{"".join(parts)}</worldbody>{ends}</mujoco>"""


def _flex(body):
    """A body that is free."""
    if body.tets is None:
        elements, mass = body.triangles, CLOTH_DENSITY * body.spacing**2 * len(body.triangles) / 2.0
        inside, radius, dim = CLOTH, CLOTH_RADIUS, 2
    else:
        elements, mass = body.tets, DENSITY * body.spacing**3 * len(body.tets) / 6.0
        inside, radius, dim = SOLID, SOLID_RADIUS, 3
    return f"""<flexcomp name="{body.name}" type="direct" dim="{dim}" radius="{radius}" mass="{mass}"
point="{_numbers(body.x)}" element="{_numbers(elements)}">{inside}</flexcomp>"""


def _ends(scene, parts):
    """Two bodies of prescribed motion, to which the ends are connected as the flag of flex/flag.xml is to the world.

    Vertices that are part of such a body are refused for elastic flexes.
    """
    parts += [f'<body name="end{k}" mocap="true"/>' for k in range(2)]
    ids, sense = scene.held()
    ends = zip(ids.tolist(), (sense < 0.0).astype(int).tolist(), strict=True)
    name = scene.bodies[0].name
    connects = [f'<connect body1="{name}_{k}" body2="end{end}" anchor="0 0 0"/>' for k, end in ends]
    return f"<equality>{''.join(connects)}</equality>"


def _turn(scene, time, data):
    for end, sense in enumerate((1.0, -1.0)):
        half = 0.5 * sense * scene.turn * time
        data.mocap_quat[end] = np.cos(half), np.sin(half), 0.0, 0.0


def _numbers(array):
    return " ".join(repr(number) for number in np.ravel(array).tolist())
