"""Each check gives each of its verdicts and refuses what is not proved; verdicts on a paper."""

from dataclasses import replace

import pytest
import sympy as sp
from closedform.derivations import planar_2r, spherical_wrist
from sympy import cos, pi, sin, sqrt

from closedform.algebra.normal_form import Undecided
from closedform.model.derivation import Derivation
from closedform.model.functions import real
from closedform.proof.checks import (
    APPROXIMATION,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    Check,
    Count,
    Decimal,
    Deferred,
    Enumeration,
    Every,
    Holds,
    Identity,
    Posture,
    Refuted,
    Undecidable,
    Under,
    Verdict,
)

x, y, t = real("x"), real("y"), real("t")
r = real("r", positive=True)
TRUE = Identity(sin(x) ** 2 + cos(x) ** 2, sp.Integer(1))
FALSE = Identity(sin(x) + sin(y), sin(x + y))
ASSUMED = Identity(sqrt(x**2), x, nonnegative=(x,))
NEAR = Identity(sin(t), t, small=t)
OPEN = Undecidable("a figure")


class TestIdentity:
    @pytest.mark.parametrize(
        ("check", "kind"),
        [(TRUE, PROVED), (ASSUMED, PROVED_UNDER), (FALSE, REFUTED), (NEAR, APPROXIMATION)],
    )
    def test_verdicts(self, check: Check, kind: str) -> None:
        assert check.judge().kind == kind

    def test_assumption_is_printed(self) -> None:
        assert ASSUMED.judge().evidence == "where x >= 0"

    def test_without_its_assumption_it_is_refuted_at_a_negative_point(self) -> None:
        verdict = replace(ASSUMED, nonnegative=()).judge()
        assert verdict == Verdict(REFUTED, "at x = -1 the printed form is 1, not -1", "x")

    def test_counterexample_shows_both_sides(self) -> None:
        verdict = Identity(cos(x) + cos(y), cos(x + y)).judge()
        assert verdict.evidence == "at x = 0, y = 0 the printed form is 2, not 1"

    def test_long_values_are_shown_as_decimals(self) -> None:
        verdict = Identity(sqrt(sqrt(sqrt(2) + 1) + sqrt(3)), sp.Integer(2)).judge()
        assert verdict.evidence == "the printed form is 1.81268, not 2"

    def test_order_of_the_error(self) -> None:
        assert NEAR.judge().evidence.startswith("the error is -t**3/6 + O(t**4); e.g. at t = ")

    def test_an_error_that_does_not_vanish_is_no_approximation(self) -> None:
        assert Identity(cos(t), t, small=t).judge().kind == REFUTED

    def test_order_of_a_matrix_is_that_of_its_worst_entry(self) -> None:
        check = Identity(sp.Matrix([t, 1]), sp.Matrix([sin(t), cos(t)]), small=t)
        assert "the error is t**2/2 + O(t**3)" in check.judge().evidence

    def test_correction_is_the_derived_form_or_the_given_one(self) -> None:
        assert Identity(x, 2 * x).judge().corrected == "2 x"
        assert Identity(x, 2 * x * r / r, corrected=x + x).judge().corrected == "2 x"
        tan = Identity(cos(x), sp.tan(x), corrected=sin(x) / cos(x))
        assert tan.judge().corrected == sp.latex(sin(x) / cos(x))

    def test_wrong_correction_is_refused(self) -> None:
        with pytest.raises(ValueError, match="does not equal"):
            replace(FALSE, corrected=sin(x) * cos(y)).judge()

    def test_of_a_matrix_only_the_wrong_entries_are_corrected(self) -> None:
        verdict = Identity(sp.Matrix([[1, x], [y, 2 * y]]), sp.Matrix([[1, y], [y, x]])).judge()
        assert verdict.corrected == r"[1,2] = y,\ [2,2] = x"
        assert verdict.evidence.startswith("entry (1,2): at ")

    def test_sequences_are_compared_part_by_part(self) -> None:
        assert Identity([x, sin(x) ** 2], (x, 1 - cos(x) ** 2)).judge().kind == PROVED
        verdict = Identity([x, x], [x, -x]).judge()
        assert verdict.evidence == "part 2: at x = 1 the printed form is 1, not -1"
        assert verdict.corrected == r"x,\ - x"

    @pytest.mark.parametrize(
        ("printed", "derived"), [([x], [x, y]), (sp.eye(2), sp.eye(3)), (sp.eye(2), sp.Integer(1))]
    )
    def test_different_shapes_are_refused(self, printed: object, derived: object) -> None:
        with pytest.raises(ValueError):
            Identity(printed, derived).judge()

    def test_floats_are_refused(self) -> None:
        with pytest.raises(TypeError):
            Identity(x / 2, sp.Float("0.5") * x).judge()

    @pytest.mark.parametrize(
        ("printed", "derived", "evidence"),
        [
            (x + y, x + 2 * y, "at x = 0, y = 1 the printed form is 1, not 2"),
            (sqrt(x - 2) + y, sqrt(x - 2), "at x = 2, y = 1 the printed form is 1, not 0"),
            (1 / x + y, 1 / x + 2 * y, "at x = 1, y = 1 the printed form is 2, not 3"),
            (
                sp.Matrix([t, x + y]),
                sp.Matrix([t, x]),
                "entry (2,1): at x = 0, y = 1 the printed form is 1, not 0",
            ),
            ([x, sin(t) + x], (x, sin(t)), "part 2: at t = 0, x = 1 the printed form is 1, not 0"),
        ],
    )
    def test_symbols_that_cancel_have_a_value_at_the_counterexample(
        self, printed: object, derived: object, evidence: str
    ) -> None:
        verdict = Identity(printed, derived).judge()
        assert (verdict.kind, verdict.evidence) == (REFUTED, evidence)

    def test_symbols_of_an_assumption_and_of_an_approximation_cancel_too(self) -> None:
        verdict = Identity(x + y, x, nonnegative=(t - 3,)).judge()
        assert verdict.evidence == "at t = 3, x = 0, y = 1 the printed form is 1, not 0"
        verdict = Identity(x + sin(t), x + t, small=t).judge()
        assert verdict.kind == APPROXIMATION and "e.g. at t = pi/2, x = 0 " in verdict.evidence

    def test_what_can_be_neither_proved_nor_refuted_raises(self) -> None:
        with pytest.raises(Undecided):
            Identity(sqrt(3 + 2 * sqrt(2)), 1 + sqrt(2)).judge()  # true, but it cannot prove it


