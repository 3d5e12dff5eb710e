"""Each check gives each of its verdicts, and refuses what it cannot judge."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
import sympy as sp
from sympy import acos, atan, atan2, cos, pi, sin, sqrt

from closedform.algebra.normal_form import Undecided
from closedform.model.claims import (
    APPROXIMATION,
    INCOMPLETE,
    INCONSISTENT,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    Check,
    Claim,
    Erratum,
    Gravity,
    Verdict,
)
from closedform.model.functions import real
from closedform.model.notation import SIGN, Notation, Relation
from closedform.proof.checks.equations import (
    Agree,
    Equal,
    Every,
    Identity,
    Reaches,
    Under,
)
from closedform.proof.checks.solutions import Count, Postures, Procedure, Solves
from closedform.proof.checks.statements import (
    Enumeration,
    Exists,
    ForAll,
    Holds,
    Not,
    Rounded,
    Undecidable,
)
from closedform.proof.claims import judge

x, y, t, l = map(real, "xytl")
theta = real("theta")
r = real("r", positive=True)
u, w = real("u", nonnegative=True), real("w", nonnegative=True)
NAMES = Notation({"x": x, "y": y, "l": l, "r": r, r"\theta": theta, r"a \tan 2": atan2})
TRUE = Identity(sin(x) ** 2 + cos(x) ** 2, sp.Integer(1))
FALSE = Identity(sin(x) + sin(y), sin(x + y))
ASSUMED = Identity(sqrt(x**2), x, nonnegative=(x,))
NEAR = Identity(sin(t), t, small=t)
OPEN = Undecidable("a figure")
PROBLEM = Erratum("problem", "A problem", Gravity.STATEMENT, "Why.", "Use.")


def one(text: str) -> Relation:
    (relation,) = NAMES.read(text)
    return relation


def evidence(check: Check) -> str:
    """The evidence as a reader sees it."""
    fault = check.judge().kind not in (PROVED, PROVED_UNDER, NOT_DECIDABLE)
    claim = Claim("a", "$x$", lambda _: check, notation=NAMES, erratum="problem" * fault)
    return judge(claim, [PROBLEM]).evidence


class TestIdentity:
    @pytest.mark.parametrize(
        ("check", "kind"),
        [(TRUE, PROVED), (ASSUMED, PROVED_UNDER), (FALSE, REFUTED), (NEAR, APPROXIMATION)],
    )
    def test_verdicts(self, check: Check, kind: str) -> None:
        assert check.judge().kind == kind

    def test_assumption_is_printed(self) -> None:
        assert evidence(ASSUMED) == r"$x$ $\ge 0$"

    def test_without_its_assumption_it_is_refuted_at_a_negative_point(self) -> None:
        check = Identity(sqrt(x**2), x)
        assert evidence(check) == (
            "at $x = -1$: the printed form is $1$, but the derived one is $-1$"
        )

    def test_long_values_are_shown_as_decimals(self) -> None:
        assert "is $1.81268$, but" in evidence(Identity(sqrt(sqrt(sqrt(2) + 1) + sqrt(3)), sp.S(2)))

    def test_order_of_the_error(self) -> None:
        assert evidence(NEAR).startswith(
            r"the error is $- \frac{t^{3}}{6}$ and terms of order 4 in $t$; e.g. at $t = "
        )

    def test_an_error_that_does_not_vanish_is_not_an_approximation(self) -> None:
        assert Identity(cos(t), t, small=t).judge().kind == REFUTED

    def test_order_of_a_matrix_is_that_of_its_worst_entry(self) -> None:
        check = Identity(sp.Matrix([t, 1]), sp.Matrix([sin(t), cos(t)]), small=t)
        assert r"the error is $\frac{t^{2}}{2}$ and terms of order 3 in $t$" in evidence(check)

    def test_the_entry_is_named(self) -> None:
        matrix = Identity(sp.Matrix([[1, x], [y, 2 * y]]), sp.Matrix([[1, x], [y, x]]))
        assert "in row 2, column 2, the printed form is" in evidence(matrix)
        assert "part 2 of the printed form is" in evidence(Identity([x, x], [x, -x]))
        named = Identity([x, x], [x, -x], names=("f", "zero"), parts=("for k = 1", "for k = 2"))
        assert ": f for k = 2 is " in evidence(named) and "part" not in evidence(named)

    def test_sequences_are_compared_part_by_part(self) -> None:
        assert Identity([x, sin(x) ** 2], (x, 1 - cos(x) ** 2)).judge().kind == PROVED

    @pytest.mark.parametrize(
        ("printed", "derived"), [([x], [x, y]), (sp.eye(2), sp.eye(3)), (sp.eye(2), sp.Integer(1))]
    )
    def test_different_shapes_are_refused(self, printed: object, derived: object) -> None:
        with pytest.raises(ValueError):
            Identity(printed, derived).judge()

    def test_zero_stands_for_a_matrix_of_zeros(self) -> None:
        assert Identity(sp.Matrix([x - x, 0]), sp.zeros(2, 1)).judge().kind == PROVED

    def test_floats_are_refused(self) -> None:
        with pytest.raises(TypeError, match="float"):
            Identity(x / 2, sp.Float("0.5") * x).judge()

    @pytest.mark.parametrize(
        ("printed", "derived", "point"),
        [
            (x + y, x + 2 * y, {x: 0, y: 1}),
            (sqrt(x - 2) + y, sqrt(x - 2), {x: 2, y: 1}),
            (1 / x + y, 1 / x + 2 * y, {x: 1, y: 1}),
            (sp.Matrix([t, x + y]), sp.Matrix([t, x]), {t: 0, x: 0, y: 1}),
        ],
    )
    def test_symbols_that_cancel_have_a_value_at_the_counterexample(
        self, printed: Any, derived: Any, point: Mapping[sp.Symbol, int]
    ) -> None:
        verdict = Identity(printed, derived).judge()
        (found,) = (piece for piece in verdict.evidence if isinstance(piece, dict))
        assert verdict.kind == REFUTED
        assert all(found[s] == value for s, value in point.items() if s in found)
        assert {s for s in point if s != t} <= set(found)

    def test_what_can_be_neither_proved_nor_refuted_raises(self) -> None:
        with pytest.raises(Undecided):
            Identity(sqrt(3 + 2 * sqrt(2)), 1 + sqrt(2)).judge()  # true, but it cannot prove it

    def test_only_a_posture_can_refute(self) -> None:
        """Where symbols depend on each other, other points say nothing."""
        postures = [{x: sp.S.One, y: sp.S.One}, {x: sp.Integer(2), y: sp.S.Zero}]
        verdict = Identity(x, y, postures=postures).judge()
        assert (verdict.kind, verdict.evidence[1]) == (REFUTED, postures[1])
        equal = Equal(one("x = y"), postures=postures).judge()
        assert (equal.kind, equal.evidence[1]) == (REFUTED, postures[1])
        with pytest.raises(Undecided):
            Identity(x, y, postures=postures[:1]).judge()


class TestEqual:
    @pytest.mark.parametrize(
        ("text", "kind"),
        [
            ("(x + y)^2 = x^2 + 2xy + y^2", PROVED),
            ("x = x = y", REFUTED),
            (r"\sin\theta = \pm\sqrt{1 - \cos^2\theta}", PROVED),
            (r"\sin\theta = +\sqrt{1 - \cos^2\theta}", REFUTED),
            (r"\sin\theta = \pm\sqrt{1 + \cos^2\theta}", REFUTED),
            (r"\begin{bmatrix} x - x & 0 \end{bmatrix} = 0", PROVED),
            (r"0 = \begin{bmatrix} x & 0 \end{bmatrix}", REFUTED),
        ],
    )
    def test_verdicts(self, text: str, kind: str) -> None:
        assert Equal(one(text)).judge().kind == kind

    def test_the_sides_are_shown_as_printed(self) -> None:
        shown = evidence(Equal(one(r"\sin  x = 2 x")))
        assert shown.endswith(r": $\sin  x$ is $1$, but $2 x$ is $\pi$")
        shown = evidence(Equal(one(r"\sin\theta = \pm\sqrt{1 + \cos^2\theta}")))
        assert shown == (
            r"at $\theta = 0$: neither sign of $\pm$ makes $\sin\theta$ equal "
            r"$\pm\sqrt{1 + \cos^2\theta}$"
        )

    def test_long_sides_are_not_repeated(self) -> None:
        long = " + ".join(["x"] * 20)
        assert "the left side is" in evidence(Equal(one(f"{long} = y")))

    def test_several_relations_are_worth_the_worst(self) -> None:
        assert Equal(NAMES.read("x = x, y = y")).judge().kind == PROVED
        assert Equal(NAMES.read("x = x, x = y")).judge().kind == REFUTED

    def test_options(self) -> None:
        assert Equal(one(r"\sqrt{x^2} = x"), nonnegative=(x,)).judge().kind == PROVED_UNDER
        assert Equal(one(r"\sin x = x"), small=x).judge().kind == APPROXIMATION
        assert Equal(one("x = y"), on={y: x}).judge().kind == PROVED
        assert Equal(one("x = l^2 = l l"), defines=x).judge().kind == PROVED
        with pytest.raises(ValueError, match="only defines a name"):
            Equal(one("x = y"), defines=x).judge()

    @pytest.mark.parametrize("text", ["x", r"x \ne y", r"x = y < l"])
    def test_what_is_not_an_equation_is_refused(self, text: str) -> None:
        with pytest.raises(ValueError, match="is not an equation"):
            Equal(one(text)).judge()


@pytest.mark.parametrize(
    ("check", "kind"),
    [
        (Agree(x + x, 2 * x, ("A", "B")), PROVED),
        (Agree(x, 2 * x, ("A", "B")), INCONSISTENT),
        (Agree(sqrt(x**2), x, ("A", "B"), (x,)), PROVED_UNDER),
    ],
)
def test_agree(check: Check, kind: str) -> None:
    assert check.judge().kind == kind


def test_statements_that_disagree_are_named() -> None:
    shown = evidence(Agree(x, 2 * x, ("the length in II", "the length in III")))
    assert shown == "at $x = 1$: the length in II is $1$, but the length in III is $2$"


class TestReaches:
    target = (sp.Integer(0), sp.Integer(1))

    def test_verdicts(self) -> None:
        assert Reaches((cos(x), sin(x)), {x: pi / 2}, self.target).judge().kind == PROVED
        check = Reaches((cos(x), sin(x)), {x: -pi / 2}, self.target)
        assert check.judge().kind == REFUTED
        assert evidence(check) == "they reach ($0$, $-1$), not ($0$, $1$)"

    def test_lengths_without_a_value_get_one_where_it_is_refuted(self) -> None:
        check = Reaches((r * cos(x), r * sin(x)), {x: pi}, (sp.Integer(0), r))
        assert evidence(check) == "at $r = 1$: they reach ($-1$, $0$), not ($0$, $1$)"


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
            ([OPEN, Agree(x, y, ("A", "B"))], INCONSISTENT),
        ],
    )
    def test_is_worth_its_worst_part(self, parts: list[Check], kind: str) -> None:
        assert Every({str(i): part for i, part in enumerate(parts)}).judge().kind == kind

    def test_says_which_part_is_wrong(self) -> None:
        shown = evidence(Every({"upper": TRUE, "lower": Identity(x, 2 * x)}))
        assert shown.startswith("lower: at $x = 1$: ")

    def test_says_what_is_proved_without_the_verdict_of_each_part(self) -> None:
        parts = {"it is upright": TRUE, "it is long": ForAll(sp.Ge(2, 1))}
        assert evidence(Every(parts)) == "it is upright; it is long"
        counted = {"it is upright": TRUE, "it is one": Enumeration(1, lambda: 1, "their number")}
        assert evidence(Every(counted)) == "it is upright; it is one (their number: 1)"

    def test_nothing_is_not_proved(self) -> None:
        with pytest.raises(ValueError, match="at least one"):
            Every({}).judge()


def test_an_assumption_that_the_paper_does_not_state() -> None:
    assert Under(TRUE, "for a given reach").judge() == Verdict(PROVED_UNDER, ("for a given reach",))
    assert Under(FALSE, "for a given reach").judge().kind == REFUTED
    assert evidence(Under(ASSUMED, "for a given reach")) == r"for a given reach, $x$ $\ge 0$"


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

    def test_the_number_that_was_found_is_shown(self) -> None:
        assert evidence(Count([cos(x) - y], [x], 4)) == "a Groebner basis counts 2 solutions"
        assert "a continuum of" in evidence(Count([sp.Integer(0)], [x], None))

    def test_dependent_targets(self) -> None:
        given = {y: (1 - r**2) / (1 + r**2), t: 2 * r / (1 + r**2)}
        assert Count([cos(x) - y, sin(x) - t], [x], 1, given).judge().kind == PROVED

    def test_solutions_of_which_only_some_coincide_raise(self) -> None:
        with pytest.raises(Undecided, match="may coincide"):
            Count([(cos(x) - 1) * (cos(x) - sp.Rational(1, 2))], [x], 3).judge()


CIRCLE = {x: 2 * cos(theta), y: 2 * sin(theta)}
POSTURES = Postures(CIRCLE, [theta], groups={"front": cos(theta) > 0, "back": cos(theta) < 0})
LINE = [sin(theta) * x - cos(theta) * y]
POINT = [l * cos(theta) - x, l * sin(theta) - y]
GIVEN = {x: l * (1 - t**2) / (1 + t**2), y: 2 * l * t / (1 + t**2)}


class TestSolves:
    """A printed formula is a map: the arctangent of a quotient has one value of two."""

    @pytest.mark.parametrize(
        ("check", "kind"),
        [
            (lambda f: Solves(f, LINE, POSTURES), INCOMPLETE),
            (lambda f: Solves(f, POINT, POSTURES, given=GIVEN), REFUTED),
        ],
    )
    def test_arctangent_of_a_quotient(self, check: Callable[..., Check], kind: str) -> None:
        formula = one(r"\theta = \tan^{-1}\left(\frac{y}{x}\right)")
        verdict = check({formula.left: formula.right}).judge()
        assert verdict.kind == kind

    def test_the_share_is_that_of_the_postures_behind(self) -> None:
        verdict = Solves({theta: atan(y / x)}, LINE, POSTURES).judge()
        assert "(front: 0.0 %, back: 100.0 %)" in verdict.evidence[-1]
        share = float(verdict.evidence[2].split(" in ")[1].split(" %")[0])
        assert abs(share - 50) < 1

    def test_two_arguments_give_the_only_solution(self) -> None:
        formula = one(r"\theta = a \tan 2(y, x)")
        check = Solves({formula.left: formula.right}, POINT, given=GIVEN, nonnegative=(l,))
        assert check.judge() == Verdict(PROVED, ("the only solution",))

    def test_a_sign_is_missing(self) -> None:
        level = Postures({x: cos(theta)}, [theta])
        bound = (1 - x**2,)
        single = Solves({theta: acos(x)}, [cos(theta) - x], level, bound)
        both = Solves({theta: SIGN * acos(x)}, [cos(theta) - x], level, bound)
        assert single.judge().kind == INCOMPLETE
        assert "1 of 2 solutions" in single.judge().evidence[0]
        assert both.judge().kind == PROVED

    def test_a_wrong_formula_is_refuted(self) -> None:
        assert Solves({theta: SIGN * sp.asin(x)}, [sin(theta) - x]).judge().kind == REFUTED

    def test_cases_do_not_count_as_solutions(self) -> None:
        half = sp.Piecewise((atan(y / x), x > 0), (atan(y / x) + pi, sp.true))
        verdict = Solves({theta: half}, LINE, POSTURES).judge()
        assert verdict.kind == INCOMPLETE
        assert "in 0.0 % of" in verdict.evidence[2]

    def test_a_continuum_is_never_complete(self) -> None:
        verdict = Solves({theta: x}, [sp.Integer(0)]).judge()
        assert verdict == Verdict(
            INCOMPLETE, ("right, but it gives 1 of infinitely many solutions",)
        )


class TestProcedure:
    def test_refuted_at_a_posture_that_a_person_can_check(self) -> None:
        verdict = Procedure({theta: atan(y / x)}, CIRCLE, POSTURES).judge()
        assert verdict.kind == REFUTED
        assert verdict.evidence[:2] == ("at ", {theta: 2 * pi / 3})
        assert "(front: 0.0 %, back: 100.0 %)" in verdict.evidence[-1]

    def test_one_sign_that_fits_is_enough(self) -> None:
        formulas = {t: SIGN * sqrt(4 - x**2), theta: atan2(t, x)}
        with pytest.raises(Undecided):  # the other sign misses: a sample proves nothing
            Procedure(formulas, CIRCLE, POSTURES).judge()
        formulas[theta] = atan(t / x)
        assert Procedure(formulas, CIRCLE, POSTURES).judge().kind == REFUTED

    def test_proved_by_exact_algebra_not_by_samples(self) -> None:
        assert Procedure({theta: atan2(y, x)}, CIRCLE, POSTURES).judge().kind == PROVED
        near = Procedure({theta: atan2(y, x) + sp.Rational(1, 10**12)}, CIRCLE, POSTURES)
        with pytest.raises(Undecided):
            near.judge()

    def test_its_steps_have_to_be_proved(self) -> None:
        right = {theta: atan2(y, x)}
        for step in (TRUE, FALSE):
            steps = {"the only one": step}
            assert Procedure(right, CIRCLE, POSTURES, steps).judge().kind == step.judge().kind
        missed = Procedure({theta: atan(y / x)}, CIRCLE, POSTURES, {"the only one": TRUE})
        assert missed.judge().kind == REFUTED


def test_a_share_says_from_where_the_postures_are_drawn() -> None:
    narrow = {t: (float(-pi / 6), float(pi / 6)), theta: (0.0, float(pi / 2))}
    words = Postures(CIRCLE, [theta, t, x], ranges=narrow).drawn()
    assert words == [
        "", theta, " from $0^\\circ$ to $90^\\circ$",
        ", ", t, " from $-30^\\circ$ to $30^\\circ$",
        ", ", x, " from $-180^\\circ$ to $180^\\circ$",
    ]  # fmt: skip


class TestRounded:
    @pytest.mark.parametrize(
        ("text", "exact"),
        [
            ("x = 3.14", pi),
            ("x = 3.1416", pi),
            ("x = 3", pi),
            ("x = -3.1416", -pi),
            ("x = 0.00", sp.Rational(1, 1000)),
            ("x = 1.10", sp.Rational(11, 10)),
            ("x = 2", sqrt(2) * sqrt(2)),
            ("x = 0.12", sp.Rational(1, 8)),
            ("x = 0.13", sp.Rational(1, 8)),
            ("x = -0.13", -sp.Rational(1, 8)),
            ("x = 0.5", (sqrt(3 + 2 * sqrt(2)) - sqrt(2)) / 2),
        ],
    )
    def test_proved(self, text: str, exact: sp.Expr) -> None:
        assert Rounded(one(text), exact).judge().kind == PROVED

    @pytest.mark.parametrize(
        ("text", "exact", "how"),
        [
            ("x = 3.1415", pi, "truncated, not rounded"),
            ("x = -3.1415", -pi, "truncated, not rounded"),
            ("x = 3.1417", pi, "off by 1.07 units of the last place"),
            ("x = 3.15", pi, "off by 0.84 units of the last place"),
            ("x = 3.14", -pi, "off by 628.16 units of the last place"),
            ("x = 0.11", sp.Rational(1, 8), "off by 1.50 units of the last place"),
            ("x = 0.1", sp.Rational(1, 20) - sp.Rational(1, 10**9), "off by"),
            ("x = 7", sp.Rational(15, 2) + sp.Rational(1, 10**30), "truncated"),
        ],
    )
    def test_refuted(self, text: str, exact: sp.Expr, how: str) -> None:
        verdict = Rounded(one(text), exact).judge()
        assert verdict.kind == REFUTED
        assert verdict.evidence[0].startswith(how)

    @pytest.mark.parametrize(
        ("text", "exact", "kind"),
        [
            ("x = 3.1415", pi, PROVED),
            ("x = -3.1415", -pi, PROVED),
            ("x = 3.1416", pi, REFUTED),
            ("x = 3.1414", pi, REFUTED),
            ("x = -3.1416", -pi, REFUTED),
            ("x = 1.10", sp.Rational(11, 10), PROVED),
            ("x = 1.09", sp.Rational(11, 10), REFUTED),
        ],
    )
    def test_cut(self, text: str, exact: sp.Expr, kind: str) -> None:
        assert Rounded(one(text), exact, cut=True).judge().kind == kind

    def test_unit(self) -> None:
        angle = atan(sp.Rational(1, 2))
        degrees = Rounded(one(r"\theta = 26.57^\circ"), angle, "degrees", pi / 180)
        assert degrees.judge() == Verdict(PROVED, ("the exact value is $26.565051$ degrees",))
        wrong = Rounded(one(r"\theta = 26.56^\circ"), angle, "degrees", pi / 180)
        assert wrong.judge().kind == REFUTED

    def test_values_are_constants_and_relations_equations(self) -> None:
        with pytest.raises(ValueError, match="2\\*x is not a constant: it depends on x"):
            Rounded(one("x = 3.2"), 2 * x).judge()
        with pytest.raises(ValueError, match="is not an equation"):
            Rounded(one(r"x \ne 3.14"), pi).judge()


def test_enumeration() -> None:
    assert Enumeration(4, lambda: 4, "edges").judge() == Verdict(PROVED, ("edges: 4",))
    assert Enumeration(5, lambda: 4, "edges").judge() == Verdict(REFUTED, ("edges: 4, not 5",))
    assert Enumeration(True, lambda: True, "it turns").judge() == Verdict(PROVED, ("it turns",))
    fails = Verdict(REFUTED, ("not so: it turns",))
    assert Enumeration(True, lambda: False, "it turns").judge() == fails
    named = Enumeration(["a"], lambda: ["a", ("b", "c")], "names")
    assert named.judge() == Verdict(REFUTED, ("names: a, (b, c), not a",))
    assert Enumeration([], list, "names").judge() == Verdict(PROVED, ("names: none",))


def test_a_printed_value_is_not_repeated() -> None:
    verdict = Identity(x, sp.Integer(6), names=("$x$", "$6$")).judge()
    assert verdict.evidence[-4:] == (" is ", sp.S.Zero, ", not ", 6)
    lists = Identity([x], [sp.S.One], names=("the list", "that of others")).judge()
    assert (
        "".join(map(str, lists.evidence[3:])) == "part 1 of the list is 0, but that of others is 1"
    )


def test_relations_between_constants() -> None:
    two = sqrt(2)
    holds = Holds({"less": sp.Lt(two, 2, evaluate=False), "equal": sp.Eq(two**2, 2)})
    assert holds.judge() == Verdict(PROVED, ("less, equal",))
    nested = sqrt(5 + 2 * sqrt(6)) - sqrt(2) - sqrt(3)
    shown = Holds({"less": sp.Lt(1, 2, evaluate=False)}, point={x: sp.S.One}).judge()
    assert shown.evidence == ("at ", {x: 1})  # "AC = L1, regular" said nothing to a reader
    assert Holds({"nested": sp.Eq(nested, 0, evaluate=False)}).judge().kind == PROVED
    wrong = Holds({"less": sp.true, "more": sp.Ge(two, 3, evaluate=False)}).judge()
    assert wrong == Verdict(REFUTED, ("not so: more",))
    with pytest.raises(ValueError, match="x - y is not a constant: it depends on x, y"):
        Holds({"less": x < y}).judge()
    with pytest.raises(TypeError, match="neither an equation nor an inequality"):
        Holds({"both": (x < 1) & (x > 0)}).judge()
    with pytest.raises(ValueError, match="at least one"):
        Holds({}).judge()


SQUARE = sp.Ge(x**2, 0, evaluate=False)


class TestForAll:
    @pytest.mark.parametrize(
        ("check", "kind"),
        [
            (ForAll(SQUARE), PROVED),
            (ForAll(sp.Gt(x * y, 0, evaluate=False), slack=[(x, 1 + u), (y, 1 + w)]), PROVED),
            (ForAll(x > 0), REFUTED),
            (ForAll(sp.Eq(sin(x) ** 2 + cos(x) ** 2, 1, evaluate=False)), PROVED),
            (ForAll(sp.Eq(sin(x), x, evaluate=False)), REFUTED),
            (ForAll(sp.Eq(sqrt(x**2), x, evaluate=False), where=[x >= 0]), PROVED),
            (ForAll(sp.Eq(sqrt(x**2), x, evaluate=False)), REFUTED),
            (ForAll(sp.Eq(x, y, evaluate=False), on={y: x}), PROVED),
            (ForAll(sp.true), PROVED),
            (ForAll(sp.false), REFUTED),
        ],
    )
    def test_verdicts(self, check: Check, kind: str) -> None:
        assert check.judge().kind == kind

    def test_a_given_point_is_tried_first(self) -> None:
        assert evidence(ForAll(x > 0, among=[{x: sp.Integer(-5)}])) == "it fails at $x = -5$"

    def test_a_domain_without_a_counterexample_proves_nothing(self) -> None:
        with pytest.raises(Undecided):
            ForAll(x > 0, where=[x > 1]).judge()

    def test_a_point_that_gives_no_value_to_a_symbol_is_left_out(self) -> None:
        """A misprint may bring in a symbol that the listed points do not have."""
        verdict = ForAll(sp.Ge(x, y), among=[{x: sp.S.Zero}]).judge()
        assert (verdict.kind, set(verdict.evidence[1])) == (REFUTED, {x, y})


class TestExists:
    def test_verdicts(self) -> None:
        assert Exists([x > 1, x < 2]).judge().kind == PROVED
        assert Exists([sp.Eq(x, 2)], among=[{x: sp.Integer(2)}]).judge().kind == PROVED
        assert (
            Exists([sp.Lt(x**2, 0, evaluate=False)], never=ForAll(SQUARE)).judge().kind == REFUTED
        )

    def test_not_finding_a_point_is_not_a_refutation(self) -> None:
        with pytest.raises(Undecided):
            Exists([x > 1, x < 0]).judge()
        with pytest.raises(Undecided):
            Exists([x > 1, x < 0], never=FALSE).judge()


def test_the_opposite() -> None:
    assert Not(TRUE).judge().kind == REFUTED
    assert Not(FALSE).judge().kind == PROVED
    assert Not(OPEN).judge().kind == NOT_DECIDABLE
    assert Not(ASSUMED).judge().kind == PROVED_UNDER


def test_undecidable_gives_its_reason() -> None:
    assert OPEN.judge() == Verdict(NOT_DECIDABLE, ("a figure",))
