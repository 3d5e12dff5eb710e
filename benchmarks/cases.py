"""The functions that are timed, on random postures within reach of the shipped mechanisms."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import sympy as sp

from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Vanishes

Assignments: TypeAlias = "list[tuple[sp.Symbol, sp.Expr]]"


class NotApplicableError(Exception):
    """This competitor does not take part in this table."""


@dataclass(frozen=True)
class Case:
    """One function of one robot."""

    title: str
    robot: str
    function: str

    @property
    def derivation(self) -> Any:
        return importlib.import_module(f"closedform.derivations.{self.robot}").d

    @property
    def source(self) -> Function:
        return self.derivation[self.function]

    @property
    def full(self) -> str:
        return f"{self.robot}_{self.function}"

    def module(self, backend: str) -> Any:
        return importlib.import_module(f"closedform.generated.{backend}.{self.robot}")

    def ours(self, backend: str) -> Callable[..., Any]:
        function: Callable[..., Any] = getattr(self.module(backend), self.function)
        return function

    @property
    def inverse(self) -> bool:
        return self.source.result is not None

    @cached_property
    def parameters(self) -> dict[str, float]:
        return {p.name: float(p.value) for p in self.derivation.parameters}

    @cached_property
    def symbols(self) -> list[sp.Symbol]:
        """The arguments of the peers: coordinates, then parameters."""
        return [*self.source.symbols, *(p.symbol for p in self.derivation.parameters)]

    @cached_property
    def width(self) -> int:
        """The number of values in the outputs of all branches."""
        return sum(a.size for a in self.source.outputs) * len(list(self.source.cases()))

    @cached_property
    def program(self) -> tuple[Assignments, list[sp.Expr]]:
        """Temporaries and outputs of every branch in the generic case, without statuses and tests.

        The temporaries are the steps of the derivation and the common subexpressions that
        ``sympy.cse`` finds.
        """
        steps: dict[sp.Expr, sp.Symbol] = {}
        outputs: list[sp.Expr] = []
        for _, signs in self.source.cases():
            known: dict[sp.Basic, sp.Basic] = {s: sp.Integer(v) for s, v in signs.items()}
            for statement in self.source.body:
                if isinstance(statement, Vanishes):
                    known[statement.symbol] = sp.false
                elif isinstance(statement, (Let, Bound)):
                    value = substitute(statement.value, known)
                    if not value.is_Atom and value not in steps:
                        assumed = {"real": True, "nonnegative": statement.symbol.is_nonnegative}
                        steps[value] = sp.Symbol(f"step{len(steps)}", **assumed)
                    known[statement.symbol] = steps.get(value, value)
            outputs += [substitute(e, known) for a in self.source.outputs for e in a.entries]
        common, reduced = sp.cse([*steps, *outputs], symbols=sp.numbered_symbols("tmp"))
        outputs = reduced[len(steps) :]
        assigned = dict(common) | dict(zip(steps.values(), reduced, strict=False))
        return in_order(assigned, outputs), outputs

    def inputs(self, n: int) -> np.ndarray:
        """``n`` rows of inputs: random joints that have an image, or for an inverse that image."""
        random = np.random.default_rng(7)
        drawn = self._drawn(n, random)
        while len(drawn) < n:
            drawn = np.vstack([drawn, self._drawn(n, random)])
        return np.ascontiguousarray(drawn[:n])

    def _drawn(self, n: int, random: np.random.Generator) -> np.ndarray:
        module = self.module("numpy")
        q = random.uniform(-3, 3, (n, len(module.JOINTS)))
        joints = [j for j in self.derivation.joints if j.name in module.JOINTS]
        for k, joint in enumerate(joints):
            if joint.twin_of is not None:  # close to the joint of the other arm
                q[:, k] = q[:, module.JOINTS.index(joint.twin_of.name)] + q[:, k] / 32
        if not self.inverse:
            return q
        x = module.fk(q)
        x = (x.p[:, 0] if isinstance(x, tuple) else x).reshape(n, -1)
        reached = np.isfinite(x).all(axis=1)
        return (q if self.source.result == "Positions" else x)[reached]

    def values(self, inputs: np.ndarray) -> np.ndarray:
        """The reference: the generated NumPy, which the tests compare with ball arithmetic."""
        core = self.source.inputs[0].shape
        result = self.ours("numpy")(inputs.reshape(-1, *core))
        result = result[0] if isinstance(result, tuple) else result
        return np.asarray(result).reshape(len(inputs), -1)

    def translate(self, names: Mapping[str, Any]) -> Callable[..., Any]:
        """The source as a Python function that uses another library's ``sin``, ``cos``, ...

        The names include ``nonnegative(x)``, which is 1 or 0.
        """
        temporaries, outputs = self.program
        plain = [(s, without_cases(e)) for s, e in temporaries], [*map(without_cases, outputs)]
        function: Callable[..., Any] = sp.lambdify(
            self.symbols, plain[1], modules=[dict(names)], cse=lambda _: plain
        )
        return function


def in_order(assigned: Mapping[sp.Symbol, sp.Expr], outputs: Sequence[sp.Expr]) -> Assignments:
    """The assignments that the outputs need, each after those that it needs itself."""
    ordered: dict[sp.Symbol, sp.Expr] = {}

    def visit(expr: sp.Expr) -> None:
        for symbol in sorted(expr.free_symbols, key=str):
            if symbol in assigned and symbol not in ordered:
                visit(assigned[symbol])
                ordered[symbol] = assigned[symbol]

    for output in outputs:
        visit(output)
    return list(ordered.items())


def without_cases(expr: sp.Expr) -> sp.Expr:
    """The expression with ``nonnegative`` in place of a choice by a sign."""

    def arithmetic(first: tuple[sp.Expr, sp.Ge], second: tuple[sp.Expr, Any]) -> sp.Expr:
        (a, condition), (b, _) = first, second
        return b + (a - b) * sp.Function("nonnegative")(condition.lhs - condition.rhs)

    return expr.replace(sp.Piecewise, arithmetic)


def check(case: Case, got: np.ndarray, expected: np.ndarray) -> None:
    """Check that values agree, angles of an inverse modulo a turn; both have NaN for no branch."""
    gap = np.asarray(got, float) - expected
    if case.inverse:
        gap = np.remainder(gap + np.pi, 2 * np.pi) - np.pi
    wrong = ~(np.abs(gap) < 1e-6) & np.isfinite(expected)
    if wrong.any():
        raise ValueError(f"{wrong.any(axis=1).sum()} of {len(got)} postures disagree")


CASES = [
    Case("6R pose", "puma560", "fk"),
    Case("6R Jacobian", "puma560", "jacobian"),
    Case("IRB 260 forward", "irb260", "fk"),
    Case("2R inverse, both branches", "planar_2r", "ik"),
    Case("five-bar inverse, all eight", "hybrid_five_bar", "ik"),
    Case("H6AR inverse, all four", "h6ar", "ik"),
    Case("Delta inverse, all eight", "delta", "ik"),
    Case("Delta forward, both modes", "delta", "fk"),
]
