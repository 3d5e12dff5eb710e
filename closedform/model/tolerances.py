"""All tolerances of the project, each with its reason.

The generated code repeats these numbers; ``test_tolerances_are_honoured`` checks this.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import sympy as sp

from closedform.model.constant import Constant

HIGHEST_DEGREE = 16
"""The highest power of a length that generated code keeps in range."""


@dataclass(frozen=True)
class Tolerances:
    """Tolerances of one floating-point type.

    feasibility
        A bound (a distance that must not be negative) may be negative by this fraction of its
        natural scale and then counts as zero.  So a target that is on the boundary up to the
        rounding of its computation counts as a target on the boundary.
    vanishing
        A quantity below this fraction of its scale counts as zero, and its joint as free.  It is
        four units in the last place: ``sin`` of the double nearest to pi is 1.2e-16, so a smaller
        value would not recognise a wrist turned by pi; a larger one would declare 1e-12 singular.
    determined
        If a closed loop amplifies rounding errors by more than the reciprocal of this, the joints
        do not determine the posture.  At that limit four units in the last place become
        ``vanishing / determined``, which is less than ``forward``.
    half_digits
        A length from the root of a difference has half of the digits where the difference vanishes.
        It does not count as shorter than this fraction of the size: a quarter of the root of
        ``feasibility``.
    rounding
        How far a corrected joint may move the target, in units of the size of the arm: more than a
        forward map and the inverse up to there lose, and below ``forward``.
    rotation
        A matrix counts as a rotation if its columns are orthonormal and right-handed up to this.
        Matrices that were stored in single precision pass; a matrix that a person would call
        different does not.
    round_trip
        The largest violation of the equations of the mechanism by an answer, in their natural
        scale.  It also holds for unreachable targets that count as reachable, and where a wrist
        counts as aligned: 16 ``vanishing`` off the axis, its two solutions are twice that apart.
    forward
        ``|fk(ik(x)) - x|`` for reachable targets with the status ``OK``, in units of the sum of the
        lengths (for an angle, absolute), with the exact map for ``fk``.
    ulps
        The error of a function that is not an inverse, in units in the last place of its natural
        scale, against the Arb reference.
    ulps_per_operation
        The error that every operation of a function adds to ``ulps``: rounding errors add up along
        a long program.
    least_exponent, most_exponent
        The powers of the size of a mechanism, its largest length, stay between these powers of two;
        other mechanisms are computed at a size near 1.  The margin above is for numbers and sums.
        Below, half of the range is left for lengths that are smaller than the largest, and for
        differences of their powers.
    """

    feasibility: float
    vanishing: float
    determined: float
    half_digits: float
    rounding: float
    rotation: float
    round_trip: float
    forward: float
    ulps: float
    least_exponent: int
    most_exponent: int
    ulps_per_operation: float = 0.01

    def promised(self, condition: float) -> float:
        """The bound for OK answers of an inverse that amplifies roundings by ``condition``.

        That is ``forward``, unless four roundings of the joints and of the target, each of
        ``vanishing``, and those on the way become more.
        """
        return max(self.forward, 16 * self.vanishing * condition)

    def violated(self, condition: float) -> float:
        """The largest violation of its equations by an answer of such an inverse."""
        return max(self.round_trip, 16 * self.vanishing * condition)

    def sizes(self, degree: int) -> tuple[float, float]:
        """The smallest and largest size whose powers up to ``degree`` stay in the range."""
        return 2.0 ** -(-self.least_exponent // degree), 2.0 ** (self.most_exponent // degree)


DOUBLE = Tolerances(
    feasibility=1e-12,
    vanishing=2.0**-50,
    determined=2.0**-10,
    half_digits=2.0**-22,
    rounding=2.0**-44,
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
    half_digits=2.0**-12,
    rounding=2.0**-17,
    rotation=1e-4,
    round_trip=2.0**-16,
    forward=4e-5,
    ulps=8.0,
    least_exponent=-64,
    most_exponent=112,
)
GENERATED = ("feasibility", "vanishing", "determined", "half_digits", "rounding", "rotation")
"""The tolerances that generated code contains by name."""
POWERS_OF_TWO = tuple(
    name
    for name in GENERATED
    if all(math.frexp(getattr(kind, name))[0] == 0.5 for kind in (DOUBLE, FLOAT))
)
"""Those of them by which a product is exact, in both types."""
VANISHING, HALF_DIGITS, ROUNDING = (
    Constant(name, sp.Rational(getattr(DOUBLE, name)))
    for name in ("vanishing", "half_digits", "rounding")
)
"""Tolerances in the expressions of a derivation."""
UNIT_LENGTH = 1e-3
"""How far a direction or a rotation in decimals may be from unit length: three decimals.

``closedform new`` reads such a vector as a rounded unit vector; a mistake is usually larger.
"""
