"""Arms on a tilted mount: their twists, and the size of what is proved of them."""

import numpy as np
import pytest
import sympy as sp
from arms import differences, twists
from numpy.typing import NDArray

from closedform.algebra.operations import operations
from closedform.emit.backends.latex.article import document
from closedform.emit.render import render
from closedform.mechanics.arm import Serial, from_screws
from closedform.model.derivation import Derivation, Paper
from closedform.proof.prove import Proof, prove

A, B = sp.Rational(2, 5), sp.Rational(3, 10)
HOME = sp.Matrix([[1, 0, 0, A + B], [0, 0, 1, 0], [0, -1, 0, B], [0, 0, 0, 1]])
TILTED = sp.Matrix([[1, 8, -4, 1], [-4, 4, 7, 2], [8, 1, 4, -3], [0, 0, 0, 9]]) / 9
"""Every axis of coordinates is turned to a direction between the others."""


def arm(base: sp.Matrix | None = None) -> tuple[Derivation, Serial]:
    d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "An arm.")
    q = [d.joint(f"q{k}") for k in range(1, 6)]
    directions = (0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0)
    points = (0, 0, 0), (0, 0, B), (A, 0, B), (A, 0, B), (A + B, 0, B)
    return d, from_screws(d, [*zip(q, directions, points, strict=True)], HOME, base=base)


def test_the_derivatives_are_proved_without_the_mount() -> None:
    """Its numbers spread through all of them: an arm of Romeo took 17 s instead of 10."""
    sizes = []
    for base in (None, TILTED):
        d, serial = arm(base)
        serial.export(d)
        (jacobians,) = (s for s in d.steps if s.title == "Jacobians")
        sizes.append(sum(operations(e) for e in jacobians.differences()))
    level, tilted = sizes
    assert tilted < 1.8 * level
    prove(d)
    text = render("latex/robot.tex.jinja", document(d, Proof(d.name, d.paper.key, (), 0, ())))
    assert "T &= A_1 T_0" in text and "rotation in $A_{1}$" in text


def at(matrix: sp.Matrix, joints: tuple[sp.Symbol, ...], q: NDArray[np.float64]) -> NDArray:
    return np.array(sp.lambdify(joints, matrix, "numpy")(*q), dtype=float)


@pytest.mark.parametrize("seed", range(3))
def test_the_twists_on_a_tilted_mount_are_those_of_differences(seed: int) -> None:
    _, serial = arm(TILTED)
    joints = serial.joints
    q = np.random.default_rng(seed).uniform(-3, 3, len(joints))
    product = sp.prod(serial.moves)
    T = at(product, joints, q)
    np.testing.assert_allclose(at(serial.pose, joints, q), T, atol=1e-14)
    J, J_s, J_b = (at(J, joints, q) for J in (serial.geometric, serial.space, serial.body))
    rates = differences(lambda q: at(product, joints, q), q)
    back = np.linalg.inv(T)
    np.testing.assert_allclose(J_s, twists([rate @ back for rate in rates]), atol=1e-8)
    np.testing.assert_allclose(J_b, twists([back @ rate for rate in rates]), atol=1e-8)
    velocities = np.array([rate[:3, 3] for rate in rates]).T
    np.testing.assert_allclose(J, np.vstack([velocities, J_s[3:]]), atol=1e-8)
