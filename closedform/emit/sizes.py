"""The size of a mechanism, as a back end passes it to its runtime."""

from __future__ import annotations

from dataclasses import dataclass

from closedform.lower import Lowered
from closedform.model.tolerances import DOUBLE


@dataclass(frozen=True)
class Size:
    """How the values of a program scale with the size of a mechanism, its largest length.

    ``lengths`` are the indices of the inputs (and then the parameters) that are lengths;
    ``degrees`` are the indices of the results that scale with a power of the size, and the power.
    In double precision the powers of sizes from ``least`` to ``most`` stay in the range.
    """

    lengths: tuple[int, ...]
    degrees: tuple[tuple[int, int], ...]
    least: float
    most: float

    @classmethod
    def of(cls, program: Lowered) -> Size | None:
        """The scaling of a program; None if no power of the size can leave the range."""
        if program.degrees is None or not program.is_scaled:
            return None
        lengths = program.degrees.lengths
        flat = [d for row in program.degrees.results for d in row]
        return cls(
            tuple(k for k, name in enumerate(arguments(program)) if name in lengths),
            tuple((k, d) for k, d in enumerate(flat) if d),
            *DOUBLE.sizes(program.degrees.highest),
        )


def arguments(program: Lowered) -> list[str]:
    """The arguments of a kernel: the entries of the inputs, then the parameters that it uses."""
    return [str(e) for a in program.inputs for e in a.entries] + list(program.parameters)
