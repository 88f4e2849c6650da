"""Arrays of every shape, type, order and layout: taken as they are, or refused with a message."""

import numpy as np
import pytest
from conftest import two_sheets

import bowknot
from bowknot import ArrayTypeError, InputError, Resolver

pytestmark = pytest.mark.filterwarnings("ignore:the matrix subclass")


@pytest.fixture(scope="module")
def problem():
    x, faces = two_sheets(5)
    y = x[::-1].copy()
    resolver = Resolver(x, faces)
    expected, _ = resolver.resolve(x, y)
    return x, y, faces, resolver, expected


def layouts(a):
    """The same numbers in other layouts."""
    yield "list", a.tolist()
    yield "tuple", tuple(map(tuple, a.tolist()))
    yield "fortran", np.asfortranarray(a)
    wide = np.zeros((len(a), 2 * a.shape[1]), a.dtype)
    wide[:, ::2] = a
    yield "strided", wide[:, ::2]
    yield "backward", a[::-1].copy()[::-1]
    yield "negative strides", np.ascontiguousarray(a[::-1, ::-1])[::-1, ::-1]
    frozen = a.copy()
    frozen.flags.writeable = False
    yield "read-only", frozen
    bytes_ = np.zeros(a.nbytes + 1, np.uint8)
    unaligned = bytes_[1:].view(a.dtype).reshape(a.shape)
    unaligned[...] = a
    yield "unaligned", unaligned
    yield "big-endian", a.astype(a.dtype.newbyteorder(">"))
    yield "matrix", np.asmatrix(a)
    yield "masked", np.ma.masked_array(a)


def test_every_layout_gives_the_same_bits(problem):
    x, y, faces, resolver, expected = problem
    for name, given in layouts(x):
        assert (resolver.resolve(given, y)[0] == expected).all(), name
        assert (Resolver(given, faces).resolve(x, y)[0] == expected).all(), name
    for name, given in layouts(y):
        assert (resolver.resolve(x, given)[0] == expected).all(), name
    for dtype in (np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16, np.uint32, np.uint64):
        for name, given in layouts(faces.astype(dtype)):
            assert (Resolver(x, given).resolve(x, y)[0] == expected).all(), (dtype, name)


def test_smaller_types_are_taken_and_others_refused(problem):
    x, y, faces, resolver, _ = problem
    rounded = x.astype(np.float32)
    moved, _ = resolver.resolve(rounded, y, check=True)
    assert moved.dtype == np.float64
    for dtype in (np.complex128, bool, "U3", "datetime64[s]", object, np.longdouble, "S4"):
        with pytest.raises(InputError, match="x: expected an array of shape"):
            resolver.resolve(np.zeros(x.shape, dtype), y)
    with pytest.raises(ArrayTypeError):
        resolver.resolve(np.zeros(x.shape, np.complex64), y)
    for dtype in (float, np.float32, complex, bool, object, "U3"):
        with pytest.raises(InputError, match="faces: expected"):
            Resolver(x, np.zeros(faces.shape, dtype))


BAD = [
    None,
    1,
    1.0,
    "abc",
    b"abc",
    [],
    {},
    object(),
    np.float64(1.0),
    np.zeros(0),
    np.zeros(3),
    np.zeros((0, 3)),
    np.zeros((3, 0)),
    np.zeros((1, 2)),
    np.zeros((7, 3)),
    np.zeros((50, 4)),
    np.zeros((50, 3, 1)),
    [[1.0, 2.0], [3.0]],
    [[None] * 3] * 50,
    np.full((50, 3), np.nan),
    np.full((50, 3), np.inf),
    np.full((50, 3), 1e300),
    np.full((50, 3), -1e70),
    np.zeros((50, 3), [("a", float)]),
    range(150),
    lambda: 1,
    np.broadcast_to(np.zeros(3), (51, 3)),
    [[2**70] * 3] * 50,
]


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: type(bad).__name__)
def test_bad_arrays_are_errors_wherever_they_stand(problem, bad):
    x, y, faces, resolver, _ = problem
    calls = [
        lambda: resolver.resolve(bad, y),
        lambda: resolver.resolve(x, bad),
        lambda: resolver.resolve(x, y, start=bad) if bad is not None else resolver.resolve(bad, y),
        lambda: Resolver(bad, faces),
        lambda: bowknot.check(bad, faces),
        lambda: bowknot.search(bad, faces, 0.1),
        lambda: bowknot.check_path(x, bad, faces),
        lambda: bowknot.repair(bad, faces),
    ]
    for call in calls:
        try:
            call()
        except InputError:
            pass


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: type(bad).__name__)
def test_bad_arrays_in_lesser_places_are_errors_or_taken(problem, bad):
    x, y, faces, _, _ = problem
    for name in (
        "edges",
        "particles",
        "masses",
        "fixed",
        "bodies",
        "obstacles",
        "planes",
        "groups",
        "friction",
        "thickness",
        "delta",
        "stretch_limit",
        "plane_friction",
    ):
        try:
            Resolver(x, faces, **{name: bad}).resolve(x, y)
        except InputError as error:
            assert str(error), name


def test_out_must_be_able_to_hold_the_result(problem):
    x, y, _, resolver, expected = problem
    frozen = np.zeros_like(x)
    frozen.flags.writeable = False
    for out in (np.zeros((1, 3)), x.astype(np.float32), x.tolist(), frozen, np.zeros((50, 3), ">f8")):
        with pytest.raises(InputError, match="out: expected a writable ndarray"):
            resolver.resolve(x, y, out=out)
    for name, out in layouts(np.zeros_like(x)):
        if isinstance(out, np.ndarray) and out.dtype == np.float64 and out.flags.writeable:
            resolver.resolve(x, y, out=out)
            assert (np.asarray(out) == expected).all(), name


def test_random_arguments_never_panic():
    random = np.random.default_rng(7)
    dtypes = [np.float64, np.float32, np.int64, np.int8, np.uint32, np.bool_, np.complex128, object]
    special = np.array([0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, np.inf, -np.inf, np.nan, 1e16, 5e-324])

    def draw():
        shape = tuple(random.integers(0, 6, random.integers(0, 4)))
        dtype = dtypes[random.integers(len(dtypes))]
        values = special[random.integers(len(special), size=shape)]
        with np.errstate(all="ignore"):
            return np.asarray(values).astype(dtype)

    for _ in range(400):
        arguments = [draw() for _ in range(3)]
        faces = random.integers(-1, 6, (random.integers(0, 4), 3))
        points = special[random.integers(len(special), size=(6, 3))]
        for call in (
            lambda: Resolver(*arguments),
            lambda: Resolver(points, faces, delta=0.1).resolve(points, points[::-1]),
            lambda: bowknot.check(points, faces),
            lambda: bowknot.check_path(points, points[::-1], faces),
            lambda: bowknot.search(points, faces, 1.0),
            lambda: bowknot.repair(points, faces),
            lambda: bowknot.Simulator(bowknot.Scene(bodies=[{"mesh": points, "faces": faces}])),
            lambda: bowknot.Simulator(bowknot.Scene(bodies=[{"mesh": arguments[0], "tets": arguments[1]}])),
        ):
            try:
                call()
            except InputError:
                pass
