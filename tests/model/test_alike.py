"""Legs that differ in names alone: they are told once, and what is told holds of each."""

from dataclasses import replace

import pytest
import sympy as sp
from closedform.derivations.delta import d, legs
from closedform.derivations.five_bar import d as five_bar

from closedform.emit.backends.latex.subject import Subject
from closedform.model.alike import alike, renamed, with_index
from closedform.model.functions import real

DECLARED = [j.symbol for j in d.joints] + [p.symbol for p in d.parameters]
SIGNS = [real(f"sigma_leg{k}") for k in (1, 2, 3)]
TARGET = {"x": "0.02", "y": "-0.03", "z": "-0.28"}


@pytest.mark.parametrize(
    ("names", "index"),
    [
        (("theta1", "theta2"), "theta_i"),
        (("A_11", "A_21"), "A_i1"),
        (("sigma_leg1", "sigma_leg2"), "sigma_leg_i"),
        (("R_1", "R_2"), "R_i"),
    ],
)
def test_the_number_of_a_part_gives_way_to_the_index(names: tuple[str, ...], index: str) -> None:
    found = with_index([real(n, nonnegative=True) for n in names])
    assert found.name == index and found.is_nonnegative


def test_legs_are_alike_if_they_differ_in_names_alone() -> None:
    found = alike("leg", legs, DECLARED, SIGNS)
    assert found is not None and found == d.alike
    assert [str(s) for s in found.any_part] == ["theta_i", "alpha_i", "sigma_leg_i"]
    longer = [*legs[:2], replace(legs[2], length=2 * legs[2].length)]
    assert alike("leg", longer, DECLARED, SIGNS) is None
    crossed = [*legs[:2], renamed(legs[2], {DECLARED[2]: DECLARED[1]})]
    assert alike("leg", crossed, DECLARED, SIGNS) is None
    assert five_bar.alike is None


def test_what_is_told_of_leg_i_is_what_each_leg_computes() -> None:
    function = d["ik"]
    told = Subject.of(d, function)
    assert told.each == r"each leg $i = 1,\ 2,\ 3$" and d.alike is not None
    given = {p.symbol: p.value for p in d.parameters}
    given |= {s: sp.Rational(TARGET[str(s)]) for s in function.symbols}
    theta, alpha, sigma = d.alike.any_part
    assert told.function.entries == (theta,) and len(told.function.branches or ()) == 2
    for leg, (_, direction, sign) in enumerate(d.alike.symbols):
        for value in (1, -1):
            (found,) = told.function.values({sigma: value})
            wanted = function.values({**dict.fromkeys(SIGNS, 1), sign: value})[leg]
            place = given | {alpha: given[direction]}
            assert sp.N(found.xreplace(place)) == pytest.approx(sp.N(wanted.xreplace(given)))


def test_the_lemma_of_leg_i_solves_its_equation() -> None:
    told = Subject.of(d, d["ik"])
    assert told.inverse is not None and d.alike is not None
    (link,) = told.inverse.links
    assert link.unknowns == (d.alike.any_part[0],) and len(told.solved) == 1
    held = {s for e in link.equations for s in e.free_symbols}
    assert not held & {s for row in d.alike.symbols for s in row}


def test_a_truth_value_is_that_of_all_legs() -> None:
    told = Subject.of(d, d["workspace_contains"])
    assert told.each and told.function.outputs == d["workspace_contains"].outputs


@pytest.mark.parametrize("name", ["fk", "jacobian", "determinant"])
def test_what_no_leg_computes_alone_is_told_as_a_whole(name: str) -> None:
    told = Subject.of(d, d[name])
    assert not told.each and told.function is d[name]


def test_what_is_singular_in_several_legs_is_said_once() -> None:
    notes = [n for n in d["ik"].notes if "is free" in n]
    assert notes == [
        "SINGULAR: a rod ends on the axis of its crank; theta1, theta2 or theta3 is free, 0 is "
        "returned.",
        "SINGULAR: a crank has no length; theta1, theta2 or theta3 is free, 0 is returned.",
    ]
