"""The collision stage behind other dynamics."""

import inspect
import math
import pickle
import threading
import warnings

import numpy as np
import pytest
from conftest import grid, two_sheets

import bowknot
from bowknot import InputError, IntersectionError, Resolver


def swapped(x):
    """A target that swaps the two sheets, and more."""
    half = len(x) // 2
    y = x.copy()
    y[:half, 2] += 0.5
    y[half:, 2] -= 0.5
    return y


def test_nothing_intersects_however_far_the_target():
    x, faces = two_sheets(12)
    resolver = Resolver(x, faces)
    before = x.copy()
    moved, info = resolver.resolve(x, swapped(x), dt=0.01)
    assert (x == before).all()
    assert moved is not x and np.abs(moved - x).max() > 0.01
    assert info.steps > 0 and info.min_gap_m > 0.0
    report = bowknot.check(moved, faces)
    assert report and report.min_distance_m > 0.0
    half = len(x) // 2
    assert moved[half:, 2].min() > moved[:half, 2].min()


def test_fixed_vertices_arrive_and_others_yield():
    x, faces = two_sheets(8)
    held = [0, 7, 56, 63]
    y = x.copy()
    y[:64, 2] -= 1.0
    y[held] = x[held]
    moved, _ = Resolver(x, faces, fixed=held).resolve(x, y)
    assert (moved[held] == x[held]).all()
    assert moved[20, 2] < 0.0
    flags = np.zeros(len(x), bool)
    flags[held] = True
    again, _ = Resolver(x, faces, fixed=flags).resolve(x, y)
    assert (again == moved).all()
    of_call, _ = Resolver(x, faces).resolve(x, y, fixed=held)
    assert (of_call == moved).all()


def test_results_are_the_same_for_any_number_of_threads_and_in_place():
    x, faces = two_sheets(12)
    results = []
    for count in (1, 2, 3):
        bowknot.set_threads(count)
        assert bowknot.threads() == count
        results.append(Resolver(x, faces).resolve(x, swapped(x), dt=0.01)[0])
    bowknot.set_threads(0)
    assert (results[0] == results[1]).all() and (results[0] == results[2]).all()
    inside = x.copy()
    info = Resolver(x, faces).resolve_in_place(inside, swapped(x), dt=0.01)
    assert (inside == results[0]).all() and info.steps > 0
    # Into every other row of a larger array.
    large = np.zeros((2 * len(x), 3))
    result, _ = Resolver(x, faces).resolve(x, swapped(x), dt=0.01, out=large[::2])
    assert (large[::2] == results[0]).all() and np.shares_memory(result, large)
    assert (large[1::2] == 0.0).all()


def test_a_loop_of_ones_own_dynamics():
    x, faces = grid(10, 0.5, 0.2)
    ground = [[0.0, 0.0, 1.0, 0.0]]
    resolver = Resolver(x, faces, planes=ground, friction=0.5, stretch_limit=math.inf)
    v, dt = np.zeros_like(x), 0.01
    for _ in range(40):
        v[:, 2] -= 9.81 * dt
        end, info = resolver.resolve(x, x + dt * v, dt=dt)
        v, x = (end - x) / dt, end
        assert info.converged
    assert 0.0 < x[:, 2].min() < 0.02


def test_obstacles_strands_and_particles():
    sheet, faces = grid(6, 0.4)
    strand = np.array([[-0.1, 0.0, 0.1], [0.0, 0.0, 0.1], [0.1, 0.0, 0.1]])
    grain = np.array([[0.0, 0.15, 0.1]])
    x = np.concatenate([sheet, strand, grain])
    n = len(sheet)
    resolver = Resolver(
        x,
        faces,
        edges=[[n, n + 1], [n + 1, n + 2]],
        particles=[n + 3],
        bodies=[0] * n + [1] * 3 + [2],
        obstacles=np.arange(n),
        masses=np.linspace(0.5, 2.0, len(x)),
        thickness=[0.0, 0.01, 0.02],
        delta=0.02,
    )
    assert resolver.lengths["delta"] == 0.02
    y = x - np.where(np.arange(len(x)) < n, 0.0, 1.0)[:, None] * [0.0, 0.0, 1.0]
    moved, _ = resolver.resolve(x, y)
    assert (moved[:n] == x[:n]).all()
    assert (moved[n:, 2] > 0.0).all()