class TestDecimal:
    @pytest.mark.parametrize(
        ("printed", "exact"),
        [
            ("3.14", pi),
            ("3.142", pi),
            ("3.1416", pi),
            ("3", pi),
            ("-3.1416", -pi),
            ("0.00", sp.Rational(1, 1000)),
            ("-0.00", -sp.Rational(1, 1000)),
            ("1.10", sp.Rational(11, 10)),
            ("2", sqrt(2) * sqrt(2)),
            ("0.12", sp.Rational(1, 8)),
            ("0.13", sp.Rational(1, 8)),
            ("-0.13", -sp.Rational(1, 8)),
            ("0.5", (sqrt(3 + 2 * sqrt(2)) - sqrt(2)) / 2),
            ("0", (sqrt(3 + 2 * sqrt(2)) - sqrt(2)) / 2),
        ],
    )
    def test_proved(self, printed: str, exact: sp.Expr) -> None:
        assert Decimal(printed, exact).judge().kind == PROVED

    @pytest.mark.parametrize(
        ("printed", "exact", "how", "nearest"),
        [
            ("3.1415", pi, "truncated, not rounded", "3.1416"),
            ("-3.1415", -pi, "truncated, not rounded", "-3.1416"),
            ("3.1417", pi, "off by 1.07 units of the last place", "3.1416"),
            ("-3.1417", -pi, "off by 1.07 units of the last place", "-3.1416"),
            ("3.15", pi, "off by 0.84 units of the last place", "3.14"),
            ("3.13", pi, "off by 1.16 units of the last place", "3.14"),
            ("3.14", -pi, "off by 628.16 units of the last place", "-3.14"),
            ("0.11", sp.Rational(1, 8), "off by 1.50 units of the last place", "0.13"),
            ("-0.11", -sp.Rational(1, 8), "off by 1.50 units of the last place", "-0.13"),
            ("0.1", sp.Rational(1, 20) - sp.Rational(1, 10**9), "off by", "0.0"),
            ("7", sp.Rational(15, 2) + sp.Rational(1, 10**30), "truncated", "8"),
        ],
    )
    def test_refuted(self, printed: str, exact: sp.Expr, how: str, nearest: str) -> None:
        verdict = Decimal(printed, exact).judge()
        assert verdict.kind == REFUTED
        assert verdict.evidence.startswith(how)
        assert verdict.corrected == nearest

    def test_an_exact_value_is_a_constant(self) -> None:
        with pytest.raises(ValueError, match="2\\*x is not a constant: it depends on x"):
            Decimal("3.2", 2 * x).judge()

    def test_unit(self) -> None:
        verdict = Decimal("3.2", pi, "cm").judge()
        assert verdict.evidence.endswith("the exact value is 3.141593 cm")
        assert verdict.corrected == r"3.1\text{ cm}"


