"""A proposed chain of lemmas, as lines; or why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.lemmas import links as linklemmas
from closedform.lemmas import pairs, tangent

NAMES = ("Abs", "Matrix", "Rational", "atan", "atan2", "cos", "pi", "sin", "sqrt")
"""What the lines use of SymPy."""


class NoChainError(ValueError):
    """No chain of lemmas is known for an arm.

    ``found`` is a clause, the property of this arm that stands in the way; ``needed`` is a sentence
    on what the known chains need, and what can be done.
    """

    def __init__(self, found: str, needed: str):
        super().__init__(f"no chain of lemmas is known for this arm, because {found}.  {needed}")
        self.found, self.needed = found, needed


@dataclass(frozen=True)
class Proposal:
    """The structure that was recognised, and the lines that solve the arm with ``ik`` a Chain."""

    structure: str
    lines: tuple[str, ...]
    lemmas: tuple[str, ...]
    branches: int

    @property
    def source(self) -> str:
        return "\n".join(self.lines) + "\n"

    def apply(self, ik: Any) -> None:
        """Run the lines, for the chain ``ik``; what is wrong with them the proof finds.

        The lines hold nothing that stood in a table but names and expressions that were printed
        from SymPy objects by :func:`source`, which refuses any other name.
        """
        names: dict[str, Any] = {
            "__builtins__": {},
            **{s.name: s for s in (*(p.symbol for p in ik.d.parameters), *ik.joints)},
            **{n: getattr(linklemmas, n) for n in (*self.lemmas, "turned", "Reaching")},
            **{n: getattr(tangent, n) for n in ("Links", "LinksAndWrist")},
            **{n: getattr(pairs, n) for n in ("LinksAtHeight", "Pair")},
            **{n: getattr(sp, n) for n in NAMES},
            "ik": ik,
        }
        exec(compile(self.source, "proposal", "exec"), names)


__all__ = ["NoChainError", "Proposal"]
