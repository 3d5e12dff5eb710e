"""SCARA, UR-type arm and two RPR legs, checked with numbers instead of the derivations."""

import importlib
import itertools
from functools import cache

import arms
import numpy as np
import pytest
import sympy as sp

from closedform.lower.program import lower
from closedform.mechanics.arm import from_dh
from closedform.model.derivation import Derivation, Paper

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
BACKENDS = ("numpy", "c")
UR = {"d1": 0.089159, "a2": -0.425, "a3": -0.39225, "d4": 0.10915, "d5": 0.09465, "d6": 0.0823}


@pytest.fixture(params=BACKENDS)
def backend(request: pytest.FixtureRequest) -> str:
    return request.param


def load(backend: str, robot: str):
    return importlib.import_module(f"closedform.generated.{backend}.{robot}")


def screw(w, point, angle: np.ndarray) -> np.ndarray:
    """The rotation about an axis through a point, by Rodrigues' formula."""
    x, y, z = w
    W = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    T = np.zeros((*np.shape(angle), 4, 4))
    T[..., :3, :3] = np.eye(3) + s * W + (1 - c) * (W @ W)
    T[..., :3, 3] = (np.eye(3) - T[..., :3, :3]) @ point
    T[..., 3, 3] = 1
    return T


def ur_by_screws(q) -> np.ndarray:
    """The axes and the tool of the UR5 at home, where it is stretched along -x."""
    d1, a2, a3, d4, d5, d6 = UR.values()
    across = (0, -1, 0)
    axes = [
        ((0, 0, 1), (0, 0, 0)),
        (across, (0, 0, d1)),
        (across, (a2, 0, d1)),
        (across, (a2 + a3, 0, d1)),
        ((0, 0, -1), (a2 + a3, -d4, d1)),
        (across, (a2 + a3, 0, d1 - d5)),
    ]
    T = np.eye(4)
    for (w, p), angle in zip(axes, np.moveaxis(np.asarray(q), -1, 0), strict=True):
        T = T @ screw(w, np.array(p), angle)
    home = np.array([[1, 0, 0, a2 + a3], [0, 0, -1, -d4 - d6], [0, 1, 0, d1 - d5], [0, 0, 0, 1]])
    return T @ home


def differences(fk, q, h: float = 1e-6):
    return [(fk(q + h * e) - fk(q - h * e)) / (2 * h) for e in np.eye(len(q))]


@cache
def found_by_newton() -> list[tuple[np.ndarray, np.ndarray]]:
    """Targets, and postures that numbers alone find from random starts, with one known before."""
    rng, found = np.random.default_rng(1), []
    for q in rng.uniform(-np.pi, np.pi, (3, 6)):
        target = ur_by_screws(q)
        starts = rng.uniform(-np.pi, np.pi, (40, 6))
        found.append((target, np.array([q, *arms.newton(ur_by_screws, target, starts)])))
    return found


def test_ur_pose_is_the_product_of_exponentials(backend: str) -> None:
    ur = load(backend, "ur_arm")
    for q in np.random.default_rng(0).uniform(-4, 4, (20, 6)):
        np.testing.assert_allclose(ur.fk(q), ur_by_screws(q), atol=1e-14)


def test_ur_newton_finds_no_posture_that_is_not_a_branch(backend: str) -> None:
    ur, most = load(backend, "ur_arm"), 0
    for target, others in found_by_newton():
        assert len(others) > 10
        q_all, status = ur.ik(target)
        ours = q_all[status == OK]
        for other in others:
            gaps = np.abs(np.angle(np.exp(1j * (ours - other)))).max(axis=-1)
            assert gaps.min() < 1e-6
        for mine in ours:
            np.testing.assert_allclose(ur_by_screws(mine), target, atol=1e-13)
        gaps = np.abs(np.angle(np.exp(1j * (ours[:, None] - ours)))).max(axis=-1)
        assert (gaps[~np.eye(len(ours), dtype=bool)] > 1e-6).all()
        most = max(most, len(ours))
    assert most == 8


