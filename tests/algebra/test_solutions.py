"""Counts of solutions that are known by geometry or by elementary algebra."""

from __future__ import annotations

from dataclasses import replace

import pytest
import sympy as sp
from sympy import cos, sin

from closedform.algebra.certificates import Record, recording
from closedform.algebra.normal_form import is_zero
from closedform.algebra.solutions import (
    InfinitelyManyError,
    Method,
    count_solutions,
    rotation_parametrisation,
)

x, y, z, u, v = sp.symbols("x y z u v", real=True)
t1, t2, t3 = sp.symbols("theta1:4", real=True)
l1, l2, l3 = sp.symbols("l1:4", positive=True)

PLANAR_2R = [l1 * cos(t1) + l2 * cos(t1 + t2) - x, l1 * sin(t1) + l2 * sin(t1 + t2) - y]
METHODS: list[Method] = ["generic", "specialised"]


@pytest.mark.parametrize("method", METHODS)
def test_planar_2r_has_two(method: Method) -> None:
    result = count_solutions(PLANAR_2R, [t1, t2], method=method)
    assert (int(result), result.distinct, result.method) == (2, True, method)
    assert len(result.points) == (3 if method == "specialised" else 0)


def test_expanded_equations_count_the_same() -> None:
    assert count_solutions([sp.expand_trig(e) for e in PLANAR_2R], [t1, t2]).count == 2


def test_zyz_wrist_has_two() -> None:
    R = sp.rot_axis3(-t1) * sp.rot_axis2(-t2) * sp.rot_axis3(-t3)
    targets = sp.Matrix(3, 3, sp.symbols("r1:10"))
    substitution = dict(zip(targets, rotation_parametrisation(), strict=True))
    result = count_solutions(R - targets, [t1, t2, t3], target_substitution=substitution)
    assert result.count == 2 and result.distinct and result.method == "generic"
    assert count_solutions(R - targets, [t1, t2, t3]).count == 0, "independent entries: none"


def test_planar_3r_with_orientation_has_two() -> None:
    phi = sp.Symbol("phi", real=True)
    total = t1 + t2 + t3
    equations = [
        l1 * cos(t1) + l2 * cos(t1 + t2) + l3 * cos(total) - x,
        l1 * sin(t1) + l2 * sin(t1 + t2) + l3 * sin(total) - y,
        cos(total) - cos(phi),
        sin(total) - sin(phi),
    ]
    assert count_solutions(equations, [t1, t2, t3]).count == 2


@pytest.mark.parametrize("method", METHODS)
def test_puma_position_has_four(method: Method) -> None:
    a2, a3, d3, d4 = sp.symbols("a2 a3 d3 d4")
    reach = a2 * cos(t2) + a3 * cos(t2 + t3) - d4 * sin(t2 + t3)
    equations = [
        cos(t1) * reach - d3 * sin(t1) - x,
        sin(t1) * reach + d3 * cos(t1) - y,
        -a2 * sin(t2) - a3 * sin(t2 + t3) - d4 * cos(t2 + t3) - z,
    ]
    assert count_solutions(equations, [t1, t2, t3], method=method).count == 4


@pytest.mark.parametrize(
    ("equations", "unknowns", "saturate", "count", "distinct"),
    [
        ([u**2 - x], [u], [], 2, True),
        ([u**2 - 2 * u + 1], [u], [], 2, False),
        ([(u - 1) * (u - 2)], [u], [u - 1], 1, True),
        ([(u - 1) ** 2 * (u - x)], [u], [], 3, False),
        ([(u**2 - 1) / (u - 1)], [u], [], 1, True),
        ([1 / u - x], [u], [], 1, True),
        ([u**2 + v**2 - x, u * v - y], [u, v], [], 4, True),
        ([u - 1, u - 2], [u], [], 0, True),
        ([cos(t1) - x], [t1], [], 2, True),
        ([cos(t1) - x, sin(t1) - y], [t1], [], 0, True),
        ([x * cos(t1) + y * sin(t1) - z], [t1], [], 2, True),
        ([cos(2 * t1) - x], [t1], [], 4, True),
        ([sp.tan(t1) - x], [t1], [], 2, True),
        ([u - cos(t1), t1 * 0 + sin(t1) - x], [t1, u], [], 2, True),
    ],
)
def test_small_systems(
    equations: list[sp.Expr],
    unknowns: list[sp.Symbol],
    saturate: list[sp.Expr],
    count: int,
    distinct: bool,
) -> None:
    result = count_solutions(equations, unknowns, saturate=saturate)
    assert (result.count, result.distinct) == (count, distinct)


