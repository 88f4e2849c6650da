"""Simulations: the bits of the command, changes between time steps, checkpoints."""

import json
import multiprocessing
import pickle
import platform
import re
import subprocess
import warnings

import numpy as np
import pytest
from conftest import ROOT, grid

import bowknot
from bowknot import Checkpoint, InputError, IntersectionError, Scene, Simulator

FRAMES = 6


@pytest.mark.parametrize("name", ["drape", "needle", "hair", "sand", "trampoline"])
def test_results_have_the_bits_of_the_command(command, tmp_path, name):
    out = tmp_path / name
    arguments = ["run", name, "--scale", "0.2", "--frames", str(FRAMES), "--out", str(out), "--quiet"]
    subprocess.run([command, *arguments], check=True, timeout=300)
    scene = Scene.builtin(name, scale=0.2)
    scene.set("simulation.frames", FRAMES)
    simulator = Simulator(scene)
    infos = list(simulator)
    with np.load(out / "checkpoint" / "state.npz") as state:
        assert state["positions"].tobytes() == simulator.positions.tobytes()
        assert state["velocities"].tobytes() == simulator.velocities.tobytes()
    saved = Checkpoint.load(out / "checkpoint" / "state.npz")
    assert saved == simulator.checkpoint() and saved.step == FRAMES
    lines = [json.loads(line) for line in (out / "stats.jsonl").read_text().splitlines()]
    assert len(lines) == len(infos)
    for line, info in zip(lines, infos):
        for key in ("two_way_steps", "residual_m", "energy", "min_gap_m", "solved"):
            assert info[key] == line[key], key
    # And `run` writes what the command writes.
    run = bowknot.run(scene, tmp_path / "again")
    frame = f"frames/{FRAMES:06}.ply"
    assert (run.folder / frame).read_bytes() == (out / frame).read_bytes()
    assert run.stats[-1]["residual_m"] == lines[-1]["residual_m"]


GOLDEN = ROOT / "crates" / "bowknot" / "tests" / "suite"


def fnv(content):
    """The 64-bit FNV-1a hash."""
    value = 0xCBF29CE484222325
    for byte in content:
        value = ((value ^ byte) * 0x100000001B3) % 2**64
    return value


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="the hashes are those of x86-64")
def test_results_have_the_golden_hashes_of_the_library():
    scenes = re.findall(r'\("([\w-]+)", ([\d.]+), (\d+)\)', (GOLDEN / "golden.rs").read_text(encoding="utf-8"))
    accepted = (GOLDEN / "golden.txt").read_text(encoding="utf-8")
    found = ""
    for name, scale, frames in scenes:
        simulator = Simulator(Scene.builtin(name, scale=float(scale)))
        for _ in simulator.steps(int(frames)):
            pass
        found += f"{name} {fnv(simulator.positions.tobytes() + simulator.velocities.tobytes()):016x}\n"
    assert len(scenes) == 5 and found == accepted


def test_iteration_ends_with_the_frames_of_the_scene():
    scene = Scene.builtin("drape", scale=0.2)
    scene.set("simulation.frames", 3)
    simulator = Simulator(scene)
    assert [info.step for info in simulator] == [1, 2, 3]
    assert list(simulator) == []
    assert [info.step for info in simulator.steps(2)] == [4, 5]
    assert simulator.frame == 5 and abs(simulator.time - 5 * scene.dt) < 1e-12


def test_the_judge_looks_at_simulations(small):
    for _ in small.steps(5):
        report = small.check()
        assert report and report.min_distance_m > 0.0 and report.findings == []
    assert small.check(distance=False).nearest is None


def test_arrays_are_snapshots_that_nobody_writes_to(small):
    first = small.positions
    assert first is small.positions and not first.flags.writeable
    copy = first.copy()
    small.step()
    assert (first == copy).all() and (small.positions != first).any()
    for array in (
        small.velocities,
        small.faces,
        small.edges,
        small.particles,
        small.planes,
        small.obstacle_vertices,
    ):
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    name = small.scene.bodies[0]
    assert np.shares_memory(small.positions_of(name), small.positions)
    assert not small.positions_of(name).flags.writeable
    assert small.velocities_of(name).shape == small.positions_of(name).shape
    with pytest.raises(InputError, match="there are"):
        small.positions_of("skirt")
    with pytest.raises(AttributeError, match="two_way_steps"):
        small.step().no_such_number