@pytest.mark.parametrize("small", [0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-6])
def test_ur_loses_no_pose_near_its_singular_sets(backend: str, small: float) -> None:
    """Each joint, and elbow and wrist together, at the right angles."""
    ur, rng = load(backend, "ur_arm"), np.random.default_rng(2)
    size = sum(map(abs, UR.values()))
    corners = [0.0, np.pi / 2, np.pi]
    cases = [((j,), (c,)) for j in range(6) for c in corners]
    cases += [((2, 4), pair) for pair in itertools.product(corners, corners)]
    for joints, values in cases:
        q = rng.uniform(-np.pi, np.pi, (300, 6))
        q[:, joints] = np.array(values) + small
        T = ur.fk(q)
        q_all, status = ur.ik(T)
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all(), (joints, values)
        assert np.nanmax(np.abs(ur.fk(q_all) - T[:, None])) < 1e-12 * size
        if joints == (4,) and small == 0.0 and values[0] != np.pi / 2:
            assert (status == SINGULAR).any(axis=-1).mean() > 0.95


def test_ur_at_the_shoulder_singularity(backend: str) -> None:
    """The wrist is as near to the first axis as d4 allows: both shoulders meet."""
    ur, rng = load(backend, "ur_arm"), np.random.default_rng(3)
    _, a2, a3, _, d5, _ = UR.values()
    q = rng.uniform(-np.pi, np.pi, (2000, 6))
    s = (a2 * np.cos(q[:, 1]) + a3 * np.cos(q[:, 1] + q[:, 2])) / -d5
    q = q[np.abs(s) < 1]
    q[:, 3] = np.arcsin(s[np.abs(s) < 1]) - q[:, 1] - q[:, 2]
    np.testing.assert_allclose(ur.singularities(q)[:, 0], 0, atol=1e-15)
    T = ur.fk(q)
    q_all, status = ur.ik(T)
    assert (status == OK).any(axis=-1).all()
    assert np.nanmax(np.abs(ur.fk(q_all) - T[:, None])) < 1e-12
    nearer = np.eye(4)
    nearer[:3, 3] = [0.05, 0.0, 0.4]
    assert (ur.ik(nearer).status == UNREACHABLE).all()


def test_ur_with_nothing_beside_the_shoulder(backend: str) -> None:
    """With d4 = 0 the first joint is free if the wrist is on its axis."""
    ur = load(backend, "ur_arm")
    params = ur.Parameters()._replace(d4=0.0)
    T = np.eye(4)
    T[:3, 3] = [0.0, 0.0, 0.5]
    q_all, status = ur.ik(T, params)
    assert (status == SINGULAR).any()
    got = status == SINGULAR
    np.testing.assert_array_equal(q_all[got][:, 0], 0)
    np.testing.assert_allclose(
        ur.fk(q_all[got], params), np.broadcast_to(T, (got.sum(), 4, 4)), atol=1e-14
    )


def test_ur_refuses_what_is_no_pose(backend: str) -> None:
    ur = load(backend, "ur_arm")
    T = ur.fk(np.zeros(6) + 0.3)
    for bad in (T @ np.diag([1.0, 1, -1, 1]), 2 * T, np.full((4, 4), np.nan), np.zeros((4, 4))):
        q_all, status = ur.ik(bad)
        assert (status == INVALID).all() and np.isnan(q_all).all()
    assert (ur.ik(T, ur.Parameters()._replace(L2=-1.0)).status == INVALID).all()
    far = T.copy()
    far[:3, 3] *= 10
    assert (ur.ik(far).status == UNREACHABLE).all()


@pytest.mark.parametrize("robot", ["ur_arm", "scara"])
def test_jacobians_by_differences(robot: str, backend: str) -> None:
    module = load(backend, robot)
    rng = np.random.default_rng(4)
    for q in rng.uniform(-2, 2, (5, len(module.JOINTS))):
        T = module.pose(q)
        rates = differences(module.pose, q)
        inverse = np.linalg.inv(T)
        for name, twists in (
            ("jacobian_space", [dT @ inverse for dT in rates]),
            ("jacobian_body", [inverse @ dT for dT in rates]),
        ):
            V = [[*t[:3, 3], t[2, 1], t[0, 2], t[1, 0]] for t in twists]
            np.testing.assert_allclose(getattr(module, name)(q), np.transpose(V), atol=1e-8)
        J = module.jacobian(q)
        np.testing.assert_allclose(module.determinant(q), np.linalg.det(J), atol=1e-14)
        if robot == "ur_arm":
            np.testing.assert_allclose(J[:3], np.transpose([dT[:3, 3] for dT in rates]), atol=1e-8)
            np.testing.assert_allclose(J[3:], module.jacobian_space(q)[3:], atol=1e-15)
        else:
            np.testing.assert_allclose(J, np.transpose(differences(module.fk, q)), atol=1e-8)


