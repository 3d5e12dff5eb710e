"""An inverse in stages: a wrong formula in any of them, or between them, is found."""

import dataclasses
import importlib

import pytest
import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import Let
from closedform.proof.prove import prove_inverse
from closedform.proof.require import ProofError


@pytest.fixture
def arm() -> Derivation:
    original = importlib.import_module("closedform.derivations.stanford_arm").d
    return dataclasses.replace(original, functions=list(original.functions))


def change(arm: Derivation, name: str, rewrite) -> None:
    """Rewrite the value of one name in the program of the inverse."""
    k = next(k for k, f in enumerate(arm.functions) if f.name == "ik")
    body = tuple(
        Let(s.symbol, rewrite(s.value)) if isinstance(s, Let) and s.symbol.name == name else s
        for s in arm.functions[k].body
    )
    assert body != arm.functions[k].body
    arm.functions[k] = dataclasses.replace(arm.functions[k], body=body)


def test_the_arm_is_proved(arm: Derivation) -> None:
    result = prove_inverse(arm, arm.inverses[0])
    assert (result.solutions, result.method) == (8, "step by step")


@pytest.mark.parametrize(
    ("name", "stage"), [("reach", "1"), ("c2", "1"), ("s1", "1"), ("R1_11", "2"), ("s4", "2")]
)
def test_a_wrong_formula_is_found_in_its_stage(arm: Derivation, name: str, stage: str) -> None:
    change(arm, name, lambda e: 2 * e)
    with pytest.raises(ProofError, match=f"stage {stage}: the answer, put into"):
        prove_inverse(arm, arm.inverses[0])


def test_what_is_handed_on_must_be_what_was_solved(arm: Derivation) -> None:
    (inverse,) = arm.inverses
    first, second = inverse.stages
    wrong = {name: sp.cos(value.args[0]) for name, value in second.carried.items()}
    stages = (first, dataclasses.replace(second, carried=wrong))
    with pytest.raises(ProofError, match="stage 1: the answer, put into"):
        prove_inverse(arm, dataclasses.replace(inverse, stages=stages))


def test_a_missing_branch_is_counted(arm: Derivation) -> None:
    k = next(k for k, f in enumerate(arm.functions) if f.name == "ik")
    every = arm.functions[k].branches
    assert every is not None
    half = dataclasses.replace(every, labels=every.labels[:4], signs=every.signs[:4])
    arm.functions[k] = dataclasses.replace(arm.functions[k], branches=half)
    inverse = dataclasses.replace(arm.inverses[0], continua=())
    with pytest.raises(ProofError, match=r"8 solutions .*, but 4 branches"):
        prove_inverse(arm, inverse)


def test_a_matrix_must_be_orthogonal(arm: Derivation) -> None:
    (inverse,) = arm.inverses
    first, second = inverse.stages
    assert second.mixed is not None
    stages = (first, dataclasses.replace(second, mixed=sp.zeros(9)))
    with pytest.raises(ProofError, match="orthonormal"):
        prove_inverse(arm, dataclasses.replace(inverse, stages=stages, continua=()))
