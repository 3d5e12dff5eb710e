"""The H6AR of the paper where the waist is tangent or the wrist is stretched: nothing is lost."""

import importlib

import numpy as np
import pytest
from fuzz.lengths import draw_lengths
from fuzz.robots import robot
from test_h6ar import OK, SINGULAR, P, missed


@pytest.fixture(params=("numpy", "c"))
def published(request: pytest.FixtureRequest):
    return importlib.import_module(f"closedform.generated.{request.param}.h6ar")


def with_tangent_waist(model, n: int, seed: int, params) -> np.ndarray:
    """Real arms a right angle apart at both joints, with the tip above or below the waist axis.

    NaN where the tip comes to neither.
    """
    rng = np.random.default_rng(seed)
    waist, upper, fore, pitch = rng.uniform(-3, 3, (4, n))
    tiny = rng.choice((0, 1e-15, 1e-12, 1e-9), (2, n))
    alpha, beta = rng.choice((-1, 1), (2, n)) * (np.pi / 2 - tiny)

    def posture(turn: np.ndarray) -> np.ndarray:
        u, f = upper + turn, fore + turn
        columns = (waist, u + alpha, f + beta - u - alpha, u - alpha, f - beta - u + alpha, pitch)
        return np.stack(columns, -1)

    def outward(turn: np.ndarray) -> np.ndarray:
        return model.singularities(posture(turn), params)[:, 0]

    places = np.linspace(-3.2, 3.2, 41)
    sides = np.stack([outward(np.full(n, place)) > 0 for place in places], -1)
    at = np.argmax(sides[:, 1:] != sides[:, :-1], -1)
    low, high, side = places[at], places[at + 1], sides[np.arange(n), at]
    for _ in range(60):
        middle = (low + high) / 2
        same = (outward(middle) > 0) == side
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    there = (outward(low) > 0) != (outward(high) > 0)
    return np.where(there[:, None], posture(low), np.nan)


def test_a_tangent_waist_and_arms_a_right_angle_apart_are_not_lost(published) -> None:
    """The waist turns with a bent virtual arm, which leaves the tip where it is."""
    params = P._replace(al=1.5)
    x = published.fk(with_tangent_waist(published, 20_000, 46, params), params)
    x = x[np.isfinite(x).all(-1)]
    assert len(x) > 5_000
    solutions, status = published.ik(x, params)
    assert np.isin(status, (OK, SINGULAR)).any(-1).all()
    off = missed(published, solutions, x, params)[status == OK]
    assert np.abs(off).max() < 1e-12 * sum(params)


def test_three_events_with_dissimilar_lengths_are_not_lost(published) -> None:
    """Rounding moves the tip more the shorter the wrist is; what misses more is SINGULAR.

    Turns that keep the arms within reach move the tip too.
    """
    lengths = draw_lengths(np.random.default_rng(107), robot("h6ar"), 60_000)
    params = published.Parameters(*lengths.T)
    with np.errstate(all="ignore"):
        x = published.fk(with_tangent_waist(published, len(lengths), 107, params), params)
    rows = np.isfinite(x).all(-1)
    x, lengths = x[rows], lengths[rows]
    assert len(x) > 15_000
    solutions, status = published.ik(x, published.Parameters(*lengths.T))
    assert np.isin(status, (OK, SINGULAR)).any(-1).all()
    off = missed(published, solutions, x, published.Parameters(*lengths.T[:, :, None]))
    off[..., :3] /= lengths.sum(-1)[:, None, None]
    d = lengths[:, list(published.Parameters._fields).index("d")]
    promised = np.maximum(1e-12, 2.0**-46 * lengths.sum(-1) / d)
    assert (np.abs(off).max(-1) <= promised[:, None])[status == OK].all()


def with_stretched_wrist(model, n: int, seed: int, params=P) -> np.ndarray:
    """Arms a right angle apart at one joint, and at the other as far as the wrist spans.

    NaN where the wrist spans all postures or none.
    """
    rng = np.random.default_rng(seed)
    waist, upper, bend, pitch = rng.uniform(-3, 3, (4, n))
    right = rng.choice((-1, 1), n) * np.pi / 2
    right += rng.choice((0, 1e-15, 1e-12, 1e-9), n) * rng.choice((-1, 1), n)
    first = rng.random(n) < 0.5

    def posture(other: np.ndarray) -> np.ndarray:
        alpha, beta = np.where(first, right, other), np.where(first, other, right)
        columns = (waist, upper + alpha, bend + beta - alpha)
        return np.stack((*columns, upper - alpha, bend - beta + alpha, pitch), -1)

    def spans(other: np.ndarray) -> np.ndarray:
        return np.isfinite(model.fk(posture(other), params)).all(-1)

    places = np.linspace(-3.2, 3.2, 41)
    within = np.stack([spans(np.full(n, place)) for place in places], -1)
    change = within[:, 1:] != within[:, :-1]
    rows, at = np.arange(n), np.argmax(change, -1)
    near, beyond = (np.where(within[rows, at] == k, places[at], places[at + 1]) for k in (1, 0))
    for _ in range(60):
        middle = (near + beyond) / 2
        near, beyond = (
            np.where(spans(middle) == k, middle, e) for k, e in ((1, near), (0, beyond))
        )
    inwards = np.sign(near - beyond) * rng.choice((0, 1e-14, 1e-12, 1e-11, 1e-10), n)
    return np.where(change.any(-1)[:, None], posture(near + inwards), np.nan)


def test_a_stretched_wrist_at_a_right_angle_is_not_lost(published) -> None:
    """A unit in the last place of yaw changes the length of a stretched wrist by its root."""
    x = published.fk(with_stretched_wrist(published, 20_000, 43))
    x = x[np.isfinite(x).all(-1)]
    assert len(x) > 10_000
    solutions, status = published.ik(x)
    assert (status != OK).all()
    assert (status == SINGULAR).any(-1).all()
    off = missed(published, solutions, x, P)[status == SINGULAR]
    assert np.nanmax(np.abs(off)) < 1e-5  # NaN: rounded joints stretch the wrist a little further


def test_a_stretched_wrist_with_dissimilar_lengths_is_not_lost(published) -> None:
    """Arms close to each other: a unit in the last place of yaw moves the tips farther."""
    rng = np.random.default_rng(44)
    lengths = draw_lengths(rng, robot("h6ar"), 40_000)
    q = with_stretched_wrist(published, len(lengths), 45, published.Parameters(*lengths.T))
    x = published.fk(q, published.Parameters(*lengths.T))
    rows = np.isfinite(x).all(-1)
    assert rows.sum() > 10_000
    _, status = published.ik(x[rows], published.Parameters(*lengths[rows].T))
    assert np.isin(status, (OK, SINGULAR)).any(-1).all()
