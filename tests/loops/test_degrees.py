"""The degrees of forward problems that have no formula, counted by another route.

A pose is a dual quaternion, and whatever keeps a leg in a plane or gives it a length is quadratic
in its coordinates.  The 2**7 zeros of a system that is easy to solve are followed to those of a
mechanism with random dimensions; the others end where the quaternion has no norm.
"""

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from closedform.lemmas.legs import Stretch
from closedform.loops.hinges import Hinged, StandingPlane, TurningPlane, TwoHinges
from closedform.model.functions import real

Array = NDArray[np.float64]
Form = Callable[[Array], float]
SIZE = 8
SHORTEST = 1e-8
"""The step at which a path is given up: it ends where the coordinates are those of no pose."""
AXIS, ACROSS = np.eye(3)[0], np.eye(3)[1]


def times(a: Array, b: Array) -> Array:
    """The product of two quaternions."""
    vector = a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *vector])


def conjugate(a: Array) -> Array:
    return a * [1, -1, -1, -1]


# Vectors, times the square of the norm of the quaternion that turns the hand


def turned(x: Array, v: Array) -> Array:
    return times(times(x[:4], np.array([0, *v])), conjugate(x[:4]))[1:]


def place(x: Array) -> Array:
    """The point of the hand."""
    return 2 * times(x[4:], conjugate(x[:4]))[1:]


def place_in_hand(x: Array) -> Array:
    """The same, seen from the hand."""
    return 2 * times(conjugate(x[:4]), x[4:])[1:]


# Equations, quadratic in the eight coordinates


def length(end: Array, base: Array, square: float) -> Form:
    """A leg from a base to an end on the hand has a length."""

    def form(x: Array) -> float:
        constant = (x[:4] @ x[:4]) * (end @ end + base @ base - square)
        middle = place_in_hand(x) @ end - base @ place(x) - base @ turned(x, end)
        return float(4 * x[4:] @ x[4:] + constant + 2 * middle)

    return form


def in_plane_of_ground(normal: Array, end: Array, base: Array) -> Form:
    return lambda x: float(normal @ (place(x) + turned(x, end)) - (x[:4] @ x[:4]) * (normal @ base))


def in_plane_of_hand(normal: Array, end: Array, base: Array) -> Form:
    def form(x: Array) -> float:
        back = np.concatenate([conjugate(x[:4]), np.zeros(4)])
        return float(
            normal @ (place_in_hand(x) - turned(back, base)) + (x[:4] @ x[:4]) * (normal @ end)
        )

    return form


def at_right_angles(of_hand: Array, of_ground: Array) -> Form:
    return lambda x: float(turned(x, of_hand) @ of_ground)


def is_pose(x: Array) -> float:
    return float(x[:4] @ x[4:])


def matrix(form: Form) -> Array:
    """The symmetric matrix of a quadratic form."""
    units = np.eye(SIZE)
    sums = [[form(a + b) for b in units] for a in units]
    alone = np.array([form(a) for a in units])
    return (np.array(sums) - alone[:, None] - alone) / 2


# Mechanisms with random dimensions


def point(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=3))


def free(rng: np.random.Generator) -> list[Form]:
    """A leg with a universal and a ball joint."""
    return [length(point(rng), point(rng), rng.uniform(1, 9))]


def on_ground(rng: np.random.Generator) -> list[Form]:
    end, base, normal = point(rng), point(rng), rng.normal(size=3) * [1, 1, 0]
    return [in_plane_of_ground(normal, end, base), length(end, base, rng.uniform(1, 9))]


def on_hand(rng: np.random.Generator) -> list[Form]:
    end, base = point(rng), point(rng)
    return [in_plane_of_hand(point(rng), end, base), length(end, base, rng.uniform(1, 9))]


def turning_plane(rng: np.random.Generator) -> list[Form]:
    """Two legs from an axis of the ground to a plane of the hand through it."""
    ends, bases = rng.normal(size=(2, 3)) * (1 - ACROSS), np.outer(rng.normal(size=2), AXIS)
    lengths = [length(e, b, rng.uniform(1, 9)) for e, b in zip(ends, bases, strict=True)]
    return [at_right_angles(ACROSS, AXIS), in_plane_of_hand(ACROSS, ends[0], bases[0]), *lengths]


def standing_plane(rng: np.random.Generator) -> list[Form]:
    """Two legs in a plane of the ground to an axis of the hand, which stays in it."""
    ends, bases = np.outer(rng.normal(size=2), AXIS), rng.normal(size=(2, 3)) * (1 - ACROSS)
    lengths = [length(e, b, rng.uniform(1, 9)) for e, b in zip(ends, bases, strict=True)]
    plane = in_plane_of_ground(ACROSS, ends[0], bases[0])
    return [at_right_angles(AXIS, ACROSS), plane, *lengths]


