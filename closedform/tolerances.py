"""Every tolerance of the project, once, with its reason.

The generated code repeats these numbers; ``test_tolerances_are_honoured`` sees that it does so.
"""

from __future__ import annotations

from dataclasses import dataclass

HIGHEST_DEGREE = 16
"""Of the powers of a length that generated code keeps in range."""


@dataclass(frozen=True)
class Tolerances:
    """Tolerances of one floating-point type.

    feasibility
        A bound (a distance that must not be negative) may be violated by this fraction of its
        natural scale, and then counts as zero: a target that is on the boundary up to the rounding
        of whoever computed it is a target on the boundary.
    vanishing
        A quantity below this fraction of its scale counts as zero, and its joint as free.  It is
        four units in the last place: ``sin`` of the double nearest to pi is 1.2e-16, so a smaller
        value would not recognise a wrist turned by pi; a larger one would declare 1e-12 singular.
    determined
        Where a closed loop amplifies roundings by more than the reciprocal of this, joints do not
        determine the posture.  What four units in the last place become there, ``vanishing``
        over this, is less than ``forward``.
    rotation
        A matrix whose columns miss orthonormality (and right-handedness) by less is a rotation.
        It admits matrices that went through single precision, and nothing that a person would
        call a different matrix.
    round_trip
        By how much answers may violate the equations of the mechanism, in their natural scale; it
        holds of targets that count as reachable without being so, too.
    forward
        ``|fk(ik(x)) - x|`` in units of the sum of the lengths (an angle by itself), of what is
        reached and ``OK``, with the exact map for ``fk``.
    ulps
        The error of a function that is no inverse, in units in the last place of its natural
        scale, against the Arb reference.
    ulps_per_operation
        What every operation of a function adds to that: roundings add up along a long program.
    least_exponent, most_exponent
        Between these powers of two the powers of the size of a mechanism are kept, its largest
        length; one of another size is computed at a size near 1.  Above there is room for numbers
        and sums; below half of the range is left to lengths that are smaller than the largest, and
        to what of a difference of their powers is left.
    """

    feasibility: float
    vanishing: float
    determined: float
    rotation: float
    round_trip: float
    forward: float
    ulps: float
    least_exponent: int
    most_exponent: int
    ulps_per_operation: float = 0.01

    def promised(self, condition: float) -> float:
        """What OK answers of an inverse hold to that amplifies roundings by a ``condition``.

        That is ``forward``, unless four roundings of the joints and of the target, each of
        ``vanishing``, become more, together with those on the way.
        """
        return max(self.forward, 16 * self.vanishing * condition)

    def sizes(self, degree: int) -> tuple[float, float]:
        """Between which sizes no power up to ``degree`` leaves the range."""
        return 2.0 ** -(-self.least_exponent // degree), 2.0 ** (self.most_exponent // degree)


DOUBLE = Tolerances(
    feasibility=1e-12,
    vanishing=2.0**-50,
    determined=2.0**-10,
    rotation=1e-6,
    round_trip=1.1e-12,
    forward=1e-12,
    ulps=8.0,
    least_exponent=-512,
    most_exponent=1000,
)
FLOAT = Tolerances(
    feasibility=1e-6,
    vanishing=2.0**-21,
    determined=2.0**-6,
    rotation=1e-4,
    round_trip=4e-6,
    forward=4e-5,
    ulps=8.0,
    least_exponent=-64,
    most_exponent=112,
)
GENERATED = ("feasibility", "vanishing", "determined", "rotation")
"""Those that generated code holds by name."""
UNIT_LENGTH = 1e-3
"""A direction or a rotation given in decimals may miss the unit length by this: three decimals.

It decides what ``closedform new`` reads as a rounded unit vector; a mistake is usually larger.
"""