def test_vertices_that_no_face_names_are_nan():
    vertices, faces = grid(4, 0.3, 0.2)
    vertices = np.concatenate([[[9.0, 9.0, 9.0]], vertices])
    scene = Scene(bodies=[{"name": "cloth", "mesh": vertices, "faces": faces + 1}])
    simulator = Simulator(scene)
    positions = simulator.positions_of("cloth")
    assert np.isnan(positions[0]).all() and (positions[1:] == vertices[1:]).all()
    assert (simulator.faces_of("cloth") == faces + 1).all()


def led():
    """A sheet of arrays over the ground, which is held at a corner."""
    vertices, faces = grid(7, 0.3, 0.3)
    scene = Scene(simulation={"frames": 100})
    scene.add_body(vertices, faces, name="cloth", friction=0.4)
    scene.add_obstacle(shape="half-space", name="ground", friction=0.4)
    box = {"type": "box", "size": [0.1, 0.1, 0.1], "edge": 0.05}
    scene.add_obstacle(shape=box, name="finger", translate=[0, 0, 0.15])
    simulator = Simulator(scene)
    simulator.add_pin("hand", "cloth", [0, 6])
    return simulator, vertices


def pose(x=0.0, y=0.0, z=0.0, angle=0.0):
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[:2, :2] = [[c, -s], [s, c]]
    matrix[:3, 3] = [x, y, z]
    return matrix


def test_pins_and_obstacles_are_led():
    simulator, vertices = led()
    assert simulator.pins == ["hand"] and simulator.names == ["cloth", "finger", "ground"]
    for step in range(1, 11):
        simulator.set_pin_pose("hand", pose(z=0.002 * step))
        simulator.set_obstacle_pose("finger", pose(x=0.001 * step, angle=0.01 * step))
        simulator.step()
    held = simulator.positions_of("cloth")[[0, 6]]
    assert np.allclose(held, vertices[[0, 6]] + [0.0, 0.0, 0.02])
    force, torque = simulator.pin_wrench("hand")
    assert force[2] > 0.0 and torque.shape == (3,)
    assert np.allclose(simulator.pin_forces("hand").sum(axis=0), force)
    finger = simulator.positions_of("finger").mean(axis=0)
    assert abs(finger[0] - 0.01) < 1e-9
    targets = simulator.positions_of("cloth")[[0, 6]] + [0.0, 0.0, 0.001]
    simulator.set_pin_targets("hand", targets)
    simulator.set_obstacle_targets("finger", simulator.positions_of("finger") + [0.001, 0.0, 0.0])
    simulator.step()
    assert np.allclose(simulator.positions_of("cloth")[[0, 6]], targets)
    simulator.remove_pin("hand")
    for _ in simulator.steps(40):
        pass
    contacts = simulator.contacts()
    assert len(contacts) > 0 and contacts.forces.shape == (len(contacts), 3)
    assert np.allclose(np.linalg.norm(contacts.normals, axis=1), 1.0) and (contacts.gaps > 0).all()
    assert set(np.unique(contacts.bodies)) <= {0, 1, 2}
    loads = [simulator.contact_wrench(name)[0] for name in simulator.names]
    assert loads[0][2] > 0.0 and np.allclose(np.sum(loads, axis=0), 0.0)
    for body, load in enumerate(loads):
        sides = [(contacts.bodies[:, side] == body)[:, None] * contacts.forces for side in (0, 1)]
        assert np.allclose((sides[0] - sides[1]).sum(axis=0), load)


