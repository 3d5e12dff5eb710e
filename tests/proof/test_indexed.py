"""Formulas with a free index, and what the reading of a formula and the checks do at their ends."""

import pytest
import sympy as sp

from closedform.model.claims import PROVED, REFUTED, Check, Verdict
from closedform.model.functions import real
from closedform.model.indexed import Indexed, at_index
from closedform.model.notation import Notation
from closedform.proof.checks.equations import Equal, worst

x, y = real("x"), real("y")
SHIFT = sp.Matrix([[0, 1], [0, 0]])
TURN = sp.Matrix([[0, -1], [1, 0]])


def numbered(values: list) -> Indexed:
    return Indexed((1, 2, 3), lambda k: values[k - 1])


def judged(text: str, **means: object) -> Verdict:
    (relation,) = Notation(means).read(text)
    return Equal(relation).judge()


class TestIndexed:
    def test_sums_and_products_are_taken_index_by_index(self) -> None:
        a = numbered([x, 2 * x, 3 * x])
        both = (a + y) * a
        assert [sp.expand(both.at(k)) for k in both.indices] == [
            x**2 + x * y, 4 * x**2 + 2 * x * y, 9 * x**2 + 3 * x * y,
        ]  # fmt: skip

    @pytest.mark.parametrize("k", [1, 2, 3])
    def test_matrices_keep_the_order_of_their_product(self, k: int) -> None:
        a = numbered([k * TURN for k in (1, 2, 3)])
        assert (SHIFT * a).at(k) == k * SHIFT * TURN
        assert (a * SHIFT).at(k) == k * TURN * SHIFT
        assert SHIFT * TURN != TURN * SHIFT

    def test_numbers_on_the_left(self) -> None:
        a = numbered([x, y, x + y])
        assert (sp.Integer(2) * a).at(3) == 2 * (x + y)
        assert (x + a).at(2) == x + y

    def test_a_function_of_each_value(self) -> None:
        assert numbered([x, y, x * y]).map(sp.sin).at(3) == sp.sin(x * y)

    def test_a_value_without_an_index_is_the_same_at_all(self) -> None:
        assert at_index(x, 1) == at_index(x, 2) == x


class TestEqualForEachIndex:
    def test_proved_if_it_holds_for_each(self) -> None:
        a, b = numbered([x, 2 * x, 3 * x]), numbered([x + y, 2 * x + y, 3 * x + y])
        assert judged("b_i = a_i + y", b_i=b, a_i=a, y=y) == Verdict(PROVED)

    @pytest.mark.parametrize("wrong", [1, 2, 3])
    def test_the_first_fault_is_shown(self, wrong: int) -> None:
        a = numbered([x, x, x])
        b = numbered([x + (1 if k >= wrong else 0) for k in (1, 2, 3)])
        verdict = judged("a_i = b_i", a_i=a, b_i=b)
        assert verdict.kind == REFUTED
        assert verdict.evidence[0] == f"for $i = {wrong}$: "


class Counted(Check):
    """Counts how often it is judged."""

    def __init__(self) -> None:
        self.times = 0

    def judge(self) -> Verdict:
        self.times += 1
        return Verdict(PROVED)


def test_what_follows_a_refutation_is_not_computed() -> None:
    later = Counted()
    checks = [Counted(), None, later]
    found = worst(c.judge() if c else Verdict(REFUTED, ("first",)) for c in checks)
    assert found == Verdict(REFUTED, ("first",))
    assert (checks[0].times, later.times) == (1, 0)


def test_a_function_of_a_number_at_the_end_of_a_formula() -> None:
    assert Notation({"f": lambda value: value**2}).value("f 3") == 9
    four = {"f": lambda value: value, "n": sp.Integer(4)}
    assert Notation(four).value("f n") == 4