class TestPosture:
    target = (sp.Integer(0), sp.Integer(1))

    def test_proved(self) -> None:
        assert Posture((cos(x), sin(x)), {x: pi / 2}, self.target).judge().kind == PROVED

    def test_refuted_with_the_angles_that_were_meant(self) -> None:
        verdict = Posture((cos(x), sin(x)), {x: -pi / 2}, self.target, {x: pi / 2}).judge()
        assert verdict == Verdict(REFUTED, "they reach (0, -1), not (0, 1)", r"x = 90^\circ")

    def test_refuted_without_a_correction(self) -> None:
        assert Posture((cos(x), sin(x)), {x: pi}, self.target).judge().corrected == ""

    def test_lengths_without_a_value_get_one_where_it_is_refuted(self) -> None:
        verdict = Posture((r * cos(x), r * sin(x)), {x: pi}, (sp.Integer(0), r), {x: pi / 2})
        assert verdict.judge().evidence == "at r = 1 they reach (-1, 0), not (0, 1)"
        lost = Posture((y + cos(x), r), {x: pi}, (y, r)).judge()
        assert lost.evidence == "at r = 1, y = 0 they reach (-1, 1), not (0, 1)"

    def test_a_correction_may_depend_on_lengths(self) -> None:
        verdict = Posture((x,), {x: sp.Integer(0)}, (r,), {x: r}).judge()
        assert verdict.corrected == "x = r"

    def test_angle_that_is_no_fraction_of_a_turn(self) -> None:
        third = (sp.Rational(3, 5), sp.Rational(4, 5))
        meant = {x: sp.atan2(4, 3)}
        verdict = Posture((cos(x), sin(x)), {x: pi / 4}, third, meant).judge()
        assert verdict.corrected == r"x = 53.1301^\circ"

    def test_wrong_correction_is_refused(self) -> None:
        with pytest.raises(ValueError, match="does not equal"):
            Posture((cos(x), sin(x)), {x: pi}, self.target, {x: pi / 3}).judge()


