"""Expressions whose parts occur often: each part is visited once."""

import sympy as sp

from closedform.model.functions import parts, substitute
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
    replaced = substitute(deep, {X: Y})
    assert {X, Y} & parts([replaced]).keys() == {Y}
    assert substitute(deep, {Y: X}) is deep


def test_the_same_as_xreplace() -> None:
    expr = nested(sp.sin(X) + sp.Piecewise((X * Y, X > 0), (Y**2, True)), 3)
    for known in ({X: Y, Y: X}, {X: sp.Integer(2)}, {X: sp.Integer(-1), Y: X + 1}):
        assert substitute(expr, known) == expr.xreplace(known)


def test_all_outcomes_of_choices() -> None:
    choice = sp.Piecewise((X, X > 0), (Y, True))
    assert set(outcomes(F(choice, choice))) == {F(X, X), F(Y, Y)}
