"""What rounded joints determine near a parallel singularity: circles intersected to 50 digits."""

import importlib
from collections.abc import Iterator

import numpy as np
import pytest
from mpmath import mp, mpf

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
LEAST = 2.0**-10
DISTANCES = 10.0 ** -np.arange(16)


@pytest.fixture(autouse=True)
def fifty_digits() -> Iterator[None]:
    with mp.workdps(50):
        yield


@pytest.fixture(params=("numpy", "c"))
def backend(request: pytest.FixtureRequest) -> str:
    return request.param


def load(backend: str, robot: str):
    return importlib.import_module(f"closedform.generated.{backend}.{robot}")


def circles(centres, radii, start) -> float:
    """The distance from ``start`` to where two circles meet, by Newton's method."""
    x, y = map(mpf, start)
    for _ in range(60):
        rows = [(x - cx, y - cy) for cx, cy in centres]
        left = [(u * u + v * v - r * r) / 2 for (u, v), r in zip(rows, radii, strict=True)]
        (a, b), (c, d) = rows
        det = a * d - b * c
        step = (d * left[0] - b * left[1]) / det, (a * left[1] - c * left[0]) / det
        x, y = x - step[0], y - step[1]
        if mp.hypot(*step) < mpf(10) ** -40:
            return float(mp.hypot(x - start[0], y - start[1]))
    return np.inf


def missed(q, p, lengths) -> float:
    """The distance from p to where the bars of the five-bar linkage meet, over the sum of lengths.

    It is taken in the plane that theta1 turns, from the point of this plane nearest to p.
    """
    L0, L1, L2 = map(mpf, lengths)
    t1, t2, t3 = map(mpf, map(float, q))
    x, y, z = map(mpf, map(float, p))
    centres = [(k + L1 * mp.cos(t), L1 * mp.sin(t)) for k, t in ((0, t2), (L0, t3))]
    off, aside = z * mp.sin(t1) - x * mp.cos(t1), z * mp.cos(t1) + x * mp.sin(t1)
    apart = circles(centres, (L2, L2), (y, off))
    return float(mp.hypot(apart, aside) / (L0 + L1 + L2))


