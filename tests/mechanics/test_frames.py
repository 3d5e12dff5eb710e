"""Angles of parallel axes are added: by examples, and by values."""

import random

import pytest
import sympy as sp
from sympy import cos, sin, sqrt

from closedform.mechanics.frames import frame_along, merge_angles, plane_angle

a, b, c, x, y = sp.symbols("a b c x y", real=True)
MERGED = {
    cos(a) * cos(b) - sin(a) * sin(b): cos(a + b),
    x * sin(a) * cos(b) - x * cos(a) * sin(b) + y: x * sin(a - b) + y,
    cos(a) ** 2 * cos(b) ** 2
    - 2 * cos(a) * cos(b) * sin(a) * sin(b)
    + sin(a) ** 2 * sin(b) ** 2: cos(a + b) ** 2,
    x * cos(a) ** 2 * cos(b) - x * cos(a) * sin(a) * sin(b): x * cos(a) * cos(a + b),
    (cos(a) * cos(b) - sin(a) * sin(b)) * cos(c)
    - (sin(a) * cos(b) + cos(a) * sin(b)) * sin(c): cos(a + b + c),
}
KEPT = [
    x * cos(a) * cos(b),
    cos(a) + cos(b),
    cos(a) * cos(b) * cos(c) + x,
    x / (cos(a) * cos(b)),
    sqrt(x + cos(a) * cos(b)),
    cos(a) / cos(b) + sin(a) ** 3,
]


@pytest.mark.parametrize("expr", MERGED, ids=str)
def test_merged(expr: sp.Expr) -> None:
    assert merge_angles(expr) == MERGED[expr]


@pytest.mark.parametrize("expr", KEPT, ids=str)
def test_kept(expr: sp.Expr) -> None:
    assert merge_angles(expr) == expr


@pytest.mark.parametrize("seed", range(8))
def test_values_stay_the_same(seed: int) -> None:
    """Of sums of products with powers, roots and denominators that hold both angles."""
    choose = random.Random(seed)
    factors = [
        *(f(angle) ** n for f in (sin, cos) for angle in (a, b) for n in (1, 2, 3)),
        sqrt(2 + cos(a) * cos(b)), 1 / (3 + sin(a) * sin(b)), 1 / cos(a), x,
    ]  # fmt: skip
    expr = sum(choose.choice((1, -1)) * sp.Mul(*choose.sample(factors, 4)) for _ in range(6))
    at = {a: 0.3, b: -1.1, x: 2.7}
    assert float(merge_angles(expr).subs(at)) == pytest.approx(float(expr.subs(at)), abs=1e-12)


@pytest.mark.parametrize("angle", [a, -a, a - b, sp.pi / 4 - a, sp.pi, 2 * a])
def test_an_angle_is_read_from_its_sine_and_cosine(angle: sp.Expr) -> None:
    found = plane_angle(sp.expand_trig(cos(angle)), sp.expand_trig(sin(angle)))
    assert sp.expand(found - angle) == 0


def test_other_directions_keep_their_arctangent() -> None:
    assert plane_angle(x, sqrt(1 - x**2)).has(sp.atan2)


@pytest.mark.parametrize(
    "angles", [(sp.pi / 12, 0), (5 * sp.pi / 12, sp.pi / 2), (sp.pi / 4, sp.pi / 3)]
)
def test_a_frame_along_an_axis_has_no_roots_in_denominators(angles: tuple) -> None:
    """They stood in each product of frames of arms with joints at 15 degrees, such as the iCub."""
    tilt, around = angles
    w = sp.Matrix([sin(tilt) * cos(around), sin(tilt) * sin(around), cos(tilt)])
    R = frame_along(w)
    assert (R.T * R).applyfunc(sp.expand) == sp.eye(3) and R[:, 2] == w
    assert sp.expand(R.det()) == 1
    assert all(r.exp == sp.S.Half for e in R for r in e.atoms(sp.Pow))