@pytest.mark.parametrize("robot", ["ur_arm", "scara"])
def test_the_factors_vanish_with_the_determinant(robot: str, backend: str) -> None:
    module = load(backend, robot)
    q = np.random.default_rng(5).uniform(-3, 3, (50, len(module.JOINTS)))
    product = np.prod(module.singularities(q), axis=-1)
    ratio = module.determinant(q) / product
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)


def test_scara_by_plane_geometry(backend: str) -> None:
    scara = load(backend, "scara")
    l1, l2, h = scara.Parameters()
    rng = np.random.default_rng(6)
    q = rng.uniform(-3, 3, (200, 4))
    tip = l1 * np.exp(1j * q[:, 0]) + l2 * np.exp(1j * (q[:, 0] + q[:, 1]))
    yaw = np.angle(np.exp(1j * (q[:, 0] + q[:, 1] - q[:, 3])))
    x = scara.fk(q)
    np.testing.assert_allclose(x, np.stack([tip.real, tip.imag, h - q[:, 2], yaw], -1), atol=1e-14)
    q_all, status = scara.ik(x)
    assert (status == OK).all()
    gaps = np.abs(q_all - q[:, None])
    gaps[..., [0, 1, 3]] = np.abs(np.angle(np.exp(1j * gaps[..., [0, 1, 3]])))
    assert gaps.max(-1).min(-1).max() < 1e-12
    assert (q_all[:, 0, 1] >= 0).all() and (q_all[:, 1, 1] <= 0).all()
    assert np.abs(q_all[..., 2] - q[:, None, 2]).max() < 1e-15  # a slide is no angle: not wrapped


def test_scara_slides_far(backend: str) -> None:
    scara = load(backend, "scara")
    q_all, status = scara.ik([0.3, 0.1, -20.0, 0.4])
    assert (status == OK).all()
    np.testing.assert_allclose(q_all[:, 2], 20.35)


def test_scara_at_its_limits(backend: str) -> None:
    scara = load(backend, "scara")
    l1, l2, h = scara.Parameters()
    for reach in (l1 + l2, l1 - l2):
        angle = np.linspace(-3, 3, 101)
        x = np.stack([reach * np.cos(angle), reach * np.sin(angle), 0 * angle, angle], -1)
        q_all, status = scara.ik(x)
        assert (status == OK).all()
        assert np.abs(scara.fk(q_all) - x[:, None]).max() < 1e-12 * (l1 + l2)
        x[:, :2] *= 1 + 1e-9 if reach > l1 else 1 - 1e-9
        assert (scara.ik(x).status == UNREACHABLE).all()
    equal = (0.3, 0.3, h)
    q_all, status = scara.ik([0.0, 0.0, 0.1, 0.7], equal)
    assert (status == SINGULAR).all() and (q_all[:, 0] == 0).all()
    np.testing.assert_allclose(scara.fk(q_all, equal), [[0, 0, 0.1, 0.7]] * 2, atol=1e-15)


