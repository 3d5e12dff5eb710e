"""What a back end is: the files that one language makes of a mechanism.

``docs/adding-a-backend.md`` says how to write one.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from importlib.resources import files
from pathlib import Path
from typing import Any

from closedform.lower import Lowered, lowered
from closedform.model.derivation import Derivation
from closedform.proof.prove import Proof

Files = dict[Path, str]
"""Texts by their path below ``generated/``."""


@dataclass(frozen=True)
class Mechanism:
    """What is printed: a derivation, what was proved of it, and its functions as programs."""

    derivation: Derivation
    proof: Proof

    @cached_property
    def lowered(self) -> Mapping[str, Lowered]:
        """The program of each function, made when the first back end asks for it."""
        return {f.name: lowered(f, self.derivation) for f in self.derivation.functions}


@dataclass(frozen=True)
class Pages:
    """The files of one mechanism, and its contribution to the files that all mechanisms share.

    The share is sent to another process: plain strings, numbers and containers of them.
    """

    files: Files = field(default_factory=dict)
    share: Any = None


class Backend(ABC):
    """Prints mechanisms in one language, below ``generated/`` in the folder of its name."""

    runner: str = ""
    """The module of :mod:`closedform.check.runners` that runs what is printed, if it is code."""

    @abstractmethod
    def pages(self, mechanism: Mechanism) -> Pages:
        """Print one mechanism."""

    def shared(self, shares: Sequence[Any]) -> Files:
        """The files that all mechanisms share, from the contribution of each."""
        return {}

    def works_alone(self, path: Path) -> bool:
        """Whether a file is useful outside of the Python package, in a folder of the user."""
        return True

    def first_file(self, robot: str) -> Path | None:
        """The file of a mechanism that a user looks at first."""
        return None


def runtime(path: str, numbers: Sequence[str], *, including: str = "") -> str:
    """A file of ``closedform/runtime``, which is printed as it is.

    A C header may be ``including`` another one, which is printed in its place, so that users have
    one file.  It repeats numbers that stand elsewhere.  Each of the ``numbers``, with the code
    around it, must occur in the file; otherwise it is refused.
    """
    folder = files("closedform") / "runtime"
    text = (folder / path).read_text("utf-8")
    if including:
        before, after = text.split(f'#include "{including}"\n')
        beside = Path(path).with_name(including).as_posix()
        text = before + (folder / beside).read_text("utf-8") + after
    for expected in numbers:
        if expected not in text:
            raise ValueError(
                f"closedform/runtime/{path} must hold {expected!r}, as closedform.model.tolerances "
                "and closedform.emit.sines have these numbers"
            )
    return text
