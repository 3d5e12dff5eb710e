"""Forward maps as a reader computes them: vectors in place of their coordinates."""

import pytest
import sympy as sp

from closedform.emit.backends.latex.vectors import InVectors, in_vectors
from closedform.model.expressions import substitute
from closedform.model.functions import Array, Bound, Function, Let, Program, Vanishes, real
from closedform.pipeline import scripts

LOOPS = ("delta", "linear_delta", "orthoglide", "spherical_five_bar")


def forward(name: str) -> tuple[Function, dict[sp.Basic, sp.Expr]]:
    """The forward map, and joints and parameters in general position."""
    derivation = scripts.load(next(s for s in scripts.sources() if s.name == name))
    point = {p.symbol: p.value for p in derivation.parameters}
    shares = (sp.Rational(3, 10), sp.Rational(2, 5), sp.Rational(1, 4))
    point |= dict(zip(derivation.actuated, shares, strict=False))
    return next(f for f in derivation.functions if f.name == "fk"), point


class Digits:
    """The values of a function in vectors, statement by statement."""

    def __init__(self, read: InVectors, known: dict[sp.Basic, sp.Expr]):
        self.read, self.numbers = read, dict(known)
        self.vectors: dict[sp.Basic, sp.Matrix] = {}
        body = read.function.body
        self.flags = {s.symbol: sp.false for s in body if isinstance(s, Vanishes)}
        for statement in body:
            if isinstance(statement, Let | Bound):
                self.state(statement.symbol, statement.value)

    def state(self, name: sp.Symbol, value: sp.Expr) -> None:
        if name in self.read.values:
            self.vectors[name] = self.vector(self.read.values[name])
        elif substitute(value, self.flags).free_symbols <= {*self.numbers, *self.read.factors}:
            self.numbers[name] = self.scalar(value)

    def scalar(self, value: sp.Expr) -> sp.Expr:
        value = substitute(value, self.flags)
        for dot in value.free_symbols & self.read.factors.keys():
            a, b = self.read.factors[dot]
            self.numbers[dot] = self.vectors[a].dot(self.vectors[b])
        return sp.N(value.xreplace(self.numbers), 30)

    def vector(self, value: object) -> sp.Matrix:
        if isinstance(value, tuple):
            return sp.Matrix([self.scalar(e) for e in value])
        total = sp.zeros(3, 1)
        for term in sp.Add.make_args(sp.expand(value)):
            (held,) = term.free_symbols & {*self.read.values, *self.read.factors}
            if held in self.read.factors:
                a, b = self.read.factors[held]
                part = self.vectors[a].cross(self.vectors[b])
            else:
                part = self.vectors[held]
            total += self.scalar(term / held) * part
        return total


@pytest.mark.parametrize("name", LOOPS)
def test_the_vectors_give_the_same_point(name: str) -> None:
    f, point = forward(name)
    read = in_vectors(f, {})
    assert read is not None
    for _, chosen in f.cases():
        signs = {s: sp.Integer(v) for s, v in chosen.items()}
        found = Digits(read, point | signs).vector(read.result)
        for value, other in zip(f.values(chosen), found, strict=True):
            assert abs(sp.N(value.xreplace(point), 30) - other) < 1e-20


def test_a_coordinate_that_is_needed_alone_keeps_the_coordinates() -> None:
    program = Program()
    a, b, c = (real(n) for n in "abc")
    u = [program.let(f"u_{axis}", e) for axis, e in zip("xyz", (a + b, b + c, c + a), strict=True)]
    alone = program.let("alone", sp.sqrt(u[0] ** 2 + 1))

    def returning(*entries: sp.Expr) -> Function:
        inputs = (Array("x", (3,), (a, b, c)),)
        return Function("f", "F.", inputs, (Array("p", (3,), entries),), body=tuple(program.body))

    assert in_vectors(returning(*(alone * e for e in u)), {}) is None
    assert in_vectors(returning(*(2 * e for e in u)), {}) is not None