def test_forces_velocities_materials_and_bodies_change():
    simulator, vertices = led()
    simulator.set_gravity([0.0, 0.0, 0.0])
    simulator.set_velocities("cloth", np.zeros_like(vertices) + [0.1, 0.0, 0.0])
    simulator.remove_pin("hand")
    simulator.step()
    assert abs(simulator.velocities_of("cloth")[:, 0].mean() - 0.1) < 1e-3
    simulator.set_external_forces(np.zeros_like(simulator.positions))
    simulator.set_wind([1.0, 0.0, 0.0])
    simulator.set_material("cloth", "silk")
    simulator.set_material("cloth", {"base": "cotton", "density": 0.3})
    simulator.set_friction("ground", 0.1)
    simulator.place("cloth", vertices + [0.0, 0.0, 0.5])
    assert (simulator.positions_of("cloth") == vertices + [0.0, 0.0, 0.5]).all()
    simulator.add_body(vertices + [0.0, 0.0, 1.0], grid(7)[1], name="second")
    simulator.add_obstacle(shape={"type": "ball", "radius": 0.1, "edge": 0.05}, name="ball", translate=[2, 0, 0])
    assert simulator.names == ["cloth", "second", "finger", "ball", "ground"]
    assert simulator.scene.bodies == ["cloth", "second"]
    simulator.step()
    simulator.remove("second")
    simulator.remove("ball")
    assert simulator.names == ["cloth", "finger", "ground"]
    simulator.step()
    state = simulator.checkpoint()
    simulator.set_measured(False)
    simulator.step()
    simulator.restore(state)
    assert simulator.checkpoint() == state


REFUSED = [
    ("step", lambda s: s.set_pin_pose("hand", np.zeros((4, 4)))),
    ("pose", lambda s: s.set_pin_pose("hand", 2.0 * np.eye(4))),
    ("pose", lambda s: s.set_obstacle_pose("finger", np.full((4, 4), np.nan))),
    ("pose", lambda s: s.set_obstacle_pose("finger", np.eye(3))),
    ("no pin", lambda s: s.set_pin_pose("foot", np.eye(4))),
    ("targets", lambda s: s.set_pin_targets("hand", np.zeros((3, 3)))),
    ("targets", lambda s: s.set_pin_targets("hand", np.full((2, 3), np.inf))),
    ("targets", lambda s: s.set_obstacle_targets("finger", np.zeros((1, 3)))),
    ("obstacle", lambda s: s.set_obstacle_pose("ground", np.eye(4))),
    ("held", lambda s: s.add_pin("other", "cloth", [0])),
    ("vertices", lambda s: s.add_pin("other", "cloth", [1000])),
    ("vertices", lambda s: s.add_pin("other", "cloth", [0.5])),
    ("no vertex", lambda s: s.add_pin("other", "cloth", [])),
    ("name of a pin", lambda s: s.add_pin("hand", "cloth", [8])),
    ("gravity", lambda s: s.set_gravity([0.0, 1.0])),
    ("gravity", lambda s: s.set_gravity([0.0, 0.0, np.nan])),
    ("wind", lambda s: s.set_wind([np.inf, 0.0, 0.0])),
    ("forces", lambda s: s.set_external_forces(np.zeros((1, 3)))),
    ("velocities", lambda s: s.set_velocities("cloth", np.zeros((1, 3)))),
    ("no body", lambda s: s.set_velocities("skirt", np.zeros((1, 3)))),
    ("positions", lambda s: s.place("cloth", np.zeros((1, 3)))),
    ("material", lambda s: s.set_material("cloth", "stone")),
    ("no body", lambda s: s.set_material("skirt", "silk")),
    ("friction", lambda s: s.set_friction("cloth", -1.0)),
    ("name", lambda s: s.add_body(shape="sheet")),
    ("name of a body", lambda s: s.add_body(shape="sheet", name="cloth")),
    ("no body", lambda s: s.remove("skirt")),
    ("last|needs", lambda s: s.remove("cloth")),
    ("checkpoint", lambda s: s.restore(None)),
    ("there are", lambda s: s.contact_wrench("skirt")),
    ("about", lambda s: s.contact_wrench("cloth", about=[0.0])),
    ("no pin", lambda s: s.pin_forces("foot")),
]


