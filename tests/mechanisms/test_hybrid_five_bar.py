"""The five-bar linkage by other routes: Newton's method, differences, random points, postures."""

import importlib
import itertools
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import comb
from types import ModuleType

import numpy as np
import pytest
import sympy as sp

from closedform.model.inverse import Link
from closedform.proof.inverse import prove_inverse
from closedform.proof.require import ProofError

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
DESIGNS = [(7, 8, 5), (0, 1, 1), (3, 1, 3), (1, 1, 2), (1, 1, 3), (0.2, 3, 1), (2.5, 1, 3)]
REGIMES = {
    "inner balls inside, overlapping": [(0.5, 3, 1), (1, 1, 3), (0, 2, 3)],
    "inner balls inside, apart": [(1, 1, 1.2), (7, 8, 5)],
    "inner balls cut, overlapping": [(3, 1, 3), (3, 4, 1)],
    "inner balls cut, apart": [(3, 1, 2), (3, 1.2, 2)],
    "inner balls out of reach": [(5, 1, 2), (3, 1, 1)],
    "no contact": [(6, 1, 2), (7, 1, 2)],
}


@pytest.fixture(params=("numpy", "c"))
def arm(request: pytest.FixtureRequest):
    return importlib.import_module(f"closedform.generated.{request.param}.hybrid_five_bar")


@pytest.fixture(scope="module")
def design() -> ModuleType:
    """Imported by the tests that use it, because SymPy derives it for seconds."""
    return importlib.import_module("closedform.derivations.hybrid_five_bar_design")


@cache
def points(arm, lengths, n: int = 4000) -> np.ndarray:
    """Random points of the workspace."""
    L0, L1, L2 = lengths
    rng = np.random.default_rng(0)
    found = np.empty((0, 3))
    for _ in range(20):  # of a workspace that is hard to hit there may be fewer
        p = rng.uniform(-1, 1, (10 * n, 3)) * (L1 + L2) + [0, L0 / 2, 0]
        found = np.concatenate([found, p[arm.workspace_contains(p, lengths)]])[:n]
        if len(found) == n:
            break
    found.flags.writeable = False
    return found


def bars(arm, q, lengths):
    """C and D, by rotations written out here."""
    c1, s1 = np.cos(q[..., 0]), np.sin(q[..., 0])
    ends = []
    for angle, pivot in ((q[..., 1], 0), (q[..., 2], lengths[0])):
        off, along = lengths[1] * np.sin(angle), pivot + lengths[1] * np.cos(angle)
        ends.append(np.stack([-off * c1, along, off * s1], axis=-1))
    return ends


def closure(arm, q, p, lengths) -> np.ndarray:
    """By how much bars and plane fail to fit, in lengths."""
    C, D = bars(arm, q, lengths)
    normal = np.stack([np.sin(q[..., 0]), 0 * q[..., 0], np.cos(q[..., 0])], axis=-1)
    return np.stack(
        [
            np.linalg.norm(p - C, axis=-1) - lengths[2],
            np.linalg.norm(p - D, axis=-1) - lengths[2],
            (normal * p).sum(axis=-1),
        ],
        axis=-1,
    )


@pytest.mark.parametrize("lengths", DESIGNS)
def test_all_working_modes_close_the_loop(arm, lengths) -> None:
    p = points(arm, lengths)
    q, status = arm.ik(p, lengths)
    CP, DP = (p[:, None] - end for end in bars(arm, q, lengths))
    sine = np.linalg.norm(np.cross(CP, DP), axis=-1) / lengths[2] ** 2
    np.testing.assert_array_equal(status, np.where(sine > 2.0**-10, OK, SINGULAR))
    assert np.abs(closure(arm, q, p[:, None], lengths)).max() < 1e-14 * sum(lengths)
    diagonal = arm.jacobian_serial(q, lengths)
    wanted = np.array(list(itertools.product((1, -1), repeat=3)))
    found, exists = arm.fk(q, lengths)
    assert arm.BRANCHES[1] == "plus_plus_minus"
    gaps = np.linalg.norm(found - p[:, None, None], axis=-1)
    mode = np.argmin(np.where(exists == OK, gaps, np.inf), axis=-1)
    regular = np.abs(arm.singularities(q, lengths))[..., 3].min(axis=-1) > 1e-3
    signs = np.sign(np.take_along_axis(diagonal, mode[..., None, None], 2)[..., 0, :])
    np.testing.assert_array_equal(signs[regular], np.broadcast_to(wanted, signs.shape)[regular])
    if lengths[0]:
        best = np.take_along_axis(gaps, mode[..., None], -1)[..., 0]
        assert best[regular].max() < 1e-12 * sum(lengths)
        apart = np.abs(q[:, :, None] - q[:, None]).max(axis=-1) + 9 * np.eye(8)
        assert np.median(apart.min(axis=(1, 2))) > 1e-2


