"""A proposed chain of lemmas, as lines; or why there is none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


class NoChainError(ValueError):
    """No chain of lemmas is known for an arm.

    ``found`` is a clause that names the property of this arm that prevents it.  ``needed`` is a
    sentence on what the known chains need and what you can do.  ``degree`` is that of the equation
    that no lemma solves, or 0 if it is not known.
    """

    def __init__(self, found: str, needed: str, degree: int = 0, tried: Sequence[Tried] = ()):
        super().__init__(f"no chain of lemmas is known for this arm, because {found}.  {needed}")
        self.found, self.needed, self.degree = found, needed, degree
        self.tried = tuple(tried)

    def after(self, tried: Sequence[Tried]) -> NoChainError:
        """The same error, with all chains that were tried."""
        return NoChainError(self.found, self.needed, self.degree, tried)


@dataclass(frozen=True)
class Tried:
    """A chain that was tried before, and why it does not fit."""

    name: str
    error: NoChainError


@dataclass(frozen=True)
class Proposal:
    """The structure that was recognised, and the lines that solve the arm; ``ik`` is a Chain.

    ``name`` is that of the chain among those that are tried.
    """

    name: str
    structure: str
    lines: tuple[str, ...]
    lemmas: tuple[str, ...]
    branches: int
    tried: tuple[Tried, ...] = ()
    doubt: str = ""
    """A sentence on the joint that is given, if it leaves a singular arm at some of its values."""

    @property
    def source(self) -> str:
        return "\n".join(self.lines) + "\n"


__all__ = ["NoChainError", "Proposal", "Tried"]
