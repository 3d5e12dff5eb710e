"""Derivatives of long poses: those of SymPy, part by part."""

import sympy as sp

from closedform.algebra.expressions import Derivatives, linear_root
from closedform.model.functions import real

x, y, z, a = (real(name) for name in "xyza")


def test_they_are_those_of_sympy() -> None:
    for e in (
        x,
        sp.sin(y),
        3 * sp.sin(2 * x + y) * sp.cos(z) * sp.cos(x) - a * sp.cos(a - x) ** 3,
        sp.sqrt(x**2 + a) * (sp.sin(x) + a * x) * y + sp.atan2(x, y) * sp.cos(x * y),
    ):
        assert Derivatives(x).of(e) == e.diff(x)


def test_each_part_is_differentiated_once() -> None:
    """SymPy asks every factor of every product: in a long pose, a hundred thousand times."""
    count = []

    class Counted(sp.Function):  # type: ignore[misc]
        def _eval_derivative(self, s: sp.Symbol) -> sp.Expr:
            count.append(s)
            return self * self.args[0].diff(s)

    part = Counted(sp.sin(x))
    terms = [sp.cos(y + k) * part for k in range(9)] + [
        sp.cos(z + k) * Counted(y) for k in range(9)
    ]
    assert sp.expand(Derivatives(x).of(sp.Add(*terms)) - sp.cos(x) * sp.Add(*terms[:9])) == 0
    assert len(count) == 1


def test_the_root_of_a_linear_expression() -> None:
    assert linear_root(x - y - z, y) == x - z
    assert linear_root(2 * x + a, x) == -a / 2