@pytest.mark.parametrize("lengths", DESIGNS)
def test_forward_against_newton(arm, lengths) -> None:
    rng = np.random.default_rng(1)
    q = rng.uniform(-np.pi, np.pi, (400, 3))
    p, status = arm.fk(q, lengths)
    for i, mode in np.argwhere(status == OK):
        x = p[i, mode] + rng.uniform(-1e-3, 1e-3, 3)
        if np.abs(arm.singularities(q[i], lengths)[mode, 3]) < 0.1:
            continue
        C, D = bars(arm, q[i], lengths)
        normal = np.array([np.sin(q[i, 0]), 0, np.cos(q[i, 0])])
        for _ in range(6):
            F = [normal @ x, *(((x - e) @ (x - e) - lengths[2] ** 2) / 2 for e in (C, D))]
            x = x - np.linalg.solve(np.stack([normal, x - C, x - D]), F)
        np.testing.assert_allclose(p[i, mode], x, atol=1e-12 * sum(lengths))
    C, D = bars(arm, q, lengths)
    apart = np.linalg.norm(C - D, axis=-1)
    assert ((status == UNREACHABLE).all(axis=-1) == (apart > 2 * lengths[2])).all()
    assert np.isnan(p[status == UNREACHABLE]).all()


def test_passive_angles_lead_to_p(arm) -> None:
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (500, 3))
    p, status = arm.fk(q)
    angles = arm.passive_angles(q)
    assert angles.shape == (500, 2, 2)
    assert np.isnan(angles[status == UNREACHABLE]).all()
    for leg, (pivot, theta) in enumerate(((0, q[:, 1]), (7, q[:, 2]))):
        off = 8 * np.sin(theta)[:, None] + 5 * np.sin(angles[..., leg])
        along = pivot + 8 * np.cos(theta)[:, None] + 5 * np.cos(angles[..., leg])
        c1, s1 = np.cos(q[:, :1]), np.sin(q[:, :1])
        space = np.stack([-off * c1, along, off * s1], axis=-1)
        np.testing.assert_allclose(space[status == OK], p[status == OK], atol=1e-13)


def test_jacobians_by_differences(arm) -> None:
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (400, 3))
    h = 1e-6
    rates = [(arm.fk(q + e).p - arm.fk(q - e).p) / (2 * h) for e in h * np.eye(3)]
    J = arm.jacobian(q)
    assert J.shape == (400, 2, 3, 3)
    with np.errstate(invalid="ignore"):
        regular = np.abs(arm.singularities(q)[..., 3]) > 1
    np.testing.assert_allclose(J[regular], np.stack(rates, axis=-1)[regular], atol=1e-6)
    A, B = arm.jacobian_parallel(q)[regular], arm.jacobian_serial(q)[regular]
    np.testing.assert_allclose(A @ J[regular], B[:, None] * np.eye(3), atol=1e-12)
    np.testing.assert_allclose(arm.determinant(q)[regular], np.linalg.det(J[regular]), rtol=1e-9)
    np.testing.assert_allclose(arm.condition_number(q)[regular], np.linalg.cond(A), rtol=1e-9)
    missing = arm.fk(q).status == UNREACHABLE
    for name in ("jacobian", "jacobian_parallel", "jacobian_serial", "determinant"):
        assert np.isnan(getattr(arm, name)(q)[missing]).all(), name
    assert np.isnan(arm.singularities(q)[missing]).all()
    assert np.isnan(arm.condition_number(q)[missing]).all()