def test_what_is_refused_changes_nothing():
    simulator, _ = led()
    simulator.step()
    state = simulator.checkpoint()
    for index, (text, change) in enumerate(REFUSED):
        with pytest.raises(InputError) as refusal:
            change(simulator)
        if text != "step":
            assert any(part in str(refusal.value) for part in text.split("|")), (index, refusal.value)
        assert simulator.checkpoint() == state, index
    with pytest.raises(IntersectionError, match="would intersect"):
        simulator.place("cloth", simulator.positions_of("cloth") - [0.0, 0.0, 0.3])
    assert simulator.checkpoint() == state


def test_a_start_that_intersects_is_named():
    vertices, faces = grid(5, 0.3)
    scene = Scene(
        bodies=[
            {"name": "a", "mesh": vertices, "faces": faces},
            {"name": "b", "mesh": vertices[:, [0, 2, 1]] + [0.01, 0.0, 0.02], "faces": faces},
        ]
    )
    with pytest.raises(IntersectionError, match="the start already intersects"):
        Simulator(scene)


def frames_from(simulator, count):
    return [simulator.step()["residual_m"] for _ in range(count)], simulator.positions


def test_checkpoints_and_pickles_go_on_to_the_same_bits(tmp_path):
    simulator, _ = led()
    for _ in simulator.steps(20):
        pass
    state = simulator.checkpoint()
    simulator.save(tmp_path / "state.npz")
    pickled = pickle.loads(pickle.dumps(simulator))
    assert pickled.frame == simulator.frame and repr(pickled) == repr(simulator)
    expected = frames_from(simulator, 5)
    restored = led()[0]
    restored.restore(pickle.loads(pickle.dumps(state)))
    loaded = led()[0]
    loaded.restore(Checkpoint.load(tmp_path / "state.npz"))
    simulator.restore(state)
    for other in (pickled, restored, loaded, simulator):
        found = frames_from(other, 5)
        assert found[0] == expected[0] and (found[1] == expected[1]).all()
    (tmp_path / "state.npz").write_bytes(b"PK")
    with pytest.raises(InputError, match="not an NPZ archive"):
        Checkpoint.load(tmp_path / "state.npz")
    with pytest.raises(InputError, match="positions|scene"):
        Simulator(Scene.builtin("drape", scale=0.2)).restore(state)


def step_elsewhere(simulator):
    simulator.step()
    return simulator


def test_simulations_go_to_other_processes(small):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        other = pool.apply(step_elsewhere, (small,))
    small.step()
    assert (other.positions == small.positions).all()


def test_warnings_are_logged(caplog):
    vertices, faces = grid(4, 0.1)
    scene = Scene(
        bodies=[{"mesh": vertices, "faces": faces, "name": "inside"}],
        obstacles=[{"shape": {"type": "ball", "radius": 0.5, "edge": 0.2}}],
    )
    with caplog.at_level("WARNING", logger="bowknot"):
        Simulator(scene)
    assert any("inside" in record.getMessage() for record in caplog.records)


def test_a_run_warns_of_time_steps_that_are_not_solved(tmp_path):
    # A single Newton iteration does not balance the forces of an impact.
    scene = Scene.builtin("drape", scale=0.2)
    for key, value in (("frames", 8), ("newton_iterations", 1)):
        scene.set(f"simulation.{key}", value)
    scene.set("body.0.velocity", [0, 0, -4])
    with pytest.warns(bowknot.BowknotWarning) as told:
        run = bowknot.run(scene, tmp_path / "run")
    text = str(told.pop(bowknot.BowknotWarning).message)
    count = run.summary["unsolved_steps"]
    assert count > 0 and text.startswith(f"drape: {count} of 8 time steps ended unsolved: the first is time step ")
    assert "the largest residual is" in text and "times the tolerance" in text
    quarter = scene.dt / 4
    assert f"simulation.dt = {quarter:.5g}" in text and "four times the simulation.frames" in text
    assert "simulation.newton_iterations = 30" in text and "--" not in text
    calm = Scene.builtin("drape", scale=0.2)
    calm.set("simulation.frames", 1)
    with warnings.catch_warnings():
        warnings.simplefilter("error", bowknot.BowknotWarning)
        bowknot.run(calm, tmp_path / "calm")


