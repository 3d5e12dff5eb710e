"""An inverse as a chain of lemmas: a wrong formula in any link, or between them, is found."""

import dataclasses
import importlib
from collections.abc import Callable

import pytest
import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import Let
from closedform.proof.inverse import prove_inverse
from closedform.proof.require import ProofError

LEMMA = "what the lemma .* does not satisfy its equations"


@pytest.fixture
def arm() -> Derivation:
    original = importlib.import_module("closedform.derivations.stanford_arm").d
    return dataclasses.replace(
        original, functions=list(original.functions), inverses=list(original.inverses)
    )


def change(arm: Derivation, name: str, rewrite: Callable[[sp.Expr], sp.Expr]) -> None:
    """Rewrite the value of one name in the program of the inverse, and in the link it is of."""

    def changed(body):
        return tuple(
            Let(s.symbol, rewrite(s.value)) if isinstance(s, Let) and s.symbol.name == name else s
            for s in body
        )

    k = next(k for k, f in enumerate(arm.functions) if f.name == "ik")
    body = changed(arm.functions[k].body)
    assert body != arm.functions[k].body
    arm.functions[k] = dataclasses.replace(arm.functions[k], body=body)
    (inverse,) = arm.inverses
    links = tuple(dataclasses.replace(link, body=changed(link.body)) for link in inverse.links)
    arm.inverses = [dataclasses.replace(inverse, links=links)]


def test_the_arm_is_proved(arm: Derivation) -> None:
    result = prove_inverse(arm, arm.inverses[0])
    assert (result.solutions, result.method) == (8, "lemma by lemma")


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("s1", LEMMA),
        ("ahead1", LEMMA),
        ("r_boom", LEMMA),
        ("c2", LEMMA),
        ("s_wrist", LEMMA),
        ("flip_wrist", LEMMA),
        ("R1_11", "does not follow from the forward map"),
    ],
)
def test_a_wrong_formula_is_found_in_its_link(arm: Derivation, name: str, fault: str) -> None:
    change(arm, name, lambda e: e / 2)
    with pytest.raises(ProofError, match=fault):
        prove_inverse(arm, arm.inverses[0])


def test_what_is_handed_on_must_be_what_was_solved(arm: Derivation) -> None:
    (inverse,) = arm.inverses
    first, *others = inverse.links
    wrong = {name: sp.cos(value.args[0]) for name, value in first.means.items() if value.args}
    links = (dataclasses.replace(first, means=wrong), *others)
    with pytest.raises(ProofError, match=LEMMA):
        prove_inverse(arm, dataclasses.replace(inverse, links=links))


def test_a_missing_branch_is_counted(arm: Derivation) -> None:
    k = next(k for k, f in enumerate(arm.functions) if f.name == "ik")
    every = arm.functions[k].branches
    assert every is not None
    half = dataclasses.replace(every, labels=every.labels[:4], signs=every.signs[:4])
    arm.functions[k] = dataclasses.replace(arm.functions[k], branches=half)
    with pytest.raises(ProofError, match=r"8 solutions .*, but 4 branches"):
        prove_inverse(arm, arm.inverses[0])


def test_a_lemma_that_is_left_out_leaves_the_target_undetermined(arm: Derivation) -> None:
    (inverse,) = arm.inverses
    shorter = dataclasses.replace(inverse, links=inverse.links[:-1])
    with pytest.raises(ProofError, match="of the target undetermined"):
        prove_inverse(arm, shorter)


def test_where_a_joint_is_free_the_flag_must_hold(arm: Derivation) -> None:
    (inverse,) = arm.inverses
    on_axis, *others = inverse.degenerate
    (px, *_) = on_axis.locus
    wrong = dataclasses.replace(on_axis, locus={**on_axis.locus, px: sp.Integer(1)})
    with pytest.raises(ProofError, match=r"where theta1 is free the flag .* is not true"):
        prove_inverse(arm, dataclasses.replace(inverse, degenerate=(wrong, *others)))