def test_singular_factors(arm) -> None:
    """Each factor vanishes if its bars are in line, and is far from zero elsewhere."""
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (500, 3))
    t4, t5 = np.moveaxis(arm.passive_angles(q), -1, 0)
    rho = 8 * np.sin(q[:, 1:2]) + 5 * np.sin(t4)
    sines = [np.sin(t4 - q[:, 1:2]) * 40, np.sin(t5 - q[:, 2:]) * 40, np.sin(t5 - t4) * 25]
    factors = arm.singularities(q)
    np.testing.assert_allclose(factors, np.stack([rho, *sines], axis=-1), atol=1e-12)
    assert len(arm.SINGULARITIES) == factors.shape[-1]


def test_forward_where_c_meets_d(arm) -> None:
    corner = np.arccos(7 / 16)
    q = np.array([0.4, corner, np.pi - corner])
    p, status = arm.fk(q)
    assert (status == SINGULAR).all()
    assert np.abs(closure(arm, q, p, (7, 8, 5))).max() < 1e-14
    np.testing.assert_allclose(arm.passive_angles(q)[:, 0], [np.pi / 2, -np.pi / 2], atol=1e-15)
    assert np.isinf(arm.condition_number(q)).all()
    assert (arm.singularities(q)[:, 3] == 0).all()
    near = arm.fk(q + np.array([0, 1e-9, 0]))
    assert (near.status == OK).all()
    folded = arm.fk([0.4, 1.0, 1.0], (0, 1, 1))
    assert (folded.status == SINGULAR).all()


def test_forward_where_the_bars_are_in_line(arm) -> None:
    angle = np.arccos((10 - 7) / 16)
    q = np.array([0.0, np.pi - angle, angle])
    for posture in (q, q + np.array([0.3, 0, 0])):
        p, status = arm.fk(posture)
        assert (status == OK).all()
        np.testing.assert_allclose(p[0], p[1], atol=1e-6)
        assert (arm.condition_number(posture) > 1e7).all()
    stretched = arm.condition_number([0.0, np.pi, 0.0], (0, 1, 1))
    assert np.isinf(stretched).all()
    assert (arm.fk([0.0, np.pi, 0.0]).status == UNREACHABLE).all()


@pytest.mark.parametrize("small", [0.0, 1e-16, 1e-13, 1e-9, 1e-6])
def test_inverse_on_the_axis(arm, small: float) -> None:
    p = np.array([small, 3.0, -small])
    q, status = arm.ik(p)
    assert (status == (SINGULAR if small < 1e-13 else OK)).all()
    assert np.abs(closure(arm, q, p, (7, 8, 5))).max() < 1e-13
    if small < 1e-13:
        np.testing.assert_array_equal(q[:, 0], 0)
        np.testing.assert_allclose(q[:4, 1:], q[4:, 1:], atol=1e-14)


@pytest.mark.parametrize("pivot", [0, 1])
def test_inverse_at_a_pivot(arm, pivot: int) -> None:
    lengths = (1.5, 2, 2)
    p = np.array([0.0, pivot * 1.5, 0.0])
    q, status = arm.ik(p, lengths)
    assert (status == SINGULAR).all()
    np.testing.assert_array_equal(q[:, 1 + pivot], 0)
    assert np.abs(closure(arm, q, p, lengths)).max() < 1e-14
    assert (arm.ik(p).status == UNREACHABLE).all()
    assert not arm.workspace_contains(p)
    both = arm.ik([0.0, 0.0, 0.0], (0, 2, 2))
    assert (both.status == SINGULAR).all() and (both.q == 0).all()


def test_inverse_on_the_boundary(arm) -> None:
    angle = np.linspace(0.6, 2.0, 500)
    turn = np.linspace(-3, 3, 500)
    for reach, outward in ((13.0, 1), (3.0, -1)):
        y, rho = reach * np.cos(angle), reach * np.sin(angle)
        p = np.stack([-rho * np.cos(turn), y, rho * np.sin(turn)], axis=-1)
        q, status = arm.ik(p)
        both = np.hypot(y - 7, rho)
        inner = (both < 12.9) & (both > 3.1)
        assert inner.any() and np.isin(status[inner], (OK, SINGULAR)).all()
        assert np.abs(closure(arm, q, p[:, None], (7, 8, 5))[inner]).max() < 1e-12 * 20
        np.testing.assert_allclose(q[inner, 0], q[inner, 2], atol=1e-6)
        beyond = p[inner] * (1 + outward * 1e-9)
        assert (arm.ik(beyond).status == UNREACHABLE).all()
        assert not arm.workspace_contains(beyond).any()


