"""Ranges of angles: how much wrapping an answer needs to be in (-pi, pi]."""

import importlib
import math

import numpy as np
import pytest
import sympy as sp
from closedform.generated.numpy import _runtime

from closedform.lower.build import Builder
from closedform.lower.graph import Graph
from closedform.lower.ranges import Ranges, UnboundedError
from closedform.model.functions import real

x, y, length = real("x"), real("y"), real("length", nonnegative=True)
norm = sp.sqrt(x**2 + y**2)
clamped = sp.sqrt(sp.Max(0, x - y, evaluate=False))
free, upper, quarter = sp.atan2(y, x), sp.atan2(norm, x), sp.atan2(norm, norm + length)
flag = sp.Symbol("flag")
ANGLES = {
    "atan2": (free, "wrap_cut"),
    "of the upper half plane": (upper, None),
    "its negative": (-upper, "wrap_cut"),
    "twice the first quadrant": (2 * quarter, None),
    "twice": (2 * upper, "wrap"),
    "the negative of twice": (-2 * upper, "wrap"),
    "a sum": (free + 2 * quarter, "wrap"),
    "a difference": (free - 2 * quarter, "wrap"),
    "of two halves": (upper - 2 * quarter, "wrap_cut"),
    "beside zero": (sp.Piecewise((0, flag), (upper, True)), None),
    "with a right angle": (upper + sp.pi / 2, "wrap"),
    "of a maximum, which may be either zero": (sp.atan2(clamped, x), "wrap_cut"),
    "of a difference": (sp.atan2(norm - length, x), "wrap_cut"),
    "of a root that may be a negative zero": (sp.atan2(sp.sqrt(length), x), "wrap_cut"),
    "of a square": (sp.atan2(x**2, y), None),
    "times a sign": (sp.Piecewise((1, x >= 0), (-1, True)) * upper, "wrap_cut"),
    "more than a turn": (3 * upper, "wrap"),
    "with a constant": (quarter + sp.atan(32) - sp.pi / 2, None),
    "with a constant that may lead beyond": (upper + sp.atan(32), "wrap"),
}


def lowered(angle: sp.Expr):
    graph = Graph()
    build = Builder(graph, {s: graph.input(s.name) for s in (x, y, length, flag)}, {})
    return graph, build(angle)


@pytest.mark.parametrize("name", ANGLES)
def test_the_cheapest_wrap_that_does(name: str) -> None:
    angle, wrap = ANGLES[name]
    graph, node = lowered(angle)
    wrapped = Ranges(["length"]).wrapped(graph, node)
    assert wrapped.op == wrap if wrap else wrapped is node


@pytest.mark.parametrize("unknown", [x, x + free, y * free, sp.sin(free)])
def test_no_range_is_made_up(unknown: sp.Expr) -> None:
    graph, node = lowered(unknown)
    with pytest.raises(UnboundedError):
        Ranges().wrapped(graph, node)


@pytest.mark.parametrize("name", [n for n in ANGLES if n != "beside zero"])
def test_values_lie_in_the_range(name: str) -> None:
    """At random points, and with coordinates that are zeros of either sign."""
    angle, _ = ANGLES[name]
    found = Ranges(["length"]).of(lowered(angle)[1])
    assert found is not None
    values = [0.0, -0.0, 1.0, -1.0, *np.random.default_rng(0).uniform(-2, 2, 12)]
    points = np.array([(a, b, abs(c)) for a in values for b in values for c in (0.0, 0.5)]).T
    points = np.hstack([points, [[-1.0], [0.0], [-0.0]]])
    function = sp.lambdify((x, y, length), angle, [{"amax": np.maximum.reduce}, "numpy"])
    with np.errstate(invalid="ignore"):
        result = function(*points)
    low, high = (float(bound) * math.pi for bound in found)
    assert np.nanmin(result) >= low and np.nanmax(result) <= high


@pytest.mark.parametrize(("name", "turns"), [("wrap", 4), ("wrap_cut", 0.5)])
def test_wraps_of_numpy(name: str, turns: float) -> None:
    ends = np.arange(-8, 9) * np.pi
    angles = np.concatenate([ends, np.nextafter(ends, 99), np.nextafter(ends, -99)])
    angles = np.concatenate([angles, np.random.default_rng(1).uniform(-25, 25, 2000)])
    angles = angles[np.abs(angles) <= turns * 2 * np.pi]
    wrapped = getattr(_runtime, name)(angles)
    assert wrapped.dtype == np.float64
    assert wrapped.max() <= np.pi and wrapped.min() > -np.pi
    np.testing.assert_array_equal(wrapped[inside := np.abs(angles) < np.pi], angles[inside])
    whole = (angles - wrapped) / (2 * np.pi)
    assert np.abs(whole - np.round(whole)).max() < 1e-15 * max(1, turns)
    one_by_one = [getattr(_runtime, name)(angle) for angle in angles]
    np.testing.assert_array_equal(one_by_one, wrapped)


def test_principal_values_of_numpy() -> None:
    angles = np.concatenate([[0.0, 3, -3, 1e22, np.nan, np.inf], np.linspace(-3.9e5, 9e5, 999)])
    with np.errstate(invalid="ignore"):
        turned = _runtime.principal(angles)
        np.testing.assert_allclose(np.sin(turned), np.sin(angles), rtol=0, atol=4e-16)
        np.testing.assert_allclose(np.cos(turned), np.cos(angles), rtol=0, atol=4e-16)
    assert np.nanmax(np.abs(turned)) < 3.15
    np.testing.assert_array_equal(turned[:3], angles[:3])


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(("robot", "n"), [("planar_2r", 2), ("hybrid_five_bar", 3), ("irb260", 6)])
def test_zero_lengths_of_either_sign(backend: str, robot: str, n: int) -> None:
    module = importlib.import_module(f"closedform.generated.{backend}.{robot}")
    targets = np.random.default_rng(2).choice([0.0, -0.0, 1.0, -1.0], (200, len(module.TASK)))
    for zeros in ([0.0] * n, [-0.0] * n, [-0.0] * (n - 1) + [1.0], [1.0] * (n - 1) + [-0.0]):
        q, _ = module.ik(targets, tuple(zeros))
        angles = q[np.isfinite(q)]
        assert (angles <= np.pi).all() and (angles > -np.pi).all()