class TestCount:
    @pytest.mark.parametrize(
        ("equations", "printed", "kind"),
        [
            ([cos(x) - y], 2, PROVED),
            ([cos(x) - y], 1, REFUTED),
            ([cos(x) - 1], 1, PROVED),
            ([cos(x) - 1, sp.Integer(0)], 2, REFUTED),
            ([sin(x) ** 2 + cos(x) ** 2 - 1], None, PROVED),
            ([sp.Integer(0)], None, PROVED),
            ([cos(x) - y], None, REFUTED),
        ],
    )
    def test_verdicts(self, equations: list[sp.Expr], printed: int | None, kind: str) -> None:
        assert Count(equations, [x], printed).judge().kind == kind

    def test_correction_is_the_number_that_was_found(self) -> None:
        assert Count([cos(x) - y], [x], 4).judge().corrected == "2"

    def test_dependent_targets(self) -> None:
        given = {y: (1 - r**2) / (1 + r**2), t: 2 * r / (1 + r**2)}
        assert Count([cos(x) - y, sin(x) - t], [x], 1, given).judge().kind == PROVED

    def test_solutions_of_which_only_some_coincide_raise(self) -> None:
        with pytest.raises(Undecided, match="may coincide"):
            Count([(cos(x) - 1) * (cos(x) - sp.Rational(1, 2))], [x], 3).judge()


def test_enumeration() -> None:
    assert Enumeration(4, lambda: 4, "edges").judge() == Verdict(PROVED, "edges: 4")
    assert Enumeration(5, lambda: 4, "edges").judge() == Verdict(REFUTED, "edges: 4, not 5", "4")


class TestEvery:
    @pytest.mark.parametrize(
        ("parts", "kind"),
        [
            ([TRUE, TRUE], PROVED),
            ([TRUE, ASSUMED], PROVED_UNDER),
            ([ASSUMED, NEAR], APPROXIMATION),
            ([TRUE, OPEN], NOT_DECIDABLE),
            ([TRUE, FALSE, ASSUMED], REFUTED),
            ([FALSE, OPEN], REFUTED),
        ],
    )
    def test_is_worth_its_worst_part(self, parts: list[Check], kind: str) -> None:
        assert Every({str(i): part for i, part in enumerate(parts)}).judge().kind == kind

    def test_says_which_part_is_wrong(self) -> None:
        verdict = Every({"upper": TRUE, "lower": Identity(x, 2 * x)}).judge()
        assert verdict.evidence.startswith("upper: proved; lower: refuted (at x = ")
        assert verdict.corrected == r"\text{lower: } 2 x"


class TestRefuted:
    def test_witness(self) -> None:
        assert Refuted(TRUE, "why").judge() == Verdict(REFUTED, "why")

    def test_correction_with_its_proof(self) -> None:
        assert Refuted(TRUE, "why", "so", ASSUMED).judge().corrected == "so"

    @pytest.mark.parametrize("witness", [FALSE, OPEN, NEAR])
    def test_witness_that_does_not_hold_is_refused(self, witness: Check) -> None:
        with pytest.raises(ValueError, match="does not hold"):
            Refuted(witness, "why").judge()

    def test_proof_that_does_not_hold_is_refused(self) -> None:
        with pytest.raises(ValueError, match="does not hold"):
            Refuted(TRUE, "why", "so", FALSE).judge()

    def test_correction_without_a_proof_is_refused(self) -> None:
        with pytest.raises(ValueError, match="has no proof"):
            Refuted(TRUE, "why", "so").judge()


def test_undecidable_gives_its_reason() -> None:
    assert OPEN.judge() == Verdict(NOT_DECIDABLE, "a figure")


def test_deferred_is_made_when_it_is_judged() -> None:
    made: list[Check] = []

    def make() -> Check:
        made.append(FALSE)
        return FALSE

    check = Deferred(make)
    assert not made
    assert check.judge() == FALSE.judge()


def judge(derivation: Derivation, label: str) -> Verdict:
    (claim,) = (c for c in derivation.claims if c.label == label)
    return claim.check.judge()