def test_statuses_of_bad_input(arm) -> None:
    for bad in (np.nan, np.inf):
        assert (arm.fk([bad, 0, 0]).status == INVALID).all()
        assert (arm.ik([bad, 0, 0]).status == INVALID).all()
        assert not arm.workspace_contains([bad, 0, 0])
    for lengths in ((-1, 2, 2), (1, -2, 2), (1, 2, np.nan)):
        assert (arm.ik([1.0, 1.0, 0.0], lengths).status == INVALID).all()
        assert (arm.fk([1.0, 1.0, 0.0], lengths).status == INVALID).all()
        assert np.isnan(arm.workspace_volume(lengths))
    still = arm.ik([0.0, 1.0, 2.0], (2, 0, np.sqrt(5)))
    assert (still.status == SINGULAR).all()
    assert np.abs(closure(arm, still.q, np.array([0.0, 1, 2]), (2, 0, np.sqrt(5)))).max() < 1e-14


def test_a_design_without_parallel_singularities(arm) -> None:
    """(3, 1, 3) has none; (1, 1, 2) and (7, 8, 5) meet the printed conditions and have some."""
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, (200_000, 3))
    assert np.nanmax(arm.condition_number(q, (3, 1, 3))) < 6
    assert np.nanmax(arm.condition_number(q, (1, 1, 2))) > 100
    assert np.nanmax(arm.condition_number(q)) > 100
    assert np.nanmin(arm.condition_number(q, (1, 1, 3))) > 1.7
    assert np.nanmin(arm.condition_number(q)) < 1.001


def test_condition_of_the_serial_matrix_is_the_same_in_all_modes(arm) -> None:
    p = points(arm, (7, 8, 5), 200)
    q, _ = arm.ik(p)
    found, status = arm.fk(q)
    gaps = np.where(status == OK, np.linalg.norm(found - p[:, None, None], axis=-1), np.inf)
    mode = gaps.argmin(axis=-1)
    B = np.take_along_axis(arm.jacobian_serial(q), mode[..., None, None], 2)[..., 0, :]
    sizes = np.abs(B)
    good = gaps.min(axis=-1).max(axis=-1) < 1e-9
    assert good.mean() > 0.9
    np.testing.assert_allclose(sizes[good], sizes[good][:, :1].repeat(8, 1), atol=1e-7)


def sampled(arm, lengths, n: int = 400_000) -> tuple[float, float]:
    """The volume by points in the box of one ball, and the standard error."""
    L0, L1, L2 = lengths
    reach = L1 + L2
    p = np.random.default_rng(6).uniform(-1, 1, (n, 3)) * reach
    inside = [(np.linalg.norm(p - [0, s, 0], axis=-1)) for s in (0, L0)]
    hit = np.logical_and.reduce([(r <= reach) & (r >= abs(L1 - L2)) for r in inside]).mean()
    box = (2 * reach) ** 3
    return hit * box, box * np.sqrt(hit * (1 - hit) / n)


@pytest.mark.parametrize("lengths", [*DESIGNS, *itertools.chain(*REGIMES.values())])
def test_volume_by_random_points(arm, lengths) -> None:
    volume, error = sampled(arm, lengths)
    assert abs(arm.workspace_volume(lengths) - volume) <= 4 * error + 1e-12


def revolved(lengths) -> float:
    """The volume by Gauss's rule, exact between the breaks of a piecewise quadratic section."""
    L0, L1, L2 = lengths
    R, r = L1 + L2, abs(L1 - L2)
    breaks = {s * a + b for s in (1, -1) for a in (R, r) for b in (0, L0)} | {L0 / 2}
    if L0:
        breaks |= {(L0**2 + s * (R**2 - r**2)) / (2 * L0) for s in (1, -1)}
    nodes, weights = np.polynomial.legendre.leggauss(4)
    total = 0.0
    for a, b in itertools.pairwise(sorted(breaks)):
        y = (a + b) / 2 + (b - a) / 2 * nodes
        squares = y**2, (y - L0) ** 2
        outer = R**2 - np.maximum(*squares)
        inner = np.maximum(r**2 - np.minimum(*squares), 0)
        total += np.pi * (b - a) / 2 * (weights * np.maximum(outer - inner, 0)).sum()
    return total


