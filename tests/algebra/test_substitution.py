"""Expressions whose parts occur often: each part is visited once."""

import sympy as sp

from closedform.model.expressions import free_symbols, parts, replaced, substitute
from closedform.proof.posture import outcomes

X, Y = sp.symbols("x y", real=True)
F = sp.Function("F")


def nested(start: sp.Expr, depth: int) -> sp.Expr:
    """2 to the power of ``depth`` times the same part."""
    for _ in range(depth):
        start = F(start, start)
    return start


def test_a_symbol_in_a_part_that_occurs_often_is_replaced() -> None:
    """Visited as often as it occurs, it would take longer than the universe has existed."""
    deep = nested(X, 100)
    assert len(parts([deep])) == 101
    assert free_symbols([deep]) == {X}
    assert substitute(deep, {Y: X}) is deep
    found = substitute(deep, {X: Y})
    assert free_symbols([found]) == {Y}
    assert len(parts([found])) == 101
    while found.args:
        assert found.args[0] is found.args[1]
        found = found.args[0]


def test_the_same_as_xreplace() -> None:
    expr = nested(sp.sin(X) + sp.Piecewise((X * Y, X > 0), (Y**2, True)), 3)
    for known in ({X: Y, Y: X}, {X: sp.Integer(2)}, {X: sp.Integer(-1), Y: X + 1}):
        assert substitute(expr, known) == expr.xreplace(known)


def test_a_condition_that_occurs_often_is_replaced() -> None:
    choice = sp.Piecewise((X, X > 0), (Y, True))
    deep = sp.Matrix([nested(choice, 60), choice])
    found = replaced(deep, X > 0, sp.true)
    assert free_symbols(found) == {X}
    assert found[1] == choice.xreplace({X > 0: sp.true}) == X
    assert len(parts([found[0]])) == 61


def test_extremes_of_simple_values_are_evaluated() -> None:
    choice = sp.Piecewise((X, X > Y), (sp.Max(X, 2 * Y), True))
    swapped = sp.Piecewise((Y, Y > X), (sp.Max(Y, 2 * X), True))
    assert substitute(choice, {X: Y, Y: X}) == swapped
    assert substitute(sp.Max(X, Y), {X: sp.Integer(1), Y: sp.Integer(2)}) == 2


def test_all_outcomes_of_choices() -> None:
    choice = sp.Piecewise((X, X > 0), (Y, True))
    assert set(outcomes(F(choice, choice))) == {F(X, X), F(Y, Y)}