class TestReddyBabu:
    @pytest.mark.parametrize("d", [planar_2r.d, spherical_wrist.d], ids=lambda d: d.name)
    def test_claims_are_told_apart_by_their_labels(self, d: Derivation) -> None:
        labels = [c.label for c in d.claims]
        assert len(set(labels)) == len(labels)
        assert all(c.where and c.printed.count("$") % 2 == 0 for c in d.claims)

    def test_every_numbered_equation_is_judged(self) -> None:
        text = " ".join(c.label for d in (planar_2r.d, spherical_wrist.d) for c in d.claims)
        assert all(f"eq. ({k})" in text for k in range(1, 17))
        assert "Table I" in text.split(" Table II")[0]
        assert "Table II" in text

    @pytest.mark.parametrize(
        ("label", "kind"),
        [
            ("eq. (1)", PROVED),
            ("one solution", PROVED),
            ("eq. (3)", PROVED),
            ("tan α, before eq. (4)", REFUTED),
            ("eq. (4)", PROVED),
            ("eq. (6)", PROVED),
            ("c12, after eq. (8)", REFUTED),
            ("eq. (9), inverse of A1", PROVED),
            ("eq. (9), last row of T", REFUTED),
            ("eq. (10), line 8", PROVED),
            ("use of eq. (10)", PROVED),
            ("Results A, x", REFUTED),
            ("Results A, y", PROVED),
            ("Results A, elbow up", REFUTED),
            ("Results A, elbow down", PROVED),
            ("Results B, x", REFUTED),
            ("Results B, y", REFUTED),
            ("much better", NOT_DECIDABLE),
        ],
    )
    def test_planar_arm(self, label: str, kind: str) -> None:
        assert judge(planar_2r.d, label).kind == kind

    @pytest.mark.parametrize(
        ("label", "kind"),
        [
            ("twelve sequences", PROVED),
            ("identical axes", PROVED),
            ("eq. (12)", PROVED),
            ("eq. (13)", PROVED),
            ("eq. (14)", REFUTED),
            ("form of eq. (14)", REFUTED),
            ("eq. (15)", REFUTED),
            ("eq. (16)", PROVED),
            ("Results C, hand", PROVED),
            ("Results C, Euler angles", PROVED),
            ("same joint angles", PROVED),
            ("same matrix", REFUTED),
        ],
    )
    def test_spherical_wrist(self, label: str, kind: str) -> None:
        assert judge(spherical_wrist.d, label).kind == kind

    def test_corrections(self) -> None:
        assert judge(planar_2r.d, "c12, after eq. (8)").corrected == sp.latex(
            cos(planar_2r.theta1 + planar_2r.theta2)
        )
        assert judge(planar_2r.d, "Results A, x").corrected == r"12.6603\text{ cm}"
        assert judge(planar_2r.d, "Results A, elbow up").corrected == (
            r"\theta_{1} = 56.5894^\circ,\ \theta_{2} = -30^\circ"
        )
        # the second entry alone: -c4 c5 s6 - s4 c6, where the paper prints -c4 s5 s6 - s4 c6
        assert judge(spherical_wrist.d, "eq. (15)").corrected.count("=") == 1


def test_relations_between_constants() -> None:
    two = sp.sqrt(2)
    holds = Holds({"less": sp.Lt(two, 2, evaluate=False), "equal": sp.Eq(two**2, 2)})
    assert holds.judge() == Verdict(PROVED, "less, equal")
    nested = sp.sqrt(5 + 2 * sp.sqrt(6)) - sp.sqrt(2) - sp.sqrt(3)
    assert Holds({"nested": sp.Eq(nested, 0, evaluate=False)}).judge().kind == PROVED
    wrong = Holds({"less": sp.true, "more": sp.Ge(two, 3, evaluate=False)}).judge()
    assert wrong == Verdict(REFUTED, "not so: more")
    with pytest.raises(ValueError, match="x - y is not a constant: it depends on x, y"):
        Holds({"less": x < y}).judge()
    with pytest.raises(TypeError, match="neither an equation nor an inequality"):
        Holds({"both": (x < 1) & (x > 0)}).judge()


def test_nothing_is_not_proved() -> None:
    for check in (Holds({}), Every({})):
        with pytest.raises(ValueError, match="at least one"):
            check.judge()


def test_an_assumption_that_the_paper_leaves_open() -> None:
    assert Under(TRUE, "for a given reach").judge() == Verdict(PROVED_UNDER, "for a given reach")
    assert Under(FALSE, "for a given reach").judge().kind == REFUTED