def test_a_continuum_is_an_error() -> None:
    with pytest.raises(InfinitelyManyError):
        count_solutions(PLANAR_2R[:1], [t1, t2])
    with pytest.raises(InfinitelyManyError, match="theta3"):
        count_solutions(PLANAR_2R, [t1, t2, t3])
    with pytest.raises(InfinitelyManyError):
        count_solutions([(u - v) * u, (u - v) * v], [u, v])
    lines_and_a_point = [(u - v) * u, (u - v) * (v - 1)]
    assert count_solutions(lines_and_a_point, [u, v], saturate=[u - v]).count == 1


def test_out_of_scope_is_said() -> None:
    with pytest.raises(ValueError, match="use this fraction as the unknown"):
        count_solutions([cos(t1 / 2) - x], [t1])
    with pytest.raises(ValueError, match="not rational"):
        count_solutions([sp.sqrt(u) - x], [u])


def test_parametrised_rotation_is_a_rotation() -> None:
    R = rotation_parametrisation()
    assert is_zero(R.T * R - sp.eye(3)) and is_zero(R.det() - 1)
    assert len(R.free_symbols) == 3


@pytest.mark.parametrize(
    ("equations", "unknowns", "count", "distinct"),
    [
        (PLANAR_2R, [t1, t2], 2, True),
        ([x**2 - 2 * l1 * x + l1**2], [x], 2, False),
        ([x**2 - l1, y**3 - l2 * x], [x, y], 6, True),
        ([l1 * sin(t1) + l2 * cos(t1) - l3, (y - l1) ** 2], [t1, y], 4, False),
    ],
)
def test_a_certified_count_is_the_same(equations, unknowns, count: int, distinct: bool) -> None:
    """Its basis tells, with numbers for the parameters, whether solutions coincide."""
    alone = count_solutions(equations, unknowns)
    with recording() as record:
        found = count_solutions(equations, unknowns)
    assert record.certificates[found.certificate]["count"] == count
    assert (found.count, found.distinct) == (alone.count, alone.distinct) == (count, distinct)


ROOTS = [
    ([sp.sqrt(2) * sin(t1) + sp.sqrt(3) * cos(t1) - x], [t1], 2, True),
    ([x**2 - 2 * sp.sqrt(2) * x + 2], [x], 2, False),
    ([x**2 - sp.sqrt(2 + sp.sqrt(2)) * x + u * sp.sqrt(2 - sp.sqrt(2)) + sp.sqrt(2)], [x], 2, True),
    ([x**3 - sp.sqrt(6) * x / sp.sqrt(2) - sp.cbrt(5) * u], [x], 3, True),
]


@pytest.mark.parametrize(("equations", "unknowns", "count", "distinct"), ROOTS)
def test_a_root_of_a_number_is_no_unknown(equations, unknowns, count: int, distinct: bool) -> None:
    """What its certificate counts for other signs of the roots is told apart."""
    with recording() as record:
        found = count_solutions(equations, unknowns)
    assert (found.count, found.distinct) == (count, distinct)
    assert found.conjugate % count == 0
    assert record.certificates[found.certificate]["count"] == count + found.conjugate
    assert count_solutions(equations, unknowns, method="specialised").count == count


def test_a_certificate_that_differs_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    counted = Record.count
    monkeypatch.setattr(
        Record, "count", lambda self, system: replace(counted(self, system), count=3)
    )
    with recording(), pytest.raises(RuntimeError, match="2 solutions are counted, but their"):
        count_solutions(PLANAR_2R, [t1, t2])