def test_a_start_that_intersects_is_refused_unless_nobody_looks():
    x, faces = two_sheets(5)
    x[12, 2] = 0.2
    with pytest.raises(IntersectionError, match="intersect at the start"):
        Resolver(x, faces).resolve(x, x)
    moved, _ = Resolver(x, faces).resolve(x, x, check=False)
    assert (moved == x).all()


def test_parameters_have_the_names_of_scenes():
    x, faces = two_sheets(4)
    resolver = Resolver(x, faces, preset="quick", delta=0.01, max_steps=3, contact={"edges": False})
    assert resolver.lengths["delta"] == 0.01
    _, info = resolver.resolve(x, swapped(x))
    assert info.steps <= 3
    with pytest.raises(InputError, match="unknown parameter 'deltaa'; did you mean 'delta'"):
        Resolver(x, faces, deltaa=1.0)
    with pytest.raises(InputError, match="did you mean 'friction'"):
        Resolver(x, faces, frictoin=1.0)
    with pytest.raises(InputError, match="unknown parameter 'xyz'; known are: ") as refused:
        Resolver(x, faces, xyz=1.0)
    for name in [*inspect.signature(Resolver).parameters, "max_steps"]:
        assert name == "params" or f" {name}" in str(refused.value)
    with pytest.raises(InputError, match="delta"):
        Resolver(x, faces, delta=-1.0)
    with pytest.raises(InputError, match="sweeps"):
        Resolver(x, faces, sweeps=0)
    with pytest.raises(InputError, match="bound"):
        Resolver(x, faces, bound="spheres")


@pytest.mark.parametrize(
    ("keys", "text"),
    [
        ({"faces": [[0, 1, 99]]}, "row 0 is .0, 1, 99., but there are 32 vertices"),
        ({"faces": [[0, 1, 1]]}, "twice"),
        (
            {"faces": [[0.0, 1.0, 2.0]]},
            "expected an array of shape .m, 3. of integers, got shape .1, 3. of float64",
        ),
        ({"masses": 0.0}, "mass .* and name it in `fixed`"),
        ({"masses": [1.0, 2.0]}, r"masses: expected an array of shape \(32,\) of float64, got shape \(2,\)"),
        ({"masses": math.nan}, "mass"),
        ({"bodies": [0] * 31}, "bodies"),
        ({"bodies": [0] * 31 + [-1]}, "entry 31 is -1"),
        ({"bodies": [0] * 31 + [1]}, "two bodies|bodies"),
        ({"obstacles": [0]}, "obstacles: face 0 has vertices that are marked"),
        ({"fixed": [32]}, "row 0 is 32"),
        ({"planes": [[0.0, 0.0, 0.0, 1.0]]}, "row 0 needs a normal"),
        ({"friction": -1.0}, "friction"),
        ({"friction": [0.1, 0.2]}, "friction: expected an array of shape .1,."),
        ({"stretch_limit": 0.5}, "stretch_limit"),
        ({"groups": [-2] * 32}, "groups"),
    ],
)
def test_what_is_refused_is_named(keys, text):
    x, faces = two_sheets(4)
    with pytest.raises(InputError, match=text):
        Resolver(x, **{"faces": faces, **keys})


def test_two_threads_do_not_share_a_resolver():
    x, faces = two_sheets(40)
    resolver = Resolver(x, faces)
    results = []

    def work():
        try:
            results.append(resolver.resolve(x, swapped(x))[1].steps)
        except bowknot.BowknotError as error:
            results.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and any(isinstance(result, int) for result in results)
    assert all(isinstance(result, int) or "another thread" in result for result in results)


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_contact_forces_hold_what_lies_and_brake_what_slides(friction):
    """A sheet on the ground under gravity: its weight, Newton's third law, Coulomb's law."""
    x, faces = grid(12, size=0.3, height=0.002)
    mass, dt = 0.01, 0.01
    weight = mass * len(x) * 9.81
    resolver = Resolver(
        x, faces, planes=[[0, 0, 1, 0]], masses=mass, friction=friction, stretch_limit=np.inf, delta=0.003
    )
    velocity = np.tile([2.0, 0.0, 0.0], (len(x), 1))
    for _ in range(20):
        velocity[:, 2] -= 9.81 * dt
        y = x + dt * velocity
        new, info = resolver.resolve(x, y, dt=dt)
        before = velocity[:, 0].mean()
        velocity, x = (new - x) / dt, new
    contacts = resolver.contacts(dt)
    assert info.converged and len(contacts) > 0
    assert contacts.bodies.tolist() == [[0, 1]] * len(contacts)
    force, torque = contacts.wrench(0)
    assert force[2] == pytest.approx(weight, rel=0.03)
    # The forces are what moved the sheet away from its target.
    total = mass * (new - y).sum(axis=0) / dt**2
    np.testing.assert_allclose(force, total, atol=0.01 * weight)
    slowed = mass * len(x) * (velocity[:, 0].mean() - before) / dt
    assert force[0] == pytest.approx(-friction * weight, abs=0.03 * weight)
    assert slowed == pytest.approx(force[0], abs=0.01 * weight)
    on_ground, _ = contacts.wrench(1)
    np.testing.assert_allclose(on_ground, -force)
    lever = np.cross(contacts.points_a, contacts.forces).sum(axis=0)
    np.testing.assert_allclose(torque, lever)
    with pytest.raises(InputError, match="dt 0"):
        resolver.contacts(0.0)