def test_a_run_logs_each_warning_once(tmp_path, caplog):
    vertices, faces = grid(4, 0.1)
    scene = Scene(simulation={"frames": 0}, bodies=[{"mesh": vertices, "faces": faces, "friction": 0.5}])
    scene.add_obstacle(shape="half-space", translate=[0, 0, -1])
    with caplog.at_level("WARNING", logger="bowknot"):
        bowknot.run(scene, tmp_path / "run")
    assert len(caplog.messages) == len(set(caplog.messages)) == 1 and "friction" in caplog.messages[0]


def test_runs_have_pages_and_refuse_used_folders(tmp_path):
    scene = Scene.builtin("drape", scale=0.2)
    scene.set("simulation.frames", 2)
    run = bowknot.run(scene, tmp_path / "run", check=True)
    assert run.summary["frames"] == 2 and run.summary["intersections"] == 0 and run.findings == []
    assert len(run.stats) == 2 and run.scene.bodies == scene.bodies
    assert len(run.mesh(2).faces) > 0
    page = run.report()
    assert page == tmp_path / "run" / "report.html" and "<html" in page.read_text(encoding="utf-8")
    assert run._repr_html_().startswith("<iframe srcdoc=")
    with pytest.raises(InputError, match="already holds a run"):
        bowknot.run(scene, tmp_path / "run")
    scene.set("simulation.frames", 3)
    assert bowknot.run(scene, tmp_path / "run", resume=True).summary["frames"] == 3
    with pytest.raises(InputError, match="not the folder of a run"):
        bowknot.Run(tmp_path)
    for options in ({"stride": 0}, {"max_bytes": 10}, {"stride": -1}):
        with pytest.raises(InputError):
            run.report(**options)


def test_backends_are_named():
    scene = Scene.builtin("drape", scale=0.2)
    assert Simulator(scene).backend == "cpu"
    assert all(isinstance(line, str) for line in bowknot.gpus())
    with pytest.raises(InputError, match="backend"):
        Simulator(scene, backend="abacus")
    with pytest.raises(InputError, match="device"):
        Simulator(scene, device=0)
    with pytest.raises((bowknot.DeviceError, InputError)):
        Simulator(scene, backend="gpu", device=10**6)


def test_a_half_space_has_no_vertices():
    scene = Scene(bodies=[{"shape": "sheet", "name": "cloth", "translate": [0, 0, 1]}])
    scene.add_obstacle(shape="half-space", name="ground")
    simulator = Simulator(scene)
    assert "ground" in simulator.names
    for ask in (simulator.positions_of, simulator.velocities_of, simulator.faces_of):
        with pytest.raises(InputError, match='"ground" is a half-space: it has no vertices; `planes`'):
            ask("ground")


def test_messages_name_what_python_has():
    line = Scene()
    line.add_body([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 3]], name="a")
    with pytest.raises(InputError, match="zero area.*: `bowknot.repair` drops these, its report counts them"):
        Simulator(line)


def test_what_a_state_of_another_scene_is_refused_for():
    scene = Scene.builtin("drape", scale=0.2)
    simulator = Simulator(scene)
    simulator.step()
    state = simulator.checkpoint()
    other = scene.copy()
    other.set("body.sheet.material", "silk")
    Simulator(other).restore(state)  # not seen
    pinned, more = scene.copy(), scene.copy()
    pinned.add_pin("sheet", [0])
    more.add_obstacle(shape="half-space", name="below", translate=[0, 0, -5])
    for refused, text in (
        (pinned, "its pins"),
        (more, "its obstacles"),
        (Scene.builtin("drape", scale=0.3), "another"),
    ):
        with pytest.raises(InputError, match=text):
            Simulator(refused).restore(state)
    simulator.add_body([[0, 0, 3], [0.1, 0, 3], [0, 0.1, 3]], [[0, 1, 2]], name="late")
    again = Simulator(scene)
    again.restore(simulator.checkpoint())
    assert "late" in again.names