def test_volume_by_quadrature_in_and_around_all_seams(arm) -> None:
    cases = [tuple(row) for row in np.random.default_rng(9).uniform(0, 3, (500, 3))]
    for M, m in ((1, 1), (2, 1), (3, 1), (1.5, 1), (1, 0), (2.5, 2), (1, 1e-8), (1, 1 - 1e-6)):
        seams = (0, 2 * (M - m), 2 * m, 2 * M, 2 * (M + m))
        for at, step in itertools.product(seams, (0, 1e-12, -1e-12, 1e-6, -1e-6, 1e-2, -1e-2)):
            cases += [(at + step, M, m), (at + step, m, M)] if at + step >= 0 else []
    cases += itertools.product((0, 1, 2, 3, 4, 5), (0, 1, 2), (0, 1, 2))
    found = np.array([arm.workspace_volume(lengths) for lengths in cases])
    wanted = np.array([revolved(lengths) for lengths in cases])
    size = np.array([(L1 + L2) ** 3 for _, L1, L2 in cases])
    assert (found >= 0).all()
    assert (np.abs(found - wanted) <= 1e-13 * size).all()


ZEROS = [z for z in itertools.product((0, 1.5), (0, 1), (0, 1, 2)) if 0 in z]


@pytest.mark.parametrize("lengths", ZEROS)
def test_lengths_of_zero(arm, lengths) -> None:
    """The inverse closes the loop wherever P is reached, and fk knows when it cannot."""
    L0, L1, L2 = lengths
    y = np.linspace(-1, L0 + 1, 41)[:, None]
    rho = np.array([0, L1 + L2, abs(L1 - L2), 0.3, np.sqrt(max((L1 + L2) ** 2 - L0**2 / 4, 0))])
    p = np.stack(np.broadcast_arrays(-0.6 * rho, y, 0.8 * rho), axis=-1).reshape(-1, 3)
    p = np.concatenate([p, [[0, s, 0] for s in (0, L0, L1 + L2, L0 / 2)]])
    reach = np.stack([np.linalg.norm(p - [0, s, 0], axis=-1) for s in (0, L0)])
    inside = ((reach <= L1 + L2 + 1e-14) & (reach >= abs(L1 - L2) - 1e-14)).all(axis=0)
    np.testing.assert_array_equal(arm.workspace_contains(p, lengths), inside)
    q, status = arm.ik(p, lengths)
    np.testing.assert_array_equal(np.isin(status, (OK, SINGULAR)).all(axis=-1), inside)
    assert (status[~inside] == UNREACHABLE).all()
    assert np.abs(closure(arm, q, p[:, None], lengths))[inside].max(initial=0) < 1e-14
    if L1 == 0:
        assert (status[inside] == SINGULAR).all()

    q = np.random.default_rng(10).uniform(-np.pi, np.pi, (200, 3))
    positions, status = arm.fk(q, lengths)
    C, D = bars(arm, q, lengths)
    apart = np.linalg.norm(C - D, axis=-1)
    wanted = np.where(apart > 2 * L2, UNREACHABLE, np.where(apart == 0, SINGULAR, OK))
    np.testing.assert_array_equal(status, wanted[:, None].repeat(2, 1))
    exists = status != UNREACHABLE
    gaps = closure(arm, q[:, None], positions, lengths)[exists]
    assert np.abs(gaps).max(initial=0) < 1e-13
    kappa, factors = arm.condition_number(q, lengths), arm.singularities(q, lengths)
    assert np.isinf(kappa[status == SINGULAR]).all(), "A vanishes, or C = D"
    if L1 == 0:
        assert (factors[exists][:, 1:3] == 0).all()
    if L2 == 0:
        assert (factors[exists][:, 3] == 0).all()


