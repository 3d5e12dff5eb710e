"""The public contract of the generated modules, in NumPy and C alike."""

import importlib
import inspect
import warnings
from pathlib import Path

import numpy as np
import pytest
from contract import ROBOTS, WITHOUT_FORWARD_MAP
from given import beside
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

BACKENDS = ("numpy", "c")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)


def load(backend: str, robot: str):
    return importlib.import_module(f"closedform.generated.{backend}.{robot}")


def image(module, q) -> np.ndarray:
    """The task coordinates, of a closed loop in its first assembly mode."""
    x = module.fk(q)
    return np.take(x.p, 0, axis=np.ndim(q) - 1) if isinstance(x, tuple) else x


@pytest.fixture(params=BACKENDS)
def backend(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def arm(backend: str):
    return load(backend, "planar_2r")


@pytest.fixture
def wrist(backend: str):
    return load(backend, "spherical_wrist")


def rotation(axis: str, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array(
        {"z": [[c, -s, 0], [s, c, 0], [0, 0, 1]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}[axis]
    )


@pytest.mark.parametrize("robot", ROBOTS)
def test_both_back_ends_export_the_same(robot: str) -> None:
    numpy, c = load("numpy", robot), load("c", robot)
    assert numpy.__all__ == c.__all__
    for name in (
        "ASSEMBLY_MODES",
        "JOINTS",
        "TASK",
        "BRANCHES",
        "SINGULARITIES",
        "Parameters",
        "Status",
        "Solutions",
    ):
        assert getattr(numpy, name) == getattr(c, name)
    for name in numpy.__all__:
        if name.islower():
            # Only the compiled functions run on several cores.
            assert [*inspect.signature(getattr(numpy, name)).parameters, "threads"] == [
                *inspect.signature(getattr(c, name)).parameters
            ]


@pytest.mark.parametrize("robot", ROBOTS)
def test_names_and_shapes(robot: str, backend: str) -> None:
    module, expected = load(backend, robot), ROBOTS[robot]
    n = len(expected["joints"])
    assert module.Parameters._fields == expected["fields"]
    assert expected["joints"] == module.JOINTS
    assert expected["task"] == module.TASK
    assert len(module.BRANCHES) == expected["branches"]
    modes = expected.get("assembly_modes", 0)
    assert len(module.ASSEMBLY_MODES) == modes
    assert [s.value for s in module.Status] == [0, 1, 2, 3]
    for lead in [(), (1,), (5,), (2, 3), (0,), (3, 0, 2)]:
        q = np.random.default_rng(0).uniform(-3, 3, (*lead, n))
        for name, shape in expected["shapes"].items():
            assert np.shape(getattr(module, name)(q)) == (*lead, *shape), name
        if modes:
            p, status = module.fk(q)
            hand = expected.get("hand", (len(module.TASK),))
            assert p.shape == (*lead, modes, *hand) and status.shape == (*lead, modes)
            assert status.dtype == np.uint8
        q_all, status = module.ik(image(module, q), *beside(module, q))
        assert q_all.shape == (*lead, expected["branches"], n)
        assert status.shape == (*lead, expected["branches"])
        assert status.dtype == np.uint8
        assert len(module.singularities(q).T) == len(module.SINGULARITIES)


def test_every_module_is_in_the_contract() -> None:
    generated = importlib.import_module("closedform.generated.numpy").__path__[0]
    names = {path.stem for path in Path(generated).glob("[a-z]*.py")}
    assert names == ROBOTS.keys() | WITHOUT_FORWARD_MAP.keys()


@pytest.mark.parametrize("robot", WITHOUT_FORWARD_MAP)
def test_names_and_shapes_without_a_forward_map(robot: str, backend: str) -> None:
    module, expected = load(backend, robot), WITHOUT_FORWARD_MAP[robot]
    n = len(expected["joints"])
    assert not hasattr(module, "fk")
    assert module.Parameters._fields == expected["fields"]
    assert expected["joints"] == module.JOINTS
    assert expected["task"] == module.TASK
    assert len(module.BRANCHES) == expected["branches"]
    for lead in [(), (1,), (5,), (2, 3), (0,), (3, 0, 2)]:
        x = np.random.default_rng(0).uniform(-0.3, 0.3, (*lead, len(module.TASK)))
        q, status = module.ik(x)
        assert q.shape == (*lead, expected["branches"], n)
        assert status.shape == (*lead, expected["branches"])
        assert status.dtype == np.uint8
        for name, shape in expected["target"].items():
            assert np.shape(getattr(module, name)(x)) == (*lead, *shape), name
        for name, shape in expected["posture"].items():
            assert np.shape(getattr(module, name)(x, q[..., 0, :])) == (*lead, *shape), name
        points = module.skeleton(x, q[..., 0, :])
        assert points.shape == (*lead, len(module.SKELETON.points), 3)


@pytest.mark.parametrize("robot", WITHOUT_FORWARD_MAP)
def test_back_ends_agree_without_a_forward_map(robot: str) -> None:
    numpy, c = load("numpy", robot), load("c", robot)
    x = np.random.default_rng(1).uniform(-1, 1, (500, len(numpy.TASK)))
    a, b = numpy.ik(x), c.ik(x)
    np.testing.assert_array_equal(a.status, b.status)
    np.testing.assert_allclose(a.q, b.q, rtol=0, atol=1e-13)
    kept = a.status[:, 0] == OK
    assert kept.any()
    for name in WITHOUT_FORWARD_MAP[robot]["posture"]:
        u, v = (getattr(m, name)(x[kept], a.q[kept, 0]) for m in (numpy, c))
        np.testing.assert_allclose(u, v, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("robot", ROBOTS)
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_back_ends_agree(robot: str, data: st.DataObject) -> None:
    numpy, c = load("numpy", robot), load("c", robot)
    n = len(numpy.JOINTS)
    lead = data.draw(hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4))
    q = data.draw(hnp.arrays(float, (*lead, n), elements=st.floats(-1e3, 1e3)))
    if ROBOTS[robot].get("twins"):  # arms that are far apart have no wrist between them
        q[..., 3:5] = q[..., 1:3] + 0.1 * np.sin(q[..., 3:5])
    for name in numpy.__all__:
        if not name.islower():
            continue
        parameters = inspect.signature(getattr(numpy, name)).parameters.values()
        if [p.name for p in parameters if p.default is p.empty] == ["q"]:
            a, b = getattr(numpy, name)(q), getattr(c, name)(q)
            for u, v in zip(a, b, strict=True) if isinstance(a, tuple) else [(a, b)]:
                if (robot, name) == ("orthoglide", "jacobian"):  # not finite where sliders meet
                    u, v = (np.where(np.isfinite(e), e, np.nan) for e in (u, v))
                size = 1 + np.abs(q).max(initial=0) + np.nanmax(np.abs(u), initial=0) ** 2
                np.testing.assert_allclose(u, v, rtol=0, atol=1e-13 * size)
    x, more = image(numpy, q), beside(numpy, q)
    a, b = numpy.ik(x, *more), c.ik(x, *more)
    # At a singular posture rounding decides whether a joint is free; both answers are right.
    factors = numpy.singularities(q)
    near = np.abs(factors).min(axis=tuple(range(len(lead), factors.ndim)), initial=1) < 1e-9
    solved = [np.where(r.status == numpy.Status.SINGULAR, 0, r.status) for r in (a, b)]
    np.testing.assert_array_equal(*solved)
    np.testing.assert_array_equal(a.status[~near], b.status[~near])
    if not numpy.ASSEMBLY_MODES:
        np.testing.assert_allclose(numpy.fk(a.q), numpy.fk(b.q), rtol=0, atol=1e-12)


def test_parameters_broadcast(arm) -> None:
    q = np.random.default_rng(1).uniform(-3, 3, (4, 1, 2))
    l1, l2 = np.linspace(1, 2, 3), np.float64(0.5)
    x = arm.fk(q, arm.Parameters(l1, l2))
    assert x.shape == (4, 3, 2)
    for i in range(4):
        for j in range(3):
            np.testing.assert_allclose(x[i, j], arm.fk(q[i, 0], (l1[j], 0.5)), atol=1e-15)


def test_strided_and_large_batches(arm) -> None:
    q = np.random.default_rng(2).uniform(-3, 3, (2, 20_001)).T
    one_by_one = np.array([arm.fk(row) for row in q[::500]])
    np.testing.assert_allclose(arm.fk(q)[::500], one_by_one, atol=1e-14)
    np.testing.assert_allclose(arm.fk(q[::-3]), arm.fk(q)[::-3], atol=1e-14)
    solutions = arm.ik(arm.fk(q))
    np.testing.assert_allclose(arm.fk(solutions.q), np.repeat(arm.fk(q)[:, None], 2, 1), atol=1e-13)


def test_out_is_filled_and_returned(arm) -> None:
    q = np.random.default_rng(3).uniform(-3, 3, (7, 2))
    x = np.empty((7, 2))
    assert arm.fk(q, out=x) is x
    np.testing.assert_array_equal(x, arm.fk(q))
    out = (np.empty((7, 2, 2)), np.empty((7, 2), np.uint8))
    solutions = arm.ik(x, out=out)
    assert solutions.q is out[0] and solutions.status is out[1]


@pytest.mark.parametrize("n", [7, 20_001])
def test_out_may_overlap_what_is_read(arm, n: int) -> None:
    q = np.random.default_rng(3).uniform(1, 3, (n + 1, 2))
    alias = q.copy()
    np.testing.assert_array_equal(arm.fk(alias, out=alias), arm.fk(q))
    alias = q.copy()
    np.testing.assert_array_equal(arm.fk(alias[:-1], out=alias[1:]), arm.fk(q[:-1]))
    alias = q.copy()  # the lengths of the first link, one posture behind the results
    expected = arm.fk([0.3, 0.4], (q[:-1, 1], 1.0))
    np.testing.assert_array_equal(arm.fk([0.3, 0.4], (alias[:-1, 1], 1.0), out=alias[1:]), expected)


def test_wrong_shapes_say_what_is_expected(arm, wrist) -> None:
    with pytest.raises(ValueError, match=r"q has shape \(3,\), expected \(\.\.\., 2\)"):
        arm.fk([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"expected \(\.\.\., 3, 3\)"):
        wrist.ik(np.eye(4))
    with pytest.raises(ValueError, match="do not broadcast"):
        arm.fk(np.zeros((3, 2)), (np.ones(4), 1.0))
    with pytest.raises(ValueError, match="params"):
        arm.fk(np.zeros(2), (1.0,))
    with pytest.raises(ValueError, match=r"out for x has shape \(2, 2\), expected \(3, 2\)"):
        arm.fk(np.zeros((3, 2)), out=np.empty((2, 2)))
    with pytest.raises(ValueError, match="out for x has dtype float32, expected float64"):
        arm.fk(np.zeros((3, 2)), out=np.empty((3, 2), np.float32))
    with pytest.raises(TypeError, match="out for x must be an array, not list"):
        arm.fk(np.zeros(2), out=[0.0, 0.0])
    with pytest.raises(TypeError, match="out must be a tuple of 2 arrays"):
        arm.ik(np.zeros(2), out=np.empty((2, 2)))


def test_nothing_warns(arm, wrist) -> None:
    with warnings.catch_warnings(), np.errstate(all="raise"):
        warnings.simplefilter("error")
        for bad in (np.nan, np.inf, -np.inf, 1e308):
            arm.fk([bad, 0.0])
            assert (arm.ik([bad, 0.0]).status >= UNREACHABLE).all()
            assert (wrist.ik(np.full((3, 3), bad)).status == INVALID).all()
            wrist.fk([bad, bad, bad])


def test_arm_example_of_the_paper(arm) -> None:
    x = arm.fk(np.deg2rad([30, 30]))
    np.testing.assert_allclose(x, [12.660254037844387, 11.928203230275509], rtol=1e-15)
    q = np.rad2deg(arm.ik(x).q)
    np.testing.assert_allclose(q[0], [30, 30], atol=1e-12)
    assert arm.BRANCHES == ("elbow_down", "elbow_up")
    np.testing.assert_allclose(q[1, 1], -30, atol=1e-12)


@pytest.mark.parametrize("reach", [18.0, 2.0])
def test_arm_on_the_boundary(arm, reach: float) -> None:
    angle = np.linspace(-3, 3, 1001)
    x = reach * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    solutions = arm.ik(x)
    assert (solutions.status == OK).all()
    assert np.abs(arm.fk(solutions.q) - x[:, None]).max() < 18 * 1e-12
    outward = 1 + 1e-9 if reach == 18 else 1 - 1e-9
    assert (arm.ik(x * outward).status == UNREACHABLE).all()
    assert np.isnan(arm.ik(x * outward).q).all()


def test_arm_tolerance_of_the_boundary(arm) -> None:
    assert (arm.ik([18 * (1 + 0.5e-12), 0]).status == OK).all()
    assert (arm.ik([18 * (1 + 2e-12), 0]).status == UNREACHABLE).all()


def test_arm_folded_on_its_base(arm) -> None:
    solutions = arm.ik([0.0, 0.0], (3.0, 3.0))
    assert (solutions.status == SINGULAR).all()
    np.testing.assert_array_equal(solutions.q[:, 0], 0.0)
    np.testing.assert_allclose(arm.fk(solutions.q, (3.0, 3.0)), 0, atol=1e-15)
    assert (arm.ik(arm.fk([1.0, np.pi], (3.0, 3.0)), (3.0, 3.0)).status == SINGULAR).all()
    assert (arm.ik([0.0, 0.0]).status == UNREACHABLE).all()


def test_arm_with_impossible_links(arm) -> None:
    for params in [(-1.0, 2.0), (1.0, -2.0), (np.nan, 1.0), (1.0, np.inf)]:
        assert (arm.ik([1.0, 0.0], params).status == INVALID).all()
    solutions = arm.ik([0.0, 2.0], (2.0, 0.0))
    assert (solutions.status == SINGULAR).all()
    np.testing.assert_allclose(arm.fk(solutions.q, (2.0, 0.0)), [[0, 2]] * 2, atol=1e-15)


def test_arm_full_pose(arm) -> None:
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (50, 2))
    solutions = arm.ik_pose(arm.pose(q))
    assert solutions.q.shape == (50, 1, 2) and (solutions.status == OK).all()
    np.testing.assert_allclose(solutions.q[:, 0], q, atol=1e-13)
    T = arm.pose([0.3, 0.4])
    for i, j in [(0, 3), (2, 3)]:
        moved = T.copy()
        moved[i, j] += 0.1
        assert (arm.ik_pose(moved).status == UNREACHABLE).all()
    mirrored = T @ np.diag([1.0, 1.0, -1.0, 1.0])
    assert (arm.ik_pose(mirrored).status == INVALID).all()


@pytest.mark.parametrize("small", [0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("corner", [0.0, np.pi])
def test_wrist_near_its_singularity(wrist, small: float, corner: float) -> None:
    first, last = np.random.default_rng(5).uniform(-np.pi, np.pi, (2, 200))
    q = np.stack([first, np.full(200, corner - np.copysign(small, corner - 1)), last], axis=-1)
    R = wrist.fk(q)
    solutions = wrist.ik(R)
    assert np.isin(solutions.status, (OK, SINGULAR)).all()
    assert np.abs(wrist.fk(solutions.q) - R[:, None]).max() < 1e-14
    if small in (0.0, 1e-16):
        assert (solutions.status == SINGULAR).all()
        np.testing.assert_array_equal(solutions.q[..., 0], 0)
    if small >= 1e-12:
        assert (solutions.status == OK).all()
        middle = np.abs(solutions.q[..., 1])
        atol = 1e-25 if corner == 0.0 else 1e-15
        np.testing.assert_allclose(middle, np.abs(q[:, 1:2]).repeat(2, 1), rtol=1e-15, atol=atol)


def test_wrist_from_noisy_matrices(wrist) -> None:
    """A rotation with rounding errors near theta5 = 0 still comes back to rounding."""
    rng = np.random.default_rng(6)
    for small in 10.0 ** np.arange(-17, 0):
        a, b, c = rng.uniform(-3, 3, 3)
        R = rotation("z", a) @ rotation("y", small) @ rotation("z", b) @ rotation("z", c)
        R = R + rng.uniform(-1, 1, (3, 3)) * 2e-16
        solutions = wrist.ik(R)
        assert np.abs(wrist.fk(solutions.q) - R).max() < 5e-15


def test_wrist_rejects_what_is_no_rotation(wrist) -> None:
    R = wrist.fk([0.1, 0.2, 0.3])
    for bad in (
        R @ np.diag([1, 1, -1]),
        -R,
        1.001 * R,
        R + 1e-3,
        np.zeros((3, 3)),
        np.ones((3, 3)),
    ):
        solutions = wrist.ik(bad)
        assert (solutions.status == INVALID).all() and np.isnan(solutions.q).all()


@pytest.mark.parametrize("d6", [np.nan, np.inf])
def test_wrist_rejects_an_offset_that_is_none(wrist, d6: float) -> None:
    """The inverse does not need the offset, but such a wrist does not exist."""
    solutions = wrist.ik(wrist.fk([0.1, 0.2, 0.3]), wrist.Parameters(d6))
    assert (solutions.status == INVALID).all() and np.isnan(solutions.q).all()


def test_wrist_accepts_single_precision(wrist) -> None:
    R = wrist.fk([0.1, 0.2, 0.3]).astype(np.float32)
    assert (wrist.ik(R).status == OK).all()


@pytest.mark.parametrize("robot", ROBOTS)
def test_angles_lie_in_the_half_open_interval(robot: str, backend: str) -> None:
    module = load(backend, robot)
    corners = np.array([-np.pi, -np.pi / 2, 0.0, np.pi / 2, np.pi])
    q = np.stack(np.meshgrid(*[corners] * len(module.JOINTS), indexing="ij"), axis=-1)
    for noise in (0.0, 1e-16, 1e-9):
        angles = [name.startswith("theta") for name in module.JOINTS]
        at = q + noise
        found = module.ik(image(module, at), *beside(module, at)).q[..., angles]
        found = found[np.isfinite(found)]
        assert (found > -np.pi).all() and (found <= np.pi).all()


@pytest.mark.parametrize("robot", ["planar_2r", "spherical_wrist"])
def test_jacobians_by_complex_free_differences(robot: str, backend: str) -> None:
    """Central differences of the pose against the symbolic Jacobians."""
    module = load(backend, robot)
    n, h = len(module.JOINTS), 1e-6
    q = np.random.default_rng(7).uniform(-3, 3, (20, n))
    steps = h * np.eye(n)
    rates = [(module.fk(q + s) - module.fk(q - s)) / (2 * h) for s in steps]
    if robot == "planar_2r":
        J = module.jacobian(q)
        np.testing.assert_allclose(J[:, :2], np.stack(rates, axis=-1), atol=1e-8)
        np.testing.assert_array_equal(J[:, 2], 1)
        np.testing.assert_allclose(module.determinant(q), np.linalg.det(J[:, :2]), atol=1e-12)
        np.testing.assert_allclose(module.manipulability(q), np.abs(module.determinant(q)))
        return
    R = module.fk(q)
    for name, product in (
        ("jacobian_space", lambda dR: dR @ R.swapaxes(-1, -2)),
        ("jacobian_body", lambda dR: R.swapaxes(-1, -2) @ dR),
    ):
        W = [product(dR) for dR in rates]
        columns = [np.stack([w[:, 2, 1], w[:, 0, 2], w[:, 1, 0]], axis=-1) for w in W]
        J = getattr(module, name)(q)
        np.testing.assert_allclose(J, np.stack(columns, axis=-1), atol=1e-8)
        np.testing.assert_allclose(module.determinant(q), np.linalg.det(J), atol=1e-14)