def test_rpr_against_the_loop(backend: str) -> None:
    rpr, rng = load(backend, "rpr_planar"), np.random.default_rng(7)
    p = rng.uniform(-3, 3, (300, 2))
    q, status = rpr.ik(p)
    sine = np.abs(p[:, 1]) / (np.hypot(*p.T) * np.hypot(p[:, 0] - 1, p[:, 1]))
    np.testing.assert_array_equal(status[:, 0], np.where(sine > 2.0**-10, OK, SINGULAR))
    assert (q >= 0).all()
    np.testing.assert_allclose(q[:, 0, 0], np.hypot(*p.T), rtol=1e-15)
    np.testing.assert_allclose(q[:, 0, 1], np.hypot(p[:, 0] - 1, p[:, 1]), rtol=1e-15)
    back, status = rpr.fk(q[:, 0])
    assert (status == OK).all()
    side = (p[:, 1] < 0).astype(int)
    np.testing.assert_allclose(back[np.arange(300), side], p, atol=1e-12 / np.abs(p[:, 1]).min())
    for mode in (0, 1):  # each leg, turned by its passive angle, leads to P
        turn = rpr.passive_angles(q[:, 0])[:, mode]
        for leg, base in ((0, 0.0), (1, 1.0)):
            at = base + q[:, 0, leg] * np.exp(1j * turn[:, leg])
            np.testing.assert_allclose(np.stack([at.real, at.imag], -1), back[:, mode], atol=1e-12)


def test_rpr_limits_and_rates(backend: str) -> None:
    rpr = load(backend, "rpr_planar")
    assert (rpr.fk([0.4, 0.6]).status == OK).all()
    np.testing.assert_allclose(rpr.fk([0.4, 0.6]).p, [[0.4, 0]] * 2, atol=1e-15)
    for bad in ([0.4, 0.5], [3.0, 1.0], [-0.4, 1.2], [-1.0, -1.0]):
        assert (rpr.fk(bad).status == UNREACHABLE).all()
    p, status = rpr.fk([2.0, 2.0], (0.0,))
    assert (status == SINGULAR).all()
    np.testing.assert_allclose(p, [[2, 0], [2, 0]])
    q, h = np.array([0.9, 0.7]), 1e-6
    rates = [(rpr.fk(q + h * e).p - rpr.fk(q - h * e).p) / (2 * h) for e in np.eye(2)]
    J = rpr.jacobian(q)
    np.testing.assert_allclose(J, np.stack(rates, -1), atol=1e-8)
    np.testing.assert_allclose(rpr.determinant(q), np.linalg.det(J), rtol=1e-12)


@pytest.mark.parametrize("robot", ["ur_arm", "scara", "rpr_planar"])
def test_empty_and_strided_batches(robot: str, backend: str) -> None:
    module = load(backend, robot)
    n = len(module.JOINTS)
    forward = (lambda q: module.fk(q).p[..., 0, :]) if module.ASSEMBLY_MODES else module.fk
    q = np.random.default_rng(8).uniform(0.6, 1.2, (n, 40)).T
    x = forward(q)
    np.testing.assert_allclose(forward(q[::-3]), x[::-3], atol=1e-15)
    np.testing.assert_array_equal(module.ik(x[::2]).status, module.ik(x).status[::2])
    assert module.ik(x[:0]).q.shape == (0, len(module.BRANCHES) or 1, n)


def test_operation_counts_of_a_chain() -> None:
    """Entries are named link by link; written out, the spatial Jacobian alone takes 122."""
    d = importlib.import_module("closedform.derivations.ur_arm").d
    most = {"fk": 78, "pose": 78, "jacobian": 65, "jacobian_space": 86, "jacobian_body": 85}
    for name, limit in most.items():
        operations = lower(d[name], d).operations()
        assert set(operations) <= {"add", "sub", "mul", "sincos"} and operations["sincos"] <= 6
        assert sum(n for kind, n in operations.items() if kind != "sincos") <= limit, name


def test_names_of_the_chain_leave_those_of_parameters_alone() -> None:
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    a, b = (d.parameter(n, value=1, unit="m", meaning=n) for n in ("T1_14", "p1_11"))
    theta1, theta2, theta3 = (d.joint(f"theta{i}") for i in (1, 2, 3))
    rows = [(0, sp.pi / 2, 0, theta1), (a, sp.pi / 2, 0, theta2), (b, 0, 0, theta3)]
    from_dh(d, rows).export(d)
    (pose,) = d["pose"].outputs
    value = d["pose"].explicit([pose.entries[3]], {})[0][0].subs({theta2: 0, theta3: 0})
    assert sp.simplify(value - (a + b) * sp.cos(theta1)) == 0