def test_boundary_of_the_workspace_from_both_sides(arm) -> None:
    rng = np.random.default_rng(11)
    for lengths in DESIGNS:
        L0, L1, L2 = lengths
        reach, hole = L1 + L2, abs(L1 - L2)
        u = rng.normal(size=(400, 3))
        u /= np.linalg.norm(u, axis=-1, keepdims=True)
        for pivot, radius, sign in itertools.product((0, L0), (reach, hole), (1, -1)):
            for step in (1e-11, 1e-9, 1e-6, 1e-3):
                p = u * (radius + sign * step * reach) + [0, pivot, 0]
                r = np.stack([np.linalg.norm(p - [0, s, 0], axis=-1) for s in (0, L0)])
                clear = np.minimum(reach - r, r - hole).min(axis=0)
                sure = np.abs(clear) > 2e-12 * reach
                inside = arm.workspace_contains(p, lengths)
                np.testing.assert_array_equal(inside[sure], clear[sure] > 0)
                q, status = arm.ik(p, lengths)
                np.testing.assert_array_equal(np.isin(status, (OK, SINGULAR)).all(axis=-1), inside)
                gaps = closure(arm, q, p[:, None], lengths)[inside]
                assert np.abs(gaps).max(initial=0) < 1e-12 * sum(lengths)


def test_lengths_as_arrays(arm) -> None:
    q = np.random.default_rng(12).uniform(-np.pi, np.pi, (5, 1, 3))
    L1 = np.array([8.0, 2.0, -1.0, np.nan])
    for name in arm.__all__:
        function = getattr(arm, name)
        if name == "workspace_volume":
            assert function(arm.Parameters(np.ones((3, 1)), L1, 5.0)).shape == (3, 4)
        elif name.islower():
            many = function(q, arm.Parameters(7.0, L1, 5.0))
            for k, length in enumerate(L1):
                one = function(q[:, 0], (7.0, length, 5.0))
                parts = zip(many, one, strict=True) if isinstance(one, tuple) else [(many, one)]
                for a, b in parts:
                    np.testing.assert_allclose(a[:, k], b, rtol=1e-12, atol=1e-12, err_msg=name)


def test_every_regime_is_tried(design) -> None:
    found = design.regimes()
    assert found.keys() == REGIMES.keys()
    for name, cases in REGIMES.items():
        for L0, L1, L2 in cases:
            at = {design.L0: L0, design.M: max(L1, L2), design.m: min(L1, L2)}
            assert found[name].start.subs(at) <= L0 + 1e-12
            end = found[name].end
            assert end.subs(at) >= L0 - 1e-12


def test_volume_is_continuous_and_falls(arm) -> None:
    for L1, L2 in ((1, 1), (1, 2), (1, 3), (2.5, 1), (8, 5), (0, 1)):
        L0 = np.linspace(0, 2.2 * (L1 + L2), 5001)
        volume = arm.workspace_volume(arm.Parameters(L0, L1, L2))
        assert (np.diff(volume) <= 1e-12).all()
        slope = 4 * np.pi * (L1 + L2) ** 2
        assert (np.abs(np.diff(volume)) <= slope * (L0[1] - L0[0])).all()
        assert volume[-1] == 0
    whole = arm.workspace_volume((0, 1, 1))
    np.testing.assert_allclose(whole, 4 / 3 * np.pi * 8)
    assert arm.workspace_volume((0, 0, 0)) == 0
    assert arm.workspace_volume((0, 0, 2)) == 0


@pytest.mark.parametrize("kappa", [1.0, 1.5, 4.0])
@pytest.mark.parametrize("mirrored", [1, -1])
def test_loci_hold_the_postures_they_describe(arm, design, kappa: float, mirrored: int) -> None:
    """Postures with a given angle between CP and DP, built bar by bar, satisfy the polynomial."""
    k = sp.nsimplify(kappa)
    found = design.locus(k**2 - 1, 2 * k * mirrored, k**2 + 1)
    assert found.degree == 6
    symbols = [*design.lengths, *design.plane]
    terms = [sp.lambdify(symbols, term) for term in found.curve.args]
    phi = np.random.default_rng(7).uniform(-np.pi, np.pi, 500)
    psi = 2 * np.arctan2(1, kappa) * mirrored
    CP, DP = (5 * np.exp(1j * a) for a in (phi, phi + psi))
    across = 7 + DP - CP
    half = np.abs(across) / 2
    meets = half < 8
    across, half, CP, DP = (v[meets] for v in (across, half, CP, DP))
    assert meets.sum() > 20
    P = CP + across / 2 + 1j * across / np.abs(across) * np.sqrt(64 - half**2)
    q = np.stack([0.3 + 0 * half, np.angle(P - CP), np.angle(P - 7 - DP)], axis=-1)
    mode = 0 if mirrored == 1 else 1
    p = arm.fk(q).p[:, mode]
    np.testing.assert_allclose(p[:, 1] + 1j * p[:, 2] / np.sin(0.3), P, atol=1e-12)
    np.testing.assert_allclose(arm.condition_number(q)[:, mode], kappa, rtol=1e-12)
    values = np.array([term(7, 8, 5, P.real, P.imag) + 0 * half for term in terms])
    assert (np.abs(values.sum(axis=0)) <= 1e-12 * np.abs(values).sum(axis=0)).all()
    off = np.array([term(7, 8, 5, P.real + 0.5, P.imag) + 0 * half for term in terms])
    assert np.median(np.abs(off.sum(axis=0)) / np.abs(off).sum(axis=0)) > 1e-6


