"""Checks that find what a list of equations, cases or formulas leaves out."""

import pytest
import sympy as sp
from sympy import atan2, cos, sin

from closedform.algebra.normal_form import Undecided
from closedform.model.claims import INCOMPLETE, PROVED, REFUTED
from closedform.model.functions import real
from closedform.proof.checks.completeness import Cases, Listing, Replaces
from closedform.proof.checks.solutions import Solves

x, y, t = real("x"), real("y"), real("t")


class TestListing:
    @pytest.mark.parametrize(
        ("printed", "kind", "words"),
        [
            ([1, 2, 3], PROVED, "the small numbers"),
            ([3, 1], INCOMPLETE, ": it omits "),
            ([], INCOMPLETE, ": it omits "),
            ([1, 2, 3, 4], REFUTED, "not among "),
            ([1, 4], REFUTED, "not among "),
        ],
    )
    def test_verdicts(self, printed: list[int], kind: str, words: str) -> None:
        verdict = Listing(printed, lambda: (1, 2, 3), "the small numbers").judge()
        assert verdict.kind == kind
        assert words in "".join(map(str, verdict.evidence))

    def test_what_is_missing_is_shown_as_asked(self) -> None:
        verdict = Listing([x], lambda: [x, y], "names", lambda e: (sp.Eq(e, 0),)).judge()
        assert verdict.evidence[-1] == sp.Eq(y, 0)


class TestReplaces:
    """A point on the unit circle, given by its coordinates."""

    source = (cos(t) - x, sin(t) - y)
    posture = {x: cos(t), y: sin(t)}  # noqa: RUF012

    def judged(self, *equations: sp.Expr, given: dict[sp.Symbol, sp.Expr] | None = None):
        return Replaces(equations, self.source, (t,), self.posture, given).judge()

    def test_the_equations_themselves(self) -> None:
        unit = {x: sp.Rational(3, 5), y: sp.Rational(4, 5)}
        assert self.judged(*reversed(self.source), given=unit).kind == PROVED

    def test_the_tangent_loses_the_quadrant(self) -> None:
        unit = {x: sp.Rational(3, 5), y: sp.Rational(4, 5)}
        verdict = self.judged(sin(t) / cos(t) - y / x, given=unit)
        assert verdict.kind == INCOMPLETE
        assert verdict.evidence == (
            "they have 2 solutions, but the equations that they replace have 1 solution",
        )

    def test_nothing_determines_nothing(self) -> None:
        verdict = self.judged(sin(t) ** 2 + cos(t) ** 2 - 1, given={x: 1, y: 0})
        assert verdict.kind == INCOMPLETE
        assert "infinitely many solutions" in verdict.evidence[0]

    def test_an_equation_that_does_not_follow(self) -> None:
        verdict = self.judged(cos(t) - y)
        assert verdict.kind == REFUTED
        assert verdict.evidence[-1] == "equation 1 does not hold"


class TestCases:
    """The angle of a point; at the origin it is free."""

    points = ({x: 1, y: 2}, {x: 0, y: 0})

    def test_a_missing_case(self) -> None:
        verdict = Cases([(sp.Ne(y, 0), _right(atan2(y, x)))], self.points).judge()
        assert verdict.kind == INCOMPLETE
        assert verdict.evidence[-1] == {x: 0, y: 0}

    def test_all_cases(self) -> None:
        cases = [(sp.Ne(y, 0), _right(atan2(y, x))), (sp.Eq(y, 0), _right(atan2(y, x)))]
        assert Cases(cases, self.points).judge().kind == PROVED

    def test_a_wrong_case(self) -> None:
        cases = [(sp.Ne(y, 0), _right(atan2(y, x))), (sp.Eq(y, 0), _right(atan2(x, y)))]
        assert Cases(cases, self.points).judge().kind == REFUTED

    def test_a_wrong_case_counts_more_than_a_missing_one(self) -> None:
        cases = [(sp.Ne(y, 0), _right(atan2(x, y)))]
        assert Cases(cases, self.points).judge().kind == REFUTED

    def test_cases_that_nothing_proves_to_be_all(self) -> None:
        cases = [(x + y > 1, _right(atan2(y, x))), (x + y < 1, _right(atan2(y, x)))]
        with pytest.raises(Undecided, match="cover every posture"):
            Cases(cases, self.points).judge()


def _right(formula: sp.Expr) -> Solves:
    """Whether a formula gives the angle of a point on the unit circle."""
    u = real("u")
    circle = {x: (1 - u**2) / (1 + u**2), y: 2 * u / (1 + u**2)}
    return Solves({t: formula}, [cos(t) - x, sin(t) - y], given=circle)


def test_a_formula_without_a_value_is_refuted() -> None:
    verdict = Solves({t: atan2(x, x)}, [cos(t) - x], given={x: sp.Integer(0)}).judge()
    assert verdict.kind == REFUTED
    assert verdict.evidence[0] == "the formula has no value"
