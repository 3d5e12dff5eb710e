"""From SymPy to the graph.

Sines and cosines are computed for single joint angles only; those of sums and multiples follow from
the addition theorem.  This costs four multiplications instead of one addition, but the error does
not grow with the angle: the double nearest to ``theta1 + theta2`` is off by an ulp of the sum,
which for a joint that has turned a million times is far more than an ulp of the sine.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache, reduce

import sympy as sp

from closedform.algebra.expressions import square_roots
from closedform.algebra.resolvent import Resolvent
from closedform.lower.graph import Graph, Node
from closedform.lower.resolvent import root_between
from closedform.model.constant import Constant
from closedform.model.functions import reject_floats

RELATIONS = {
    sp.StrictLessThan: ("lt", False, False),
    sp.LessThan: ("le", False, False),
    sp.StrictGreaterThan: ("lt", True, False),
    sp.GreaterThan: ("le", True, False),
    sp.Equality: ("eq", False, False),
    sp.Unequality: ("eq", False, True),
}


class Builder:
    """Translates expressions over ``known`` symbols into nodes of one graph."""

    def __init__(
        self, graph: Graph, known: Mapping[sp.Basic, Node], divisors: Mapping[sp.Basic, int]
    ):
        self.graph = graph
        self.known: dict[sp.Basic, Node] = dict(known)
        self.divisors = divisors
        self.memo: dict[sp.Basic, Node] = {}
        self.names: dict[int, str] = {}

    def define(self, symbol: sp.Basic, node: Node) -> None:
        self.known[symbol] = node

    def __call__(self, expr: sp.Basic) -> Node:
        if (known := self.known.get(expr)) is not None:
            return known
        if expr not in self.memo:
            self.memo[expr] = self._translate(expr)
        return self.memo[expr]

    def _translate(self, expr: sp.Basic) -> Node:
        if isinstance(expr, sp.logic.boolalg.Boolean):
            return self._condition(expr)
        if expr is sp.nan:
            return self.graph.node("nan")
        if expr.is_number:
            reject_floats(expr, "lowering")
            return self.graph.const(expr)
        match expr:
            case sp.Add():
                return self.graph.sum(map(self, _ordered_terms(expr)))
            case sp.Mul():
                return self._product(expr)
            case sp.Pow():
                return self._power(expr)
            case sp.sin():
                return self._sine_cosine(expr.args[0])[0]
            case sp.cos():
                return self._sine_cosine(expr.args[0])[1]
            case sp.Piecewise():
                return self._cases(expr)
            case _:
                return self._function(expr)

    def _function(self, expr: sp.Basic) -> Node:
        graph = self.graph
        match expr:
            case sp.atan2():
                turned = self._principal_value(*expr.args)
                return turned or graph.atan2(*map(self, expr.args))
            case sp.atan():  # SymPy's form of atan2(y, x) if x is positive
                top, bottom = sp.fraction(expr.args[0])
                if not bottom.is_nonnegative:
                    top, bottom = expr.args[0], sp.S.One
                return graph.atan2(self(top), self(bottom))
            case Constant():
                return graph.node("tolerance", payload=expr.name)
            case Resolvent():
                return root_between(graph, *map(self, expr.args))
            case sp.Abs():
                return graph.even("abs", self(expr.args[0]))
            case sp.Max() | sp.Min():
                op = "max" if isinstance(expr, sp.Max) else "min"
                nodes = [self(e) for e in sorted(expr.args, key=sp.default_sort_key)]
                return reduce(lambda a, b: graph.node(op, a, b), nodes)
        raise TypeError(f"no lowering for {type(expr).__name__}: {expr}")

    def _cases(self, expr: sp.Piecewise) -> Node:
        *cases, (last, _) = expr.args
        result = self(last)
        for value, condition in reversed(cases):
            result = self.graph.select(self(condition), self(value), result)
        return result

    def _condition(self, expr: sp.Basic) -> Node:
        graph = self.graph
        if expr in (sp.true, sp.false):
            return graph.node("true" if expr == sp.true else "false")
        if isinstance(expr, sp.And):
            return graph.every([self(a) for a in sorted(expr.args, key=sp.default_sort_key)])
        if isinstance(expr, sp.Or):
            return graph.any([self(a) for a in sorted(expr.args, key=sp.default_sort_key)])
        if isinstance(expr, sp.Not):
            return graph.negate(self(expr.args[0]))
        op, swapped, negated = RELATIONS[type(expr)]
        a, b = map(self, reversed(expr.args) if swapped else expr.args)
        node = graph.node(op, a, b)
        return graph.negate(node) if negated else node

    def _product(self, expr: sp.Mul) -> Node:
        numerator, denominator = [], []
        for factor in _ordered_factors(expr):
            base, exponent = factor.as_base_exp()
            if exponent.is_Rational and exponent.is_negative and not base.is_number:
                denominator.append(self(sp.Pow(base, -exponent)))
            elif factor.is_Rational and factor.q != 1 and abs(factor.p) == 1:
                denominator.append(self.graph.const(factor.q))
                numerator.append(self.graph.const(factor.p))
            else:
                numerator.append(self(factor))
        top = self.graph.product(numerator)
        return self.graph.div(top, self.graph.product(denominator)) if denominator else top

    def _power(self, expr: sp.Pow) -> Node:
        base, exponent = expr.args
        roots = square_roots(expr)
        if exponent.is_negative:
            return self.graph.div(self.graph.const(1), self(sp.Pow(base, -exponent)))
        whole, left = divmod(exponent.p, exponent.q)
        root = self(base)
        factors = [root] * whole
        for k in reversed(range(roots)):
            root = self.graph.node("sqrt", root)
            if left >> k & 1:
                factors.append(root)
        return self.graph.product(factors)

    def _principal_value(self, sine: sp.Expr, cosine: sp.Expr) -> Node | None:
        """``atan2(sin t, cos t)`` for an integer combination ``t`` of inputs, without trigonometry.

        ``sine`` may also belong to ``-t``.  Each input is reduced to one turn separately, for the
        same reason as the sines are computed separately.
        """
        opposite = sine.could_extract_minus_sign()
        sine = -sine if opposite else sine
        if not (isinstance(sine, sp.sin) and cosine == sp.cos(sine.args[0])):
            return None
        terms = [t.as_coeff_Mul() for t in sp.Add.make_args(sine.args[0])]
        inputs = [self.known.get(symbol) for _, symbol in terms]
        if any(n is None or n.op != "input" for n in inputs):
            return None
        if not all(coefficient.is_Integer for coefficient, _ in terms):
            return None
        graph = self.graph
        parts = [
            graph.product([graph.const(coefficient), graph.node("principal", self(symbol))])
            for coefficient, symbol in terms
        ]
        total = graph.sum(parts)
        return graph.node("wrap", graph.neg(total) if opposite else total)

    def _sine_cosine(self, angle: sp.Expr) -> tuple[Node, Node]:
        graph = self.graph
        if isinstance(angle, sp.Add):
            first, *rest = _ordered_terms(angle)
            s1, c1 = self._sine_cosine(first)
            s2, c2 = self._sine_cosine(sp.Add(*rest))
            sine = graph.sum([graph.product([s1, c2]), graph.product([c1, s2])])
            cosine = graph.sum([graph.product([c1, c2]), graph.neg(graph.product([s1, s2]))])
            self._suggest_names(angle, sine, cosine)
            return sine, cosine
        if angle.is_number:
            return self(sp.sin(angle)), self(sp.cos(angle))
        coefficient, symbol = angle.as_coeff_Mul()
        if isinstance(symbol, sp.atan2) and coefficient in (1, -1):
            return self(coefficient * sp.sin(symbol)), self(sp.cos(symbol))
        if symbol not in self.known:
            raise TypeError(f"the sine of {angle} is not that of a multiple of an input")
        divisor = self.divisors.get(symbol, 1)
        node = self.known[symbol]
        unit = node if divisor == 1 else graph.div(node, graph.const(divisor))
        multiple = coefficient * divisor
        if not multiple.is_Integer:
            raise TypeError(f"the sine of {angle} is not that of a rational multiple of an input")
        sine, cosine = graph.odd("sin", unit), graph.even("cos", unit)
        result = (graph.const(0), graph.const(1))
        for _ in range(abs(int(multiple))):
            s, c = result
            result = (
                graph.sum([graph.product([s, cosine]), graph.product([c, sine])]),
                graph.sum([graph.product([c, cosine]), graph.neg(graph.product([s, sine]))]),
            )
        return (result[0] if multiple > 0 else graph.neg(result[0])), result[1]

    def _suggest_names(self, angle: sp.Add, sine: Node, cosine: Node) -> None:
        """Suggest ``s12`` and ``c12`` for the sine and the cosine of theta1 + theta2."""
        terms = list(map(str, _ordered_terms(angle)))
        if all(t.startswith("theta") and t.isalnum() for t in terms):
            label = "".join(t.removeprefix("theta") for t in terms)
            self.names.setdefault(sine.id, f"s{label}")
            self.names.setdefault(cosine.id, f"c{label}")


# Each branch of a function translates the same expressions.
@cache
def _ordered_terms(expr: sp.Expr) -> tuple[sp.Expr, ...]:
    return tuple(expr.as_ordered_terms())


@cache
def _ordered_factors(expr: sp.Mul) -> tuple[sp.Expr, ...]:
    return tuple(expr.as_ordered_factors())


def angle_divisors(expressions: Iterable[sp.Basic]) -> dict[sp.Basic, int]:
    """The common denominator of the multiples of each angle: 2 if ``theta / 2`` occurs, else 1."""
    divisors: dict[sp.Basic, int] = {}
    for expr in expressions:
        for function in expr.atoms(sp.sin, sp.cos):
            for term in sp.Add.make_args(function.args[0]):
                coefficient, symbol = term.as_coeff_Mul()
                if not symbol.is_number:
                    divisors[symbol] = int(sp.ilcm(divisors.get(symbol, 1), coefficient.q))
    return divisors