def solved(matrices: Array, values: Array) -> Array:
    try:
        return np.linalg.solve(matrices, values[..., None])[..., 0]
    except np.linalg.LinAlgError:  # at the end of a path that leads to no pose
        return (np.linalg.pinv(matrices) @ values[..., None])[..., 0]


def zeros(forms: list[Form], rng: np.random.Generator) -> int:
    """How many poses solve the equations, complex ones included."""
    S = np.array([matrix(form) for form in [is_pose, *forms]])
    assert len(S) == SIZE - 1
    slope = rng.normal(size=SIZE) + 1j * rng.normal(size=SIZE)
    origin = slope.conj() / (slope @ slope.conj())  # the coordinates are those of a plane
    frame = np.linalg.svd(slope[None])[2][1:].conj().T
    start = rng.normal(size=SIZE - 1) + 1j * rng.normal(size=SIZE - 1)
    turn = np.exp(2j * np.pi * rng.random())

    def system(y: Array, t: Array) -> tuple[Array, Array, Array]:
        """The values, their derivatives by y and those by t, from the easy system at t = 0."""
        x = origin + y @ frame.T
        images = np.einsum("kij,nj->nki", S, x)
        hard, easy = np.einsum("nki,ni->nk", images, x), turn * (y * y - start)
        share = t[:, None]
        rates = share[..., None] * 2 * images @ frame
        rates[:, range(SIZE - 1), range(SIZE - 1)] += (1 - share) * turn * 2 * y
        return share * hard + (1 - share) * easy, rates, hard - easy

    def moved(y: Array, t: Array) -> Array:
        _, rates, by_t = system(y, t)
        return -solved(rates, by_t)

    y = np.sqrt(start) * np.array([*product((1, -1), repeat=SIZE - 1)])
    t, step = np.zeros(len(y)), np.full(len(y), 0.02)
    found = []
    while len(y):
        step = np.minimum(step, 1 - t)
        h = step[:, None]
        k1 = moved(y, t)
        k2 = moved(y + h / 2 * k1, t + step / 2)
        k3 = moved(y + h / 2 * k2, t + step / 2)
        k4 = moved(y + h * k3, t + step)
        there, changes = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), []
        for _ in range(3):
            values, rates, _ = system(there, t + step)
            change = solved(rates, values)
            there = there - change
            changes.append(np.linalg.norm(change, axis=1) / (1 + np.linalg.norm(there, axis=1)))
        good = (changes[0] < 1e-4) & (changes[-1] < 1e-10)  # on the same path as before
        y, t = np.where(good[:, None], there, y), np.where(good, t + step, t)
        step = np.where(good, np.minimum(1.6 * step, 0.1), step / 2)
        found += [*y[t >= 1]]
        left = (t < 1) & (step > SHORTEST)
        y, t, step = y[left], t[left], step[left]
    x = origin + np.array(found) @ frame.T
    x = x[np.abs((x[:, :4] ** 2).sum(axis=1)) > 1e-6 * (np.abs(x) ** 2).sum(axis=1)]
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    alike = np.abs(x.conj() @ x.T) > 1 - 1e-8
    return int((~np.triu(alike, 1).any(axis=0)).sum())


def counted(*legs: Callable[[np.random.Generator], list[Form]]) -> int:
    """The count at random dimensions; a count can only miss some, so the larger of two is taken."""
    return max(zeros([f for leg in legs for f in leg(rng)], rng) for rng in map(RNG, (2, 3)))


RNG = np.random.default_rng
ROD = Stretch(real("q"), (0, 0, 0), on_hand=(1, 0, 0))
GROUND, HAND = Hinged(ROD, on_ground=(0, 1, 0)), Hinged(ROD, on_hand=(0, 1, 0))
TURNING = TurningPlane((0, 0, 0), AXIS, ACROSS)
STANDING = StandingPlane((0, 0, 0), ACROSS, AXIS)
HINGES = [
    (TURNING, (), (turning_plane, free, free)),
    (TURNING, (GROUND,), (turning_plane, on_ground)),
    (TURNING, (HAND,), (turning_plane, on_hand)),
    (STANDING, (), (standing_plane, free, free)),
    (STANDING, (GROUND,), (standing_plane, on_ground)),
    (STANDING, (HAND,), (standing_plane, on_hand)),
    (TwoHinges(), (GROUND, GROUND), (on_ground, on_ground, free, free)),
    (TwoHinges(), (GROUND, HAND), (on_ground, on_hand, free, free)),
    (TwoHinges(), (HAND, HAND), (on_hand, on_hand, free, free)),
]


def test_the_count_of_a_hexapod_is_known() -> None:
    assert counted(*[free] * 6) == 40


@pytest.mark.parametrize(("guide", "hinged", "legs"), HINGES)
def test_the_degree_of_a_hand_on_hinged_legs(guide, hinged, legs) -> None:
    assert replace(guide, hinged=tuple(enumerate(hinged))).degree == counted(*legs)
