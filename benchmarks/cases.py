"""What is timed: functions of the shipped mechanisms, on random postures within reach."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from closedform.functions import Function


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
    def expressions(self) -> list[sp.Expr]:
        """Every output of every branch in the generic case: no statuses, no tests of the input."""
        return [e for _, signs in self.source.cases() for e in self.source.values(signs)]

    def inputs(self, n: int) -> np.ndarray:
        """``n`` inputs as rows; an inverse gets the images of random joints."""
        module = self.module("numpy")
        q = np.random.default_rng(7).uniform(-3, 3, (n, len(module.JOINTS)))
        if not self.inverse:
            return q
        x = module.fk(q)
        x = x.p[:, 0] if isinstance(x, tuple) else x
        return np.ascontiguousarray(x.reshape(n, -1))

    def values(self, inputs: np.ndarray) -> np.ndarray:
        """The reference: the generated NumPy, which the tests hold against ball arithmetic."""
        core = self.source.inputs[0].shape
        result = self.ours("numpy")(inputs.reshape(-1, *core))
        result = result[0] if isinstance(result, tuple) else result
        return np.asarray(result).reshape(len(inputs), -1)

    def translate(self, names: Mapping[str, Any]) -> Callable[..., Any]:
        """The source as a Python function over another library's ``sin``, ``cos``, ..."""
        function: Callable[..., Any] = sp.lambdify(
            self.symbols, self.expressions, modules=[dict(names)], cse=True
        )
        return function


def check(case: Case, got: np.ndarray, expected: np.ndarray) -> None:
    """Values agree, angles of an inverse modulo a turn; a missing branch is NaN in both."""
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
]
