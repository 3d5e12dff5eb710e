"""NumPy, a single C call and a C batch give every branch the same status, even at thresholds."""

import importlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from given import beside

POSTURES = 20_000


def small(random: np.random.Generator) -> np.ndarray:
    """Distances from a threshold, of either sign and any size up to 1e-5, and zero."""
    size = 10.0 ** random.uniform(-17, -5, POSTURES)
    return random.choice([-1, 0, 1, 1], POSTURES) * size


def near(joint: int, values: tuple[float, ...]) -> Callable[..., None]:
    def at_threshold(q: np.ndarray, random: np.random.Generator) -> None:
        q[:, joint] = random.choice(values, POSTURES) + small(random)

    return at_threshold


def near_shoulder(q: np.ndarray, random: np.random.Generator) -> None:
    """The wrist of a Puma on the axis of its waist, or its arm at full stretch."""
    near(4, (0.0,))(q, random)
    q[: POSTURES // 2, 2] = np.arctan2(0.4318, -0.0203) - np.pi / 2 + small(random)[: POSTURES // 2]


def near_edges(q: np.ndarray, random: np.random.Generator) -> None:
    near(2, (0.0,))(q, random)
    near(4, (0.0, np.pi))(q, random)


THRESHOLDS = {
    "planar_2r": [near(1, (0.0, np.pi))],
    "scara": [near(1, (0.0, np.pi))],
    "spherical_wrist": [near(1, (0.0, np.pi))],
    "irb260": [near(2, (-np.pi / 2, np.pi / 2))],
    "puma560": [near(4, (0.0, np.pi)), near_shoulder],
    "stanford_arm": [near(2, (0.0,)), near(4, (0.0, np.pi))],
    "ur_arm": [near(4, (0.0, np.pi)), near_edges],
    "hybrid_five_bar": [near(1, (0.0, np.pi)), near(2, (0.0, np.pi))],
    "irb2400": [near(4, (0.0, np.pi)), near(2, (np.arctan2(0.755, 0.135) - np.pi,))],
    "agile_wrist": [near(1, (-np.pi / 2, np.pi / 2))],
    "srs_arm": [near(3, (0.0, np.pi)), near(1, (0.0, np.pi)), near(5, (0.0, np.pi))],
    "franka_arm": [near(1, (0.0, np.pi)), near(4, (np.pi / 2, -np.pi / 2))],
    "opw_arm": [near(4, (0.0, np.pi)), near(2, (-np.arctan2(-0.035, 0.365),))],
}


@pytest.mark.parametrize("robot", THRESHOLDS)
def test_statuses_at_thresholds(robot: str) -> None:
    source = importlib.import_module(f"closedform.generated.numpy.{robot}")
    compiled = importlib.import_module(f"closedform.generated.c.{robot}")
    for seed, to_threshold in enumerate(THRESHOLDS[robot]):
        random = np.random.default_rng(seed)
        q = random.uniform(-3, 3, (POSTURES, len(source.JOINTS)))
        to_threshold(q, random)
        x = source.fk(q)
        x = x.p[:, 0] if source.ASSEMBLY_MODES else x
        more = beside(source, q)
        expected = source.ik(x, *more).status
        np.testing.assert_array_equal(compiled.ik(x, *more).status, expected)
        single = np.array([compiled.ik(*row).status for row in zip(x, *more, strict=True)])
        np.testing.assert_array_equal(single, expected)


LIMITS = {
    ("h6ar", "ik"): ((1, 1, 1.2, 0.8, 0.8, 3), (-1, -1, 0, -0.8, -0.8, -3)),
    ("h6ar_loop_closed", "ik"): ((1, 1, 1.2, 0.8, 0.8, 3), (-1, -1, 0, -0.8, -0.8, -3)),
    ("hybrid_five_bar", "fk"): ((3, 3, 3), (-3, -3, -3)),
    ("hybrid_five_bar", "ik"): ((3, 3, 3), (-3, -3, -3)),
    ("rpr_planar", "fk"): ((3, 3), (0, 0)),
    ("five_bar", "fk"): ((3, 3), (-3, -3)),
    ("five_bar", "ik"): ((20, 20), (-15, -15)),
    ("delta", "fk"): ((3, 3, 3), (-3, -3, -3)),
    ("delta", "ik"): ((0.4, 0.4, 0.5), (-0.4, -0.4, -0.5)),
    ("linear_delta", "fk"): ((1, 1, 1), (-1, -1, -1)),
    ("linear_delta", "ik"): ((0.5, 0.5, 0.5), (-0.5, -0.5, -0.5)),
    ("orthoglide", "fk"): ((2, 2, 2), (-2, -2, -2)),
    ("orthoglide", "ik"): ((1, 1, 1), (-1, -1, -1)),
    ("spherical_five_bar", "fk"): ((3, 3), (-3, -3)),
    ("four_bar", "ik"): ((3,), (-3,)),
    ("slider_crank", "ik"): ((6,), (-6,)),
}
"""Functions, and the values between which an argument crosses a limit of their reach."""


def at_limit(function: Callable[..., Any], a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Between each a and b with different statuses, the last argument with the status of a."""
    status = function(a).status
    crosses = (status != function(b).status).any(axis=1)
    a, b, status = a[crosses], b[crosses], status[crosses]
    for _ in range(60):
        middle = a + (b - a) / 2
        before = (function(middle).status == status).all(axis=1)[:, None]
        a, b = np.where(before, middle, a), np.where(before, b, middle)
    return a


@pytest.mark.parametrize(("robot", "name"), LIMITS)
def test_statuses_at_limits(robot: str, name: str) -> None:
    """On and near each boundary of a workspace: straight arms, stretched wrists and others."""
    source = getattr(importlib.import_module(f"closedform.generated.numpy.{robot}"), name)
    compiled = getattr(importlib.import_module(f"closedform.generated.c.{robot}"), name)
    random = np.random.default_rng(0)
    most, least = LIMITS[robot, name]
    limits = at_limit(source, *random.uniform(least, most, (2, POSTURES // 2, len(most))))
    x = limits[random.integers(len(limits), size=POSTURES)]
    x += small(random)[:, None] * random.choice([0, 1], x.shape)
    expected = source(x).status
    assert len(np.unique(expected)) > 1
    np.testing.assert_array_equal(compiled(x).status, expected)
    single = np.array([compiled(row).status for row in x])
    np.testing.assert_array_equal(single, expected)
