"""Each lemma is proved once, for symbolic coefficients, and a wrong one is not."""

import dataclasses

import pytest
import sympy as sp

from closedform.functions import Program, real
from closedform.lemmas import (
    Lemma,
    linear_pair,
    parallelogram,
    sine_cosine,
    two_link_triangle,
    zyz_angles,
)
from closedform.prove import ProofError, prove_lemma
from closedform.solutions import rotation_parametrisation

x, y, z = (real(n) for n in ("x", "y", "z"))
a, b, c = (real(n) for n in "abc")
sigma = real("sigma")


def applied(name: str) -> tuple[Lemma, Program, dict]:
    """A lemma applied to symbols."""
    program = Program()
    if name == "linear pair":
        return linear_pair(x, a, b), program, {}
    if name == "sine and cosine":
        return sine_cosine(program, x, a, b, c, sigma), program, {}
    if name == "triangle":
        first, second = (real(n, positive=True) for n in ("l1", "l2"))
        reach = real("r", positive=True)
        return two_link_triangle(program, first, second, reach, x, y, sigma), program, {}
    if name == "parallelogram":
        crank, coupler = (real(n, positive=True) for n in ("l", "a"))
        return parallelogram(crank, coupler, z, real("gamma"), x, y, sigma), program, {}
    R = sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))
    given = dict(zip(R, rotation_parametrisation(), strict=True))
    return zyz_angles(program, R, x, y, z, sigma), program, given


NAMES = ["linear pair", "sine and cosine", "triangle", "parallelogram", "zyz"]


@pytest.mark.parametrize("name", NAMES)
def test_sound_and_complete(name: str) -> None:
    prove_lemma(*applied(name))


@pytest.mark.parametrize("name", NAMES)
def test_a_wrong_solution_is_found(name: str) -> None:
    lemma, program, given = applied(name)
    unknown = next(iter(lemma.solution))
    wrong = {**lemma.solution, unknown: lemma.solution[unknown] + sp.pi / 6}
    with pytest.raises(ProofError, match="does not vanish"):
        prove_lemma(dataclasses.replace(lemma, solution=wrong), program, given)


@pytest.mark.parametrize("name", NAMES)
def test_a_missing_branch_is_found(name: str) -> None:
    lemma, program, given = applied(name)
    with pytest.raises(ProofError, match="solutions"):
        prove_lemma(dataclasses.replace(lemma, branches=lemma.branches - 1), program, given)
