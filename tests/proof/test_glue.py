"""Links and the glue between them: what is missing or wrong in either is found."""

import dataclasses

import pytest
import sympy as sp

from closedform.lemmas.sine_cosine import sine_cosine
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import Program, branches, choose, real
from closedform.model.inverse import Combination, Degenerate, Inverse, Link
from closedform.model.pair import Pair
from closedform.proof.inverse import prove_inverse
from closedform.proof.require import ProofError

PAPER = Paper("crank", "A crank", ("A. Nonymous",))
CHOICE = branches((real("hand"), {+1: "left", -1: "right"}))  # no name of a sign is special


def crank(side: int = 1, off: sp.Expr = sp.S.Zero) -> tuple[Derivation, Inverse]:
    """A joint by ``a sin t + b cos t = c``; ``side`` is the size of its sign, ``off`` an error."""
    d = Derivation("crank", "Crank", PAPER, "A crank.", task=["c"])
    a, b = (d.parameter(n, value=1, unit="m", meaning="length") for n in "ab")
    t, c, p = d.joint("t"), real("x_c"), Program()
    lemma = sine_cosine(p, t, (a, b, c), p.let("side", side * real("hand")))
    d.branches = CHOICE.labels
    answer = [lemma[t] + off]
    d.function(
        "ik", "Inverse.", {"x": [c]}, {"q": answer}, program=p, branches=CHOICE, result="Solutions"
    )
    forward = (a * sp.sin(t) + b * sp.cos(t),)
    links, glue = (Link.of(lemma),), Combination(sp.eye(1), {t: t})
    return d, Inverse("ik", (t,), (c,), forward, links=links, glue=glue)


def test_lemmas_are_combined_to_the_system() -> None:
    d, inverse = crank()
    result = prove_inverse(d, inverse)
    assert (result.branches, result.method) == (2, "lemma by lemma")
    (t,) = inverse.unknowns
    wrong = dataclasses.replace(inverse, glue=Combination(sp.eye(1) * 2, {t: t}))
    with pytest.raises(ProofError, match="do not combine to the system"):
        prove_inverse(d, wrong)


def test_a_factor_that_may_vanish_does_not_combine_lemmas() -> None:
    """Where it vanishes, the system has solutions that the lemmas do not give."""
    d, inverse = crank()
    (t,), (c,), (f,) = inverse.unknowns, inverse.targets, inverse.forward
    more = dataclasses.replace(
        inverse,
        targets=(sp.S.Zero,),
        forward=(sp.sin(t) * (f - c),),
        glue=Combination(sp.Matrix([[sp.sin(t)]]), {t: t}),
    )
    with pytest.raises(ProofError, match="depends on what is solved for"):
        prove_inverse(d, more)


def test_a_matrix_that_forgets_equations_does_not_combine_lemmas() -> None:
    d, inverse = crank()
    (t,), targets = inverse.unknowns, inverse.targets
    none = dataclasses.replace(inverse, forward=targets, glue=Combination(sp.zeros(1), {t: t}))
    with pytest.raises(ProofError, match="is singular"):
        prove_inverse(d, none)


def test_a_sign_of_a_lemma_is_one_or_minus_one() -> None:
    with pytest.raises(ProofError, match=r"side, a sign of the lemma .*, is not 1 or -1"):
        prove_inverse(*crank(side=2))


def test_the_function_must_return_what_the_lemmas_give() -> None:
    with pytest.raises(ProofError, match="t is not what the lemmas give; the difference is -pi"):
        prove_inverse(*crank(off=sp.pi))


def test_glue_ties_lemmas_and_all_links_have_one_or_none() -> None:
    d, inverse = crank()
    assert prove_inverse(d, dataclasses.replace(inverse, glue=None)).solutions == 2
    shifted = dataclasses.replace(inverse, glue=None, forward=(inverse.forward[0] + 1,))
    with pytest.raises(ProofError, match="do not combine to the system"):
        prove_inverse(d, shifted)
    alone = (Link(inverse.unknowns, inverse.equations),)
    for wrong in (
        dataclasses.replace(inverse, links=alone),
        dataclasses.replace(inverse, links=inverse.links + alone),
    ):
        with pytest.raises(ProofError, match="either each link of an inverse has a lemma"):
            prove_inverse(d, wrong)


def test_a_degenerate_case_of_a_system() -> None:
    """On the axis of a polar arm its turn is free; the answer there is put into the equations."""
    d = Derivation("polar", "Polar", PAPER, "A turn and a slide.", task=["x", "y"])
    t, r = d.joint("t"), d.joint("r", "prismatic")
    x, y, hand, p = real("x_x"), real("x_y"), real("hand"), Program()
    length = p.let("length", sp.sqrt(x**2 + y**2), nonnegative=True)
    flag = p.vanishes("on_axis", length, 1, "the axis is met", free=(t,))
    d.branches = CHOICE.labels
    answer = [choose(flag, 0, sp.atan2(hand * y, hand * x)), hand * length]
    d.function(
        "ik",
        "Inverse.",
        {"x": [x, y]},
        {"q": answer},
        program=p,
        branches=CHOICE,
        result="Solutions",
    )
    forward = (r * sp.cos(t), r * sp.sin(t))
    case = Degenerate((flag,), {x: sp.S.Zero, y: sp.S.Zero}, t)
    inverse = Inverse("ik", (t, r), (x, y), forward, (case,))
    assert prove_inverse(d, inverse).continua == 1
    beside = dataclasses.replace(case, locus={x: sp.S.Zero, y: sp.S.One})
    with pytest.raises(ProofError, match=r"branch left, if on_axis: the answer, put into"):
        prove_inverse(d, dataclasses.replace(inverse, degenerate=(beside,)))


def test_the_order_of_a_pair() -> None:
    """A quarter turn has the sine 1; its unit vector points along y."""
    quarter = Pair(sp.S.One, sp.S.Zero)
    assert quarter.angle == sp.pi / 2
    assert list(quarter.unit) == [0, 1]
    assert Pair.of(sp.pi / 2) == quarter
    assert -quarter == Pair(-sp.S.One, sp.S.Zero)
    assert (quarter + quarter).angle == sp.pi