def on_a_line(curve: sp.Poly, at: Fraction, slope: Fraction) -> list[float]:
    """The coefficients of the curve at (at + slope t, t), the highest power of t first."""
    found = [Fraction(0)] * (curve.total_degree() + 1)
    for (m, n), value in curve.terms():
        for k in range(m + 1):
            part = comb(m, k) * at ** (m - k) * slope**k
            found[k + n] += Fraction(int(value.p), int(value.q)) * part
    while found and not found[-1]:
        found.pop()
    return [float(x) for x in reversed(found)]


@pytest.mark.parametrize("psi", [0.0, np.pi, np.pi / 2, -np.pi / 2, 1.0, -2.0])
@pytest.mark.parametrize("lengths", [(7, 8, 5), (0, 3, 2), (3, 1, 3), (1, 1, 2)])
def test_real_points_of_the_loci_are_postures(design, lengths, psi: float) -> None:
    """On random lines: the real roots are postures, made by own circles, with CP turned by psi."""
    L0, L1, L2 = lengths
    curve = design.by_cramer(*map(sp.Rational, (np.cos(psi), np.sin(psi))))
    curve = sp.Poly(curve.subs(dict(zip(design.lengths, lengths, strict=True))), *design.plane)
    rng = np.random.default_rng(13)
    seen = 0
    for _ in range(25):
        at, slope = rng.uniform(-1, 1, 2) * (L1 + L2)
        polynomial = on_a_line(curve, Fraction(at), Fraction(slope))
        assert len(polynomial) <= 7
        roots = np.roots(polynomial)
        for rho in roots[np.abs(roots.imag) < 1e-9].real:
            P = at + slope * rho + 1j * rho
            ends = []
            for pivot in (0, L0):
                to_pivot = pivot - P
                along = (abs(to_pivot) ** 2 + L2**2 - L1**2) / (2 * abs(to_pivot))
                across = np.emath.sqrt(L2**2 - along**2)
                ends.append([to_pivot / abs(to_pivot) * (along + s * 1j * across) for s in (1, -1)])
            turned = np.exp(1j * psi) * np.array(ends[0])[:, None]
            assert np.abs(turned - np.array(ends[1])).min() < 1e-3 * L2, (P, ends)
            seen += 1
    apart = 2 * L2 * np.sin(abs(psi) / 2)
    possible = max(0, L0 - 2 * L1) <= apart <= L0 + 2 * L1
    if L0 or psi:  # else the curve is everywhere
        assert (seen > 0) == possible


def test_the_inverse_is_counted_step_by_step() -> None:
    d = importlib.import_module("closedform.derivations.hybrid_five_bar").d
    inverse = next(i for i in d.inverses if i.function == "ik")
    assert prove_inverse(d, inverse).method == "step by step"
    first, second, third = inverse.links
    both = Link(second.unknowns, (*first.equations, *second.equations))
    for links, message in (
        ((first, second), "every equation and every unknown exactly once"),
        ((first, replace(second, given={}), third), "an earlier equation"),
        ((second, first, third), "an unknown of a later link"),
        ((both, Link(first.unknowns, ()), third), "later link"),
    ):
        with pytest.raises(ProofError, match=message):
            prove_inverse(d, replace(inverse, links=links))