def test_a_pickle_makes_the_same_resolver():
    x, faces = two_sheets(6)
    masses = np.linspace(1.0, 2.0, len(x))
    resolver = Resolver(x, faces, masses=masses, fixed=[0, 40], friction=0.3, max_steps=5)
    expected, _ = resolver.resolve(x, swapped(x))
    rest = x.copy()
    x[:] += 1.0  # what was given may change
    masses[:] = 1.0
    again = pickle.loads(pickle.dumps(resolver))
    assert again.vertex_count == resolver.vertex_count and again.lengths == resolver.lengths
    moved, _ = again.resolve(rest, swapped(rest))
    assert (moved == expected).all()


def test_a_target_that_explodes_is_told_once():
    vertices, faces = grid(4)
    resolver = bowknot.Resolver(vertices, faces, fixed=[0], stretch_limit=np.inf)
    quiet = vertices.copy()
    quiet[5] += [0.0, 0.0, 5.0]  # 15 edges away
    quiet[0] += [0.0, 0.0, 500.0]  # what is led goes wherever it is told
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _, info = resolver.resolve(vertices, quiet)
    assert info.max_target_stretch > 1000
    wild = vertices.copy()
    wild[5] += [0.0, 0.0, 100.0]
    with pytest.warns(bowknot.BowknotWarning, match="vertices .*5.* to 300 times .* most likely explodes") as told:
        new, info = resolver.resolve(vertices, wild)
    assert len(told) == 1 and told[0].filename == __file__
    # Its shortest edges are a third of a meter long.
    assert abs(info.max_target_stretch - 300) < 0.01
    assert 1.0 < info.max_stretch <= info.max_target_stretch * 1.001
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        resolver.resolve(vertices, wild)
    # An edge that is far shorter than the others tells nothing.
    short = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1e-5, 1e-5, 0]])
    resolver = bowknot.Resolver(short, [[0, 1, 3], [0, 3, 2]], stretch_limit=np.inf)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _, info = resolver.resolve(short, short + [[0, 0, 0.1], [0, 0, 0], [0, 0, 0], [0, 0, 0]])
    assert info.max_target_stretch > 1000


def test_the_wrench_of_one_body_on_another():
    vertices, faces = grid(5, 0.4)
    both = np.concatenate([vertices + [0, 0, 0.011], vertices + [0, 0, 0.023]])
    bodies = np.repeat([0, 1], len(vertices))
    resolver = bowknot.Resolver(
        both, np.concatenate([faces, faces + 25]), bodies=bodies, masses=0.01, planes=[[0, 0, 1, 0]], delta=0.01
    )
    x, dt = both, 0.01
    for _ in range(20):
        x, _ = resolver.resolve(x, x - [0, 0, 9.81 * dt**2], dt=dt)
    contacts = resolver.contacts(dt)
    weight = 25 * 0.01 * 9.81
    above, _ = contacts.wrench(1, by=0)
    below, _ = contacts.wrench(0, by=1)
    ground, _ = contacts.wrench(0, by=2)
    assert np.allclose(above, [0, 0, weight], atol=0.05 * weight) and np.allclose(above, -below)
    assert np.allclose(ground, [0, 0, 2 * weight], atol=0.05 * weight)
    whole, torque = contacts.wrench(0, [1, 0, 0])
    assert np.allclose(whole, below + ground)
    parts = [contacts.wrench(0, [1, 0, 0], by=other)[1] for other in (0, 1, 2)]
    assert np.allclose(torque, sum(parts))
