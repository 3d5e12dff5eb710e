"""The claims about the H6AR: their verdicts, and the checks that they needed."""

import claimed
import numpy as np
import pytest
import sympy as sp
from claimed import claims, result
from sympy import Piecewise, acos, asin, cos, sin

from closedform import (
    Equal,
    ForAll,
    Identity,
    Notation,
    Postures,
    Procedure,
    real,
)
from closedform.algebra.normal_form import Undecided
from closedform.model.claims import (
    APPROXIMATION,
    HOLDS,
    INCOMPLETE,
    INCONSISTENT,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    Gravity,
)
from closedform.proof.claims import judged

k, t, u = real("k"), real("t"), real("u")


@pytest.mark.parametrize(
    ("label", "verdict", "erratum"),
    [
        ("waist angle", INCOMPLETE, "waist-rear"),
        ("elbow of the right arm", INCOMPLETE, "one-elbow"),
        ("second equation before (14)", REFUTED, "sign-before-14"),
        ("eq. (3)", INCONSISTENT, "roll-sign"),
        ("use of (3) and (4)", INCONSISTENT, "yaw-roll-axes"),
        ("eq. (8)", REFUTED, "roll-in-wrist"),
        ("any roll", REFUTED, "roll-in-wrist"),
        ("eq. (7c)", APPROXIMATION, "averages"),
        ("six freedoms by Grübler", PROVED_UNDER, "gear-pair"),
        ("unique angles", PROVED, ""),
        ("eq. (12)", PROVED, ""),
    ],
)
def test_verdicts(label: str, verdict: str, erratum: str) -> None:
    found = result("h6ar", label)
    assert (found.kind, found.erratum) == (verdict, erratum)


def half_line(psi: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Half the distance of the tips for d = 1: the y axis after yaw and roll, by complex numbers.

    Its part across the mid-plane is 1.
    """
    yawed = np.exp(1j * (np.pi / 2 + psi))  # in the plane of the fore-arm's axis and y
    return 1 / (yawed.imag * np.exp(1j * phi).real)


@pytest.mark.parametrize(("roll", "enough"), [(False, False), (True, True)])
def test_the_length_of_the_wrist_links_by_numbers(roll: bool, enough: bool) -> None:
    """Links as short as the printed (10) reach for yaw alone; with roll, the corrected one does."""
    rng = np.random.default_rng(2)
    limit, beta = rng.uniform(0.1, 1.2, (2, 20_000))
    psi, phi = limit * rng.uniform(-1, 1, (2, 20_000))
    gears = rng.uniform(0, 1, 20_000)
    line = half_line(psi, phi * roll)
    printed = (1 - gears * np.cos(limit)) / (np.cos(limit) * np.cos(beta))
    corrected = (1 - gears * np.cos(limit) ** 2) / (np.cos(limit) ** 2 * np.cos(beta))
    assert (line - gears < (corrected if enough else printed)).all()
    if roll:
        assert (line - gears > printed).any()


def test_the_gravest_errors_come_first() -> None:
    """First what misses every target of a kind, then what is off by a distance."""
    grave = [e.key for e in claimed.derivation("h6ar").errata if e.gravity is Gravity.MOTION]
    assert grave == [
        "waist-rear", "quadrant", "roll-sign", "yaw-roll-axes", "roll-in-wrist", "averages",
    ]  # fmt: skip


def test_the_waist_formula_gives_no_posture_with_the_target_in_front() -> None:
    evidence = result("h6ar", "waist angle").evidence
    assert "target in front: 100.0 %" in evidence
    assert "target behind: 0.0 %" in evidence


@pytest.mark.parametrize(
    ("label", "printed", "misprint"),
    [
        ("eq. (1a)", "s_1 d +", "s_1 d -"),
        ("eq. (11)", "-s_1", "s_1"),
        ("eq. (12)", r"\kappa < 0", r"\kappa > 0"),
        ("domain of eq. (13)", "90", "91"),
        ("Table 1", "= 12", "= 11"),
    ],
)
def test_a_misprint_is_noticed(label: str, printed: str, misprint: str) -> None:
    claim = claims("h6ar")[label]
    assert printed in claim.printed
    try:
        kind = judged(claim, claim.printed.replace(printed, misprint)).kind
    except Undecided:
        return
    assert kind not in HOLDS


def test_the_whole_inverse_is_mended_in_all_its_parts() -> None:
    found = result("h6ar", "inverse of the virtual arm")
    assert (found.kind, found.erratum) == (REFUTED, "quadrant")
    assert r"from $-180^\circ$ to $180^\circ$" in found.evidence
    claim = claims("h6ar")["inverse of the virtual arm"]
    assert judged(claim, claim.corrected).kind == PROVED
    sign = claim.corrected.replace(r"\pm", "+", 1)
    assert judged(claim, sign).kind == INCOMPLETE  # it loses the other waist


def test_cases_hold_under_their_conditions_and_leave_no_gap() -> None:
    names = Notation({"k": k})
    size = r"\begin{cases} k & \text{if } k \ge 0, \\ -k & \text{if } k < 0 \end{cases}"
    (right,) = names.read(rf"\sqrt{{k^2}} = {size}")
    assert Equal(right).judge().kind == PROVED
    (wrong,) = names.read(rf"\sqrt{{k^2}} = {size.replace('-k', '2k')}")
    assert Equal(wrong).judge().kind == REFUTED
    (gap,) = names.read(rf"\sqrt{{k^2}} = {size.replace('k < 0', 'k < -1')}")
    assert Equal(gap).judge().kind == REFUTED


def test_several_symbols_that_tend_to_zero_together() -> None:
    verdict = Identity(cos(t) * cos(u), sp.S.One, small=(t, u)).judge()
    assert verdict.kind == APPROXIMATION
    assert sp.expand(verdict.evidence[1] + (t**2 + u**2) / 2) == 0
    assert Identity(cos(t) * cos(u), sp.S.One + k, small=(t, u)).judge().kind == REFUTED


def test_an_inequality_with_an_angle_outside_a_cosine_too_is_refuted() -> None:
    assert ForAll(sp.Le(1 / cos(t), 1), where=[sp.Lt(sp.Abs(t), 1)]).judge().kind == REFUTED


def test_a_procedure_is_refuted_at_a_posture_that_it_misses() -> None:
    x, found = real("x"), real("found")
    postures = Postures({x: cos(t)}, (t,))
    verdict = Procedure({found: acos(x) + asin(x)}, {x: cos(found)}, postures).judge()
    assert verdict.kind == REFUTED
    (posture,) = [e for e in verdict.evidence if isinstance(e, dict)]
    assert cos(posture[t]) != 0


def test_a_procedure_misses_no_posture_of_its_own() -> None:
    x, y, found = real("x"), real("y"), real("found")
    postures = Postures({x: cos(t), y: sin(t)}, (t,))
    formula = Piecewise((acos(x), y >= 0), (-acos(x), True))
    procedure = Procedure({found: formula}, {x: cos(found), y: sin(found)}, postures)
    assert not procedure._missed(postures.arrays()).any()
    assert not procedure._missed_simple()
