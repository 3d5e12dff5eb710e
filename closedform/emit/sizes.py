"""What a back end tells its runtime of the size of a mechanism."""

from __future__ import annotations

from dataclasses import dataclass

from closedform.lower import Lowered
from closedform.model.tolerances import DOUBLE


@dataclass(frozen=True)
class Size:
    """How the values of a program go with the size of a mechanism, its largest length.

    ``lengths`` are the places of the inputs, and of the parameters behind them, that are lengths;
    ``degrees`` are the places of the results that go with a power of the size, and the power.  In
    double precision sizes from ``least`` to ``most`` have powers that stay in the range.
    """

    lengths: tuple[int, ...]
    degrees: tuple[tuple[int, int], ...]
    least: float
    most: float

    @classmethod
    def of(cls, program: Lowered) -> Size | None:
        """None where no power of the size can leave the range."""
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
    """What a kernel takes: the entries of the inputs, then the parameters that it uses."""
    return [str(e) for a in program.inputs for e in a.entries] + list(program.parameters)
