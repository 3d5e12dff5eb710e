"""Each lemma is proved once, for symbolic coefficients, and a wrong one is not."""

import dataclasses

import pytest
import sympy as sp

from closedform.algebra.normal_form import positive_form
from closedform.algebra.solutions import rotation_parametrisation
from closedform.lemmas.circles import circle_intersection
from closedform.lemmas.parallelogram import parallelogram
from closedform.lemmas.sine_cosine import linear_pair, sine_cosine
from closedform.lemmas.triangle import Triangle
from closedform.lemmas.two_link import two_link_arm, two_link_arm_beside
from closedform.lemmas.two_sines import two_sines
from closedform.lemmas.zyz import zyz_angles
from closedform.mechanics.loops import eliminate, velocity_matrices
from closedform.mechanics.volumes import lens
from closedform.model.functions import Program, real
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma
from closedform.proof.links import prove_lemma
from closedform.proof.require import ProofError

x, y, z = (real(n) for n in ("x", "y", "z"))
a, b, c = (real(n) for n in "abc")
sigma = real("sigma")


def applied(name: str) -> tuple[Lemma, Program, dict]:
    """A lemma applied to symbols."""
    program = Program()
    if name == "linear pair":
        return linear_pair(x, a, b), program, {}
    if name == "sine and cosine":
        return sine_cosine(program, x, (a, b, c), sigma), program, {}
    if name == "triangle":
        first, second = (real(n, positive=True) for n in ("l1", "l2"))
        reach = real("r", positive=True)
        triangle = Triangle.from_reach(program, (first, second), reach, sigma)
        return triangle.lemma((x, y), reach), program, {}
    if name == "triangle by square":
        first, second = (real(n, positive=True) for n in ("l1", "l2"))
        square = real("r", positive=True) ** 2
        triangle = Triangle.from_square(program, (first, second), square, sigma)
        lemma, _ = triangle.stretched_without_link(program, (x, y), sp.sqrt(square))
        return lemma, program, {}
    lengths = tuple(real(n, positive=True) for n in ("l", "a", "b"))
    if name == "arm":
        lemma = two_link_arm(program, lengths, (a, b), (x, y), sigma)
        return lemma, Program(list(lemma.body)), {}
    if name == "arm beside another":
        f, N, M = (real(n, positive=True) for n in ("f", "N_0", "M_0"))
        lemma = two_link_arm_beside(
            program, lengths, (a, b), (x, y), sigma, second=f, squares=(N, M), scale=f
        )
        return lemma, Program(list(lemma.body)), {}
    if name == "two sines":
        u, v, p = ((real(f"{n}_1"), real(f"{n}_2")) for n in "uvp")
        lemma = two_sines(program, (x, y), (u, v), p, scale=real("size", positive=True))
        return lemma, Program(list(lemma.body)), {}
    if name == "parallelogram":
        crank, coupler = (real(n, positive=True) for n in ("l", "a"))
        return parallelogram((crank, coupler), (z, real("gamma")), (x, y), sigma), program, {}
    if name.startswith("circles"):
        r1, r2 = (real(n, positive=True) for n in ("r1", "r2"))
        second = r1 if name == "circles of one size" else r2
        lemma, _ = circle_intersection(program, (a, b), (r1, second), (x, y), sigma, scale=r1 + r2)
        return lemma, program, {}
    R = sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))
    given = dict(zip(R, rotation_parametrisation(), strict=True))
    return zyz_angles(program, R, (x, y, z), sigma).lemma, program, given


def prove(lemma: Lemma, program: Program, given: dict) -> None:
    link = Link.of(lemma, given)
    body = [s for s in program.body if s not in link.body]
    prove_lemma(dataclasses.replace(link, body=(*link.body, *body)), (), "")


NAMES = [
    "linear pair",
    "sine and cosine",
    "triangle",
    "triangle by square",
    "arm",
    "arm beside another",
    "two sines",
    "parallelogram",
    "zyz",
    "circles",
    "circles of one size",
]


@pytest.mark.parametrize("name", NAMES)
def test_sound_and_complete(name: str) -> None:
    prove(*applied(name))


@pytest.mark.parametrize("name", NAMES)
def test_a_wrong_solution_is_found(name: str) -> None:
    lemma, program, given = applied(name)
    unknown = next(iter(lemma.solution))
    wrong = {**lemma.solution, unknown: lemma.solution[unknown] + sp.pi / 6}
    with pytest.raises(ProofError, match="does not satisfy its equations"):
        prove(dataclasses.replace(lemma, solution=wrong), program, given)


@pytest.mark.parametrize("name", ["sine and cosine", "arm", "arm beside another", "two sines"])
def test_a_wrong_meaning_of_a_name_is_found(name: str) -> None:
    lemma, program, given = applied(name)
    handed = next(iter(lemma.means))
    wrong = {**lemma.means, handed: -lemma.means[handed]}
    with pytest.raises(ProofError, match="does not satisfy its equations"):
        prove(dataclasses.replace(lemma, means=wrong), program, given)


@pytest.mark.parametrize("name", NAMES)
def test_a_missing_branch_is_found(name: str) -> None:
    lemma, program, given = applied(name)
    with pytest.raises(ProofError, match="solutions"):
        prove(dataclasses.replace(lemma, branches=lemma.branches - 1), program, given)


def test_elimination_gives_the_factors() -> None:
    """The points of a line that are at distance 1 from some point of the unit circle."""
    u, v, t = (real(n) for n in "uvt")
    found = eliminate([u**2 + v**2 - 1, (u - t) ** 2 + v**2 - 1, v - c], (u, v))
    assert sp.factor(sp.prod(f**k for f, k in found.factors)).has(t)
    points = {sp.sqrt(4 - 4 * sp.Rational(1, 4)), sp.S.Zero}
    for point in points:
        assert found.vanishing([(t, point), (c, sp.Rational(1, 2))])
    with pytest.raises(ValueError, match="need 3 equations"):
        eliminate([u, v], (u, v))


def test_implicit_velocities_of_a_crank() -> None:
    """A slider at x, a bar of length b from it to a crank of length a."""
    F = (x - a * sp.cos(z)) ** 2 + (a * sp.sin(z)) ** 2 - b**2
    A, B = velocity_matrices([F], [x], [z])
    explicit = a * sp.cos(z) + sp.sqrt(b**2 - a**2 * sp.sin(z) ** 2)
    rate = (B[0] / A[0]).subs(x, explicit)
    assert sp.simplify(rate - explicit.diff(z)) == 0


def test_lens_of_two_balls() -> None:
    """Known: equal balls through each other's centres share 5/16 of a ball; balls that touch, 0."""
    r = real("r", positive=True)
    ball = sp.Rational(4, 3) * sp.pi * r**3
    assert sp.simplify(lens(r, r, r) - sp.Rational(5, 16) * ball) == 0
    assert sp.simplify(lens(r, 2 * r, 3 * r)) == 0
    assert sp.simplify(lens(r, 2 * r, r) - ball) == 0


def test_positive_form_refuses_what_is_not_evident() -> None:
    u, v = (real(n, positive=True) for n in "uv")
    assert positive_form(a - b, [(a, b + u), (b, v)]) == u
    with pytest.raises(ValueError, match="has a negative coefficient"):
        positive_form(u - v, [])
