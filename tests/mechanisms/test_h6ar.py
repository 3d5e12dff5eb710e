"""The H6AR against other routes: printed equations, Newton on the open loop, finite differences."""

import importlib
import itertools
import warnings

import numpy as np
import pytest

MODELS = ("h6ar", "h6ar_loop_closed")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
BRANCHES = {"h6ar": 4, "h6ar_loop_closed": 8}
TOL = 1e-12 * 1.44  # the sum of the link lengths


@pytest.fixture(params=("numpy", "c"))
def backend(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(params=MODELS)
def model(request: pytest.FixtureRequest, backend: str):
    return importlib.import_module(f"closedform.generated.{backend}.{request.param}")


@pytest.fixture
def published(backend: str):
    return importlib.import_module(f"closedform.generated.{backend}.h6ar")


@pytest.fixture
def closed(backend: str):
    return importlib.import_module(f"closedform.generated.{backend}.h6ar_loop_closed")


P = importlib.import_module("closedform.generated.numpy.h6ar").Parameters()
STRAIGHT = np.arctan2(P.L2, P.a3)


def postures(n: int, seed: int = 0, spread: float = 0.08) -> np.ndarray:
    """Twin arms close to each other, bent to either side."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1.2, 1.2, (n, 6))
    q[:, 0], q[:, 5] = rng.uniform(-3, 3, (2, n))
    q[:, 2] = STRAIGHT + rng.choice((-1, 1), n) * rng.uniform(0.3, 2, n)
    q[:, 3:5] = q[:, 1:3] + rng.uniform(-spread, spread, (n, 2))
    return q


def rotation(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = c
    R[i, j], R[j, i] = -s, s
    return R


def frame3(theta1: float, theta2: float, theta3: float, d: float) -> np.ndarray:
    """Fig. 2 by Denavit-Hartenberg, in numbers."""
    T = np.eye(4)
    rows = ((theta1, P.d1, 0, np.pi / 2), (theta2, d, P.L1, 0), (theta3, 0, P.a3, np.pi / 2))
    for theta, along, a, alpha in rows:
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        A = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, along]]
        T = T @ np.array([*A, [0, 0, 0, 1]])
    return T


def forearm_tip(theta1: float, theta2: float, theta3: float, d: float) -> np.ndarray:
    return (frame3(theta1, theta2, theta3, d) @ [0, 0, P.L2, 1])[:3]


def hand(T3: np.ndarray, psi: float, phi: float, theta: float, wrist: float) -> np.ndarray:
    """The pose of the tip on a fore-arm whose frame is T3."""
    R = T3[:3, :3] @ rotation(2, phi) @ rotation(0, psi)
    T = np.eye(4)
    T[:3, :3] = R @ rotation(1, theta)
    joint = T3[:3, 3] + P.L2 * T3[:3, 2] + (wrist + P.loff) * R[:, 2]
    T[:3, 3] = joint + P.lp * T[:3, 2]
    return T


def missed(model, solutions: np.ndarray, x: np.ndarray, params=P) -> np.ndarray:
    """How far the branches of an inverse miss their targets, angles on the shorter arc."""
    off = model.fk(solutions, params) - x[:, None]
    off[..., 3:] = np.angle(np.exp(1j * off[..., 3:]))
    return off


def test_names(model) -> None:
    assert model.Parameters._fields == ("L1", "L2", "a3", "d1", "d", "gs", "al", "loff", "lp")
    assert tuple(P) == (0.4, 0.4, 0.05, 0.5, 0.1, 0.02, 0.12, 0.05, 0.1)
    assert model.JOINTS == ("theta1", "theta2R", "theta3R", "theta2L", "theta3L", "theta")
    assert model.TASK == ("x", "y", "z", "psi", "phi", "theta")
    assert len(model.BRANCHES) == BRANCHES[model.__name__.rpartition(".")[2]]
    shapes = {"fk": (6,), "pose": (4, 4), "jacobian": (6, 6), "determinant": ()}
    shapes |= {"arm_tips": (2, 3), "invariant_point": (3,)}
    shapes["singularities"] = (len(model.SINGULARITIES),)
    for lead in [(), (5,), (2, 3), (0,)]:
        q = np.broadcast_to(postures(1)[0], (*lead, 6))
        for name, shape in shapes.items():
            assert np.shape(getattr(model, name)(q)) == (*lead, *shape), name
        assert model.wrist_length(q[..., 0] * 0, q[..., 0] * 0).shape == lead
        assert model.minimum_link_length(q[..., 0] * 0, 0.1, 0.1).shape == lead
        solutions = model.ik(model.fk(q))
        assert solutions.q.shape == (*lead, len(model.BRANCHES), 6)
        assert solutions.status.shape == (*lead, len(model.BRANCHES))


def test_tips_by_denavit_hartenberg(model) -> None:
    for q in postures(50):
        right = forearm_tip(q[0], q[1], q[2], P.d)
        left = forearm_tip(q[0], q[3], q[4], -P.d)
        np.testing.assert_allclose(model.arm_tips(q), [right, left], atol=1e-15)


def test_published_map_by_the_printed_equations(published) -> None:
    for q in postures(200, 1):
        tips = np.array([forearm_tip(q[0], q[1], q[2], P.d), forearm_tip(q[0], q[3], q[4], -P.d)])
        mean2, mean3 = (q[1] + q[3]) / 2, (q[2] + q[4]) / 2
        T3 = frame3(q[0], mean2, mean3, 0.0)
        point = T3[:3, 3] + P.L2 * T3[:3, 2]
        ahead = (tips[0] - tips[1]) @ [np.cos(q[0]), np.sin(q[0]), 0] / 2
        psi = np.arctan(ahead / P.d)  # (4) less (5)
        phi = np.arctan((tips[0, 2] - tips[1, 2]) / 2 / P.d)  # (3)
        ratio = 1 - P.gs * np.cos(psi) / P.d
        square = P.al**2 - (ratio * P.d / np.cos(psi)) ** 2  # (8)
        if square < 1e-6:
            continue
        T = hand(T3, psi, phi, q[5], np.sqrt(square))
        np.testing.assert_allclose(published.invariant_point(q), point, atol=1e-14)
        np.testing.assert_allclose(published.pose(q), T, atol=1e-13)
        np.testing.assert_allclose(published.fk(q), [*T[:3, 3], psi, phi, q[5]], atol=1e-13)


def loop(q: np.ndarray, unknown: np.ndarray) -> np.ndarray:
    """The virtual arm misses the middle; the base lines of wrist and tips are not parallel."""
    theta2, theta3, psi, phi = unknown
    right = forearm_tip(q[0], q[1], q[2], P.d)
    left = forearm_tip(q[0], q[3], q[4], -P.d)
    T3 = frame3(q[0], theta2, theta3, 0.0)
    missed = frame3(q[0], 0, 0, 0)[:3, :3].T @ (T3[:3, 3] + P.L2 * T3[:3, 2] - (right + left) / 2)
    line = T3[:3, :3] @ rotation(2, phi) @ rotation(0, psi) @ [0, 1, 0]
    askew = T3[:3, :3].T @ np.cross(line, (right - left) / 2)
    return np.array([missed[0], missed[2], askew[0], askew[2]])


def test_closed_loop_by_newton(closed) -> None:
    solved = 0
    for q in postures(60, 2):
        unknown = np.array([(q[1] + q[3]) / 2, (q[2] + q[4]) / 2, 0.0, 0.0])
        for _ in range(30):
            steps = 1e-6 * np.eye(4)
            J = [(loop(q, unknown + s) - loop(q, unknown - s)) / 2e-6 for s in steps]
            unknown = unknown - np.linalg.solve(np.transpose(J), loop(q, unknown))
        x = closed.fk(q)
        if not np.isfinite(x).all():
            continue
        solved += 1
        theta2, theta3, psi, phi = unknown
        np.testing.assert_allclose(x[3:], [psi, phi, q[5]], atol=1e-9)
        half = np.linalg.norm(np.diff(closed.arm_tips(q), axis=0)) / 2
        wrist = np.sqrt(P.al**2 - (half - P.gs) ** 2)
        T = hand(frame3(q[0], theta2, theta3, 0.0), psi, phi, q[5], wrist)
        np.testing.assert_allclose(closed.pose(q), T, atol=1e-9)
        np.testing.assert_allclose(x[:3], T[:3, 3], atol=1e-9)
        np.testing.assert_allclose(closed.wrist_length(psi, phi), wrist, atol=1e-9)
    assert solved > 40


def test_the_four_bar_of_the_wrist_closes(closed) -> None:
    for q in postures(100, 3):
        T, x = closed.pose(q), closed.fk(q)
        if not np.isfinite(x).all():
            continue
        R = T[:3, :3] @ rotation(1, -q[5])
        wrist = closed.wrist_length(x[3], x[4])
        gears = T[:3, 3] - P.lp * T[:3, 2] - P.loff * R[:, 2]  # the middle of both
        np.testing.assert_allclose(gears - wrist * R[:, 2], closed.invariant_point(q), atol=1e-13)
        for tip, side in zip(closed.arm_tips(q), (1, -1), strict=True):
            link = gears + side * P.gs * R[:, 1] - tip
            assert abs(np.linalg.norm(link) - P.al) < 1e-13


def difference(model, q: np.ndarray, h: float = 1e-5) -> np.ndarray:
    steps = h * np.eye(6)
    return np.stack([(model.fk(q + s) - model.fk(q - s)) / (2 * h) for s in steps], axis=-1)


def test_jacobian_by_finite_differences(model) -> None:
    q = postures(200, 4, 0.04)
    q = q[np.isfinite(model.fk(q)).all(-1)]
    J, numeric = model.jacobian(q), difference(model, q)
    near = np.isfinite(numeric).all((-1, -2)) & (np.abs(model.singularities(q)) > 1e-2).all(-1)
    assert near.sum() > 100
    np.testing.assert_allclose(J[near], numeric[near], atol=2e-6)
    np.testing.assert_allclose(model.determinant(q), np.linalg.det(J), rtol=1e-8, atol=1e-12)


def test_factors_vanish_with_the_determinant(model) -> None:
    """Each factor vanishes at its event, which is found without the factors."""
    waist, virtual = model.SINGULARITIES[:2]
    assert "waist" in waist and "wrist" in virtual
    q = postures(1, 5, 0.02)[0]
    q[2:5] = [STRAIGHT - 1, q[1] + 0.01, STRAIGHT - 1.01]

    def factors(q: np.ndarray) -> np.ndarray:
        return model.singularities(q)

    if "loop" in model.__name__:
        for event, joint in ((2, 2), (3, 4)):
            arm = q.copy()
            arm[[2, 4]] = STRAIGHT - 0.05
            arm[joint] = STRAIGHT
            assert abs(factors(arm)[event]) < 1e-15 and abs(model.determinant(arm)) < 1e-15
            assert abs(model.determinant(arm - 1e-3 * np.eye(6)[joint])) > 1e-7
    else:
        straight = q.copy()
        straight[[2, 4]] = STRAIGHT + 0.02, STRAIGHT - 0.02
        assert abs(factors(straight)[2]) < 1e-15 and abs(model.determinant(straight)) < 1e-16
        real = q.copy()
        real[2] = STRAIGHT  # a real arm is straight; the published model does not notice
        assert abs(model.determinant(real)) > 1e-6


def test_inverse_inverts(model) -> None:
    q = postures(2000, 6)
    x = model.fk(q)
    possible = np.isfinite(x).all(-1)
    q, x = q[possible], x[possible]
    assert len(q) > 1000
    solutions, status = model.ik(x)
    found = status == OK
    assert found.any(-1).all() and (np.isnan(solutions).all(-1) == ~found).all()
    assert (np.abs(solutions[found]) <= np.pi).all()
    off = missed(model, solutions, x)
    assert np.abs(off[found]).max() < TOL
    gap = np.abs(np.angle(np.exp(1j * (solutions - q[:, None])))).max(-1)
    assert np.nanmin(gap, axis=-1).max() < 1e-7
    assert (found.sum(-1) == len(model.BRANCHES)).any()


@pytest.mark.parametrize("small", [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("which", ["right", "left", "both", "alike", "averages"])
def test_straight_arms(model, small: float, which: str) -> None:
    q = postures(300, 7, 0.05)
    rng = np.random.default_rng(8)
    bend, other = small * rng.choice((-1, 1), (2, 300))
    near = STRAIGHT + rng.uniform(-0.05, 0.05, 300)
    q[:, 2] = near if which == "left" else STRAIGHT + bend
    q[:, 4] = near if which == "right" else STRAIGHT + other
    if which == "alike":
        q[:, 3:5] = q[:, 1:3]
    if which == "averages":
        q[:, 2] = STRAIGHT + bend + 0.03
        q[:, 4] = STRAIGHT - 0.03
    x = model.fk(q)
    q, x = q[np.isfinite(x).all(-1)], x[np.isfinite(x).all(-1)]
    solutions, status = model.ik(x)
    found = np.isin(status, (OK, SINGULAR))
    assert len(q) > 250 and found.any(-1).all()
    off = missed(model, solutions, x)
    assert np.abs(off[found]).max() < TOL


def test_statuses(model) -> None:
    x = np.array([0.75, 0.1, 0.6, 0.1, 0.1, 0.2])
    assert (model.ik(x).status == OK).any()

    def status(**moved: float) -> np.ndarray:
        return model.ik([moved.get(n, v) for n, v in zip(model.TASK, x, strict=True)]).status

    assert (status(x=3.0) == UNREACHABLE).all()  # out of reach
    assert (status(psi=0.9) == UNREACHABLE).all()  # the wrist links are too short
    assert (status(psi=2.0) == UNREACHABLE).all()
    assert (status(phi=1.6) == UNREACHABLE).all()
    assert (status(x=0.0, y=0.01, psi=0.5) == UNREACHABLE).all()  # the dead cylinder
    assert (status(z=np.nan) == INVALID).all() and (status(psi=np.inf) == INVALID).all()
    assert np.isnan(model.ik(x * np.nan).q).all()
    for k in range(9):
        assert (model.ik(x, P._replace(**{P._fields[k]: -0.1})).status == INVALID).all()


@pytest.mark.parametrize("zero", [{"d": 0.0}, {"L1": 0.0}, {"L2": 0.0, "a3": 0.0}])
def test_an_arm_that_is_none_is_invalid(model, zero: dict) -> None:
    """Without d yaw and roll mean nothing; without a link an arm does not reach a plane."""
    for x in ([0.75, 0.1, 0.6, 0.1, 0.1, 0.2], [0.75, 0.1, 0.6, 0.0, 0.0, 0.2]):
        solutions = model.ik(x, P._replace(**zero))
        assert (solutions.status == INVALID).all() and np.isnan(solutions.q).all()
    for name in ("a3", "d1", "gs", "loff", "lp", "L2"):
        assert (model.ik(x, P._replace(**{name: 0.0})).status != INVALID).all()


def test_averages_of_a_straight_arm(published) -> None:
    """Only one combination of the half differences counts; it may need both sines."""
    q, rng = postures(400, 15), np.random.default_rng(16)
    wide = P._replace(al=1.0)  # so that the tips may be far apart
    upper, alpha, beta = rng.uniform(-1.5, 1.5, (3, 400))
    bend = STRAIGHT + rng.choice((0, np.pi), 400)
    q[:, 1], q[:, 3] = upper + alpha, upper - alpha
    q[:, 2], q[:, 4] = bend + beta - alpha, bend - beta + alpha
    x = published.fk(q, wide)
    assert np.isfinite(x).all()
    solutions, status = published.ik(x, wide)
    found = np.isin(status, (OK, SINGULAR))
    assert found.any(-1).all() and (status == SINGULAR).any(-1).mean() > 0.9
    off = missed(published, solutions, x, wide)
    assert np.abs(off[found]).max() < 2e-12
    # the reach of the gap: more than the upper arms alone can make up
    gap = np.linalg.norm(P.d * np.tan(x[:, 3:5]), axis=1)
    assert (gap > P.L1 * 1.01).any()


def two_events_at_once(n: int, params, seed: int) -> np.ndarray:
    """Virtual arms straight, folded or bent; real arms apart by a right angle, or little."""
    rng = np.random.default_rng(seed)

    def some(*values: float) -> np.ndarray:
        tiny = rng.choice((0, 0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-3), n) * rng.choice((-1, 1), n)
        return rng.choice(values, n) + tiny

    straight, right = np.arctan2(params.L2, params.a3), np.pi / 2
    upper, bend = (
        some(0, right, -right, 2 * right, 0.3),
        some(straight, straight + np.pi, 0.7, -1.5),
    )
    alpha, beta = some(0, right, -right, 0.2, -0.1, 0.9), some(0, right, -right, 0.2, -0.1, -0.9)
    beta = np.where(rng.random(n) < 0.3, -alpha + some(0), beta)
    columns = (rng.uniform(-3, 3, n), upper + alpha, bend + beta - alpha)
    return np.stack((*columns, upper - alpha, bend - beta + alpha, some(0, right, np.pi, 0.4)), -1)


@pytest.mark.parametrize("dimensions", [{}, {"al": 1.0}])
def test_no_posture_is_lost_where_two_events_meet(model, dimensions: dict) -> None:
    """Rounding a target there turns arms by 1e-8, more than some answers can afford."""
    params = P._replace(**dimensions)
    q = two_events_at_once(20_000, params, 41)
    x = model.fk(q, params)
    x = x[np.isfinite(x).all(-1)]
    assert len(x) > 4_000
    solutions, status = model.ik(x, params)
    found = np.isin(status, (OK, SINGULAR))
    assert found.any(-1).all()
    off = missed(model, solutions, x, params)
    lost = np.abs(off[status == OK]).max(-1) > 1e-12 * sum(params)
    if model.__name__.endswith("h6ar"):
        assert not lost.any()
    else:  # near a folded virtual arm: docs/decisions/h6ar-models.md
        assert lost.mean() < 5e-3 and np.abs(off[status == OK]).max() < 2e-11 * sum(params)


def test_a_virtual_arm_without_direction_is_singular(closed) -> None:
    """Equal links folded onto their shoulders: the joints do not determine yaw and roll."""
    equal = P._replace(a3=0.0)
    # a hand that stands on the shoulder: the virtual arm is solved, and its length is zero
    R = frame3(0.3, 0.5, 0.7, 0.0)[:3, :3] @ rotation(2, 0.1) @ rotation(0, 0.2)
    wrist = closed.wrist_length(0.2, 0.1, equal) + equal.loff
    on_shoulder = wrist * R[:, 2] + equal.lp * (R @ rotation(1, 0.1))[:, 2] + [0, 0, equal.d1]
    for tip, expected in ((on_shoulder, SINGULAR), ([0.75, 0.1, 0.6], OK)):
        assert expected in closed.ik([*tip, 0.2, 0.1, 0.1], equal).status


def test_the_wrist_limit(model) -> None:
    limit = model.largest_yaw(0.0, 0.0)
    np.testing.assert_allclose(limit, np.arccos(P.d / (P.al + P.gs)), rtol=1e-14)
    x = np.array([0.75, 0.1, 0.6, limit, 0.0, 0.2])
    solutions = model.ik(x)
    found = solutions.status == SINGULAR  # joints do not determine the tip to twelve digits
    assert found.any() and not (solutions.status == OK).any()
    off = model.fk(solutions.q[found]) - x
    assert np.abs(off[:, 3:]).max() < TOL
    assert np.abs(off).max() < 1e-8  # l_W goes with a root: joints are no finer than that
    assert (model.ik(x + 1e-9 * np.eye(6)[3]).status == UNREACHABLE).all()
    assert model.wrist_length(limit - 1e-9, 0.0) > 0
    assert np.isnan(model.wrist_length(limit + 1e-9, 0.0))


def test_above_the_waist(model) -> None:
    """x = y = 0 with L_theta = 0: the waist is free, theta1 = 0 is returned."""
    x = [0.0, 0.0, 0.75, 0.0, 0.0, 0.3]
    solutions = model.ik(x)
    free = solutions.status == SINGULAR
    assert free.any() and np.isin(solutions.status, (SINGULAR, UNREACHABLE)).all()
    assert (solutions.q[free, 0] == 0).all()
    assert np.abs(model.fk(solutions.q[free]) - x).max() < TOL


def test_tips_on_the_shoulders(closed) -> None:
    """Equal links without an offset fold onto the shoulders: r = h = 0, the arms are free."""
    equal = P._replace(L1=0.4, L2=0.4, a3=0.0)
    q = np.array([0.3, 0.7, -np.pi / 2, 0.7, -np.pi / 2, 0.4])
    x = closed.fk(q, equal)
    assert np.abs(closed.arm_tips(q, equal) @ [0, 0, 1] - P.d1).max() < 1e-15
    solutions = closed.ik(x, equal)
    free = solutions.status == SINGULAR
    assert free.any()
    off = closed.fk(solutions.q[free], equal) - x
    assert np.abs(np.angle(np.exp(1j * off))).max() < TOL


@pytest.mark.parametrize("bend", [0.0, 1e-12, 1e-9, 1e-6])
@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-6, 1e-5, 1e-4])
def test_straight_arm_under_a_straight_virtual_arm(closed, bend: float, tilt: float) -> None:
    """The target does not tell how far the virtual arm is bent; the right arm must be in reach."""
    q, rng = postures(400, 13), np.random.default_rng(14)
    q[:, 2] = STRAIGHT + bend * rng.choice((-1, 1), 400)
    q[:, 3:5] = q[:, 1:3] + rng.uniform(-0.1, 0.1, (400, 2))
    pitch = np.linspace(-np.pi, np.pi, 41)
    low, high = np.full(400, np.nan), np.full(400, np.nan)

    def straight(pitch: np.ndarray) -> np.ndarray:
        return closed.singularities(np.column_stack([q[:, :5], pitch]))[:, 1]

    for a, b in itertools.pairwise(pitch):
        crossed = straight(np.full(400, a)) * straight(np.full(400, b)) < 0
        low[crossed], high[crossed] = a, b
    q, low, high = (e[np.isfinite(low)] for e in (q, low, high))
    for _ in range(60):
        q[:, 5] = (low + high) / 2
        F = [closed.singularities(np.column_stack([q[:, :5], e]))[:, 1] for e in (low, q[:, 5])]
        low, high = (
            np.where(F[0] * F[1] > 0, q[:, 5], low),
            np.where(F[0] * F[1] > 0, high, q[:, 5]),
        )
    q[:, 5] += tilt
    x = closed.fk(q)
    solutions, status = closed.ik(x)
    assert len(q) > 100 and (status == OK).any(-1).all()
    off = missed(closed, solutions, x)
    assert np.abs(off[status == OK]).max() < TOL


@pytest.mark.parametrize("small", [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("which", ["right", "left"])
def test_arms_of_equal_links_folded_onto_their_shoulders(closed, small: float, which: str) -> None:
    """With r = h = 0 of one tip no digit is lost."""
    equal = P._replace(a3=0.0)
    q, rng = postures(300, 11), np.random.default_rng(12)
    q[:, 2] = -np.pi / 2 + small * rng.choice((-1, 1), 300)
    q[:, 3:5] = q[:, 1:3] + rng.uniform(0.02, 0.1, (300, 2))
    if which == "left":
        q[:, [1, 2, 3, 4]] = q[:, [3, 4, 1, 2]]
    x = closed.fk(q, equal)
    assert np.isfinite(x).all()
    solutions, status = closed.ik(x, equal)
    found = np.isin(status, (OK, SINGULAR))
    assert found.any(-1).all()
    singular = (status[found] == SINGULAR).mean()
    assert singular > 0.3 if small < 1e-12 else singular < 0.1
    off = missed(closed, solutions, x, equal)
    assert np.abs(off[found]).max() < TOL


@pytest.mark.parametrize(
    "change", [{"a3": 0.0}, {"L2": 0.3}, {"gs": 0.0}, {"loff": 0.0, "lp": 0.0}]
)
def test_other_dimensions(model, change: dict) -> None:
    dimensions = P._replace(**change)
    q = postures(300, 9, 0.05)
    x = model.fk(q, dimensions)
    x = x[np.isfinite(x).all(-1)]
    solutions, status = model.ik(x, dimensions)
    assert len(x) > 200 and (status == OK).any(-1).all()
    off = missed(model, solutions, x, dimensions)
    assert np.abs(off[status == OK]).max() < TOL


def test_wrist_design(model) -> None:
    """With the shortest links the separation angle is at least beta_min, and reaches it."""
    yaw, roll, beta = 0.5, 0.4, 0.3
    combined = "loop" in model.__name__
    shortest = model.minimum_link_length(yaw, roll, beta)
    angles = np.stack(np.meshgrid(np.linspace(-yaw, yaw, 41), np.linspace(-roll, roll, 41)))
    half = P.d / np.cos(angles[0]) / (np.cos(angles[1]) if combined else 1)
    separation = np.arccos((half - P.gs) / shortest)
    np.testing.assert_allclose(separation.min(), beta, atol=1e-7)
    longer = P._replace(al=shortest)
    np.testing.assert_allclose(model.largest_yaw(roll, beta, longer), yaw, atol=1e-7)
    both = model.largest_angle(beta, longer)
    np.testing.assert_allclose(
        model.minimum_link_length(both, both, beta, longer), shortest, atol=1e-12
    )
    printed = (P.d - P.gs * np.cos(yaw)) / (np.cos(yaw) * np.cos(beta))
    np.testing.assert_allclose(model.minimum_link_length(yaw, 0.0, beta), printed, rtol=1e-14)
    assert (shortest > printed * 1.05) == combined
    assert np.isnan(model.largest_yaw(1.5, beta)) == combined


def test_both_back_ends_agree() -> None:
    for name in MODELS:
        numpy, c = (
            importlib.import_module(f"closedform.generated.{b}.{name}") for b in ("numpy", "c")
        )
        assert numpy.__all__ == c.__all__ and numpy.BRANCHES == c.BRANCHES
        q = postures(500, 10)
        for function in ("fk", "pose", "arm_tips", "invariant_point", "singularities"):
            a, b = getattr(numpy, function)(q), getattr(c, function)(q)
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-13)
        a, b = numpy.ik(numpy.fk(q)), c.ik(numpy.fk(q))
        np.testing.assert_array_equal(a.status, b.status)
        np.testing.assert_allclose(numpy.fk(a.q), numpy.fk(b.q), rtol=0, atol=1e-11)
        strided = np.asfortranarray(q)[::-2]
        np.testing.assert_allclose(c.fk(strided), c.fk(q)[::-2], rtol=0, atol=1e-14)


def test_nothing_warns(model) -> None:
    with warnings.catch_warnings(), np.errstate(all="raise"):
        warnings.simplefilter("error")
        for bad in (np.nan, np.inf, 1e300):
            model.fk(np.full(6, bad))
            assert (model.ik(np.full(6, bad)).status >= UNREACHABLE).all()
            model.jacobian(np.full(6, bad))