def with_angle(lengths, psi: float, phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """P and (theta2, theta3) of postures whose bars CP and DP are turned by psi, bar by bar."""
    L0, L1, L2 = lengths
    CP, DP = L2 * np.exp(1j * phi), L2 * np.exp(1j * (phi + psi))
    across = L0 + L2 * np.exp(1j * phi) * (2j * np.sin(psi / 2) * np.exp(0.5j * psi))
    half = np.abs(across) / 2
    meets = (half < L1) & (half > 1e-3)
    across, half, CP, DP = (v[meets] for v in (across, half, CP, DP))
    P = CP + across / 2 + 1j * across / np.abs(across) * np.sqrt(L1**2 - half**2)
    return P, np.stack([np.angle(P - CP), np.angle(P - L0 - DP)], axis=-1)


@pytest.mark.parametrize("lengths", [(7, 8, 5), (1, 1, 2), (0.5, 3, 1)])
def test_five_bar_at_all_distances(backend: str, lengths) -> None:
    """The branch of a posture is OK if the sine between its bars exceeds the limit."""
    arm, rng, told = (
        load(backend, "hybrid_five_bar"),
        np.random.default_rng(0),
        {OK: 0, SINGULAR: 0},
    )
    for k, distance in enumerate((0.0, *DISTANCES)):
        for psi in (distance, -distance, np.pi - distance, np.pi + distance):
            P, angles = with_angle(lengths, psi, rng.uniform(-np.pi, np.pi, 12))
            turn = 0.3 + 0.1 * k
            p = np.stack([-P.imag * np.cos(turn), P.real, P.imag * np.sin(turn)], axis=-1)
            q, status = arm.ik(p, lengths)
            assert np.isin(status, (OK, SINGULAR)).all()
            off = np.abs(np.exp(1j * q[..., 1:]) - np.exp(1j * angles[:, None])).max(axis=-1)
            off += np.abs(np.exp(1j * q[..., 0]) - np.exp(1j * turn))
            for row, branch in enumerate(off.argmin(axis=-1)):
                if off[row, branch] < 1e-5 and np.sort(off[row])[1] > 1e-2:
                    expected = OK if abs(np.sin(psi)) > LEAST else SINGULAR
                    assert status[row, branch] == expected, (psi, p[row].tolist())
                    told[expected] += 1
            for row, branch in np.argwhere(status == OK)[:12]:
                assert missed(q[row, branch], p[row], lengths) <= 1e-12
    assert min(told.values()) > 50


def test_five_bar_where_c_is_d(backend: str) -> None:
    """All P around C = D: a branch with C on D is not OK, because its joints fit any such P."""
    arm, corner = load(backend, "hybrid_five_bar"), 3.5 + 1j * np.sqrt(64 - 3.5**2)
    P = corner + 5 * np.exp(1j * np.linspace(-3, 3, 50))
    P = P[(P.imag > 0.1) & (np.abs(P) > 3.1) & (np.abs(P - 7) > 3.1)]
    p = np.stack([-P.imag, P.real, 0 * P.real], axis=-1)
    q, status = arm.ik(p)
    on_it = np.abs(8 * np.exp(1j * q[..., 1]) - 7 - 8 * np.exp(1j * q[..., 2])) < 1e-6
    assert on_it.any(axis=-1).all()
    assert (status[on_it] == SINGULAR).all()
    for row, branch in np.argwhere(status == OK):
        assert missed(q[row, branch], p[row], (7, 8, 5)) <= 1e-12
    many, status = arm.ik([0.3, 0.8, 0.2], (0, 1, 1))
    assert (np.abs(many[:, 1] - many[:, 2]) < 1e-12).sum() == 4
    np.testing.assert_array_equal(status == SINGULAR, np.abs(many[:, 1] - many[:, 2]) < 1e-12)


def test_five_bar_with_unlike_lengths(backend: str) -> None:
    """The promise holds with lengths of 1e-4 to 1e4 of each other."""
    arm, rng, tried = load(backend, "hybrid_five_bar"), np.random.default_rng(1), 0
    for lengths in ((1, 1, 1e4), (1e-4, 1, 1), (1, 1e4, 1e4), (1, 100, 1), (1e-2, 1, 1e-2)):
        p, _ = arm.fk(rng.uniform(-np.pi, np.pi, (4000, 3)), lengths)
        p = p[np.isfinite(p).all(axis=-1)][:15]
        q, status = arm.ik(p, lengths)
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
        for row, branch in np.argwhere(status == OK):
            assert missed(q[row, branch], p[row], lengths) <= 1e-12
            tried += 1
    assert tried > 30


@pytest.mark.parametrize("b", [1.0, 2.5, 1e-4, 1e4])
def test_rpr_at_all_distances(backend: str, b: float) -> None:
    arm, rng, told = load(backend, "rpr_planar"), np.random.default_rng(2), []
    for distance in (0.0, *DISTANCES):
        p = b * np.stack([rng.uniform(-3, 3, 40), rng.choice((-1, 1), 40) * distance], axis=-1)
        q, status = (part[:, 0] for part in arm.ik(p, (b,)))
        sine = np.abs(p[:, 1]) * b / (np.hypot(*p.T) * np.hypot(p[:, 0] - b, p[:, 1]))
        np.testing.assert_array_equal(status, np.where(sine > LEAST, OK, SINGULAR))
        for target, rho, code in zip(p, q, status, strict=True):
            if code == OK:
                apart = circles([(0, 0), (mpf(b), 0)], [mpf(float(r)) for r in rho], target)
                assert apart <= 1e-12 * (b + rho.sum())
        told += status.tolist()
    assert set(told) == {OK, SINGULAR}


def test_rpr_where_the_legs_hold_nothing(backend: str) -> None:
    """Pivots that coincide, points far away, and the pivots themselves."""
    arm = load(backend, "rpr_planar")
    for p, b in (([0.3, 0.4], 0.0), ([0.0, 0.0], 0.0), ([0.0, 0.0], 1.0), ([1.0, 0.0], 1.0)):
        q, status = arm.ik(p, (b,))
        assert status[0] == SINGULAR
        np.testing.assert_allclose(q[0], [np.hypot(*p), np.hypot(p[0] - b, p[1])])
    for distance, expected in ((500, OK), (5e3, SINGULAR), (1e9, SINGULAR)):
        assert arm.ik([0.6 * distance, 0.8 * distance]).status[0] == expected


@pytest.mark.parametrize("robot", ["h6ar", "h6ar_loop_closed"])
def test_wrist_links_that_are_nearly_stretched(backend: str, robot: str) -> None:
    """The length of the wrist varies with a root; an OK answer still gives the tip."""
    arm, rng = load(backend, robot), np.random.default_rng(3)
    q = rng.uniform(-1, 1, (4000, 6)) * [3, 0.3, 0.3, 0.3, 0.3, 1] + [0, 0.6, -0.4, 0.6, -0.4, 0]
    exists = np.isfinite(arm.fk(q)).all(axis=-1)
    start, beyond = (part[:100] for part in (q[exists], q[~exists]))
    near = start.copy()
    for _ in range(60):
        middle = (near + beyond) / 2
        inside = np.isfinite(arm.fk(middle)).all(axis=-1)[:, None]
        near, beyond = np.where(inside, middle, near), np.where(inside, beyond, middle)
    assert np.median(arm.singularities(near)[:, 5]) < 1e-7
    worst, judged = [], set()
    for share in (0.0, *DISTANCES):
        x = arm.fk(near + share * (start - near))
        answers, status = arm.ik(x)
        judged |= set(status.ravel().tolist())
        row, branch = np.nonzero(status == OK)
        off = arm.fk(answers[row, branch]) - x[row]
        off[:, 3:] = np.angle(np.exp(1j * off[:, 3:]))
        worst.append(np.abs(off / [*[sum(arm.Parameters())] * 3, 1, 1, 1]).max(initial=0))
    assert max(worst) <= 1e-12
    assert {OK, SINGULAR} <= judged
