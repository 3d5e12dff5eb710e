"""The checker of certificates: what it accepts, and that it refuses whatever was tampered with."""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import sympy as sp
from sympy import Abs, acos, asin, atan, atan2, cos, pi, sin, sqrt, tan

from closedform import verify
from closedform.algebra.certificates import add_inverse, point, recording
from closedform.algebra.normal_form import decide
from closedform.algebra.solutions import InfinitelyManyError, count_solutions

x, y, u, v = sp.symbols("x y u v", real=True)
l1, l2, l3 = sp.symbols("l1:4", positive=True)
t1, t2 = sp.symbols("theta1:3", real=True)

Document = dict[str, Any]

r, f = sqrt(x**2 + y**2), sp.Function("f")(x)

IDENTITIES: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "sum of angles": (sin(t1 + t2) - sin(t1) * cos(t2) - cos(t1) * sin(t2), ()),
    "half angle": (tan(t1 / 2) * (1 + cos(t1)) - sin(t1), ()),
    "fractions": (1 / (x - y) - 1 / (x + y) - 2 * y / (x**2 - y**2), ()),
    "root": (1 / (r - x) - (r + x) / y**2, ()),
    "nested root": (sqrt(l1**2 * r + l1**2 * x) - l1 * sqrt(r + x), ()),
    "root of a number": ((sqrt(2) + sqrt(3)) ** 2 - 5 - 2 * sqrt(6), ()),
    "denominators that are numbers": (
        16 / (16 / (4 * sqrt(3) + 10) ** 2 + 1) - 16 * (37 + 20 * sqrt(3)) / (41 + 20 * sqrt(3)),
        (),
    ),
    "modulus": (Abs(x * y) - Abs(x) * Abs(y), ()),
    "direction": (sin(atan2(y, x) + t1) * r - y * cos(t1) - x * sin(t1), ()),
    "twice a direction": (cos(2 * atan2(y, x)) * (x**2 + y**2) - x**2 + y**2, ()),
    "arcs": (sin(acos(x) + asin(x)) - 1, ()),
    "arc of a tangent": (cos(t1 + atan(y)) * sqrt(1 + y**2) - cos(t1) + y * sin(t1), ()),
    "function": (f * (atan2(y, x) + 1) - f * atan2(y, x) - f, ()),
    "product in an angle": (sin(2 * x * y) - 2 * sin(x * y) * cos(x * y), ()),
    "assumption": (sqrt((x - y) ** 2) - x + y, (x - y,)),
    "assumed product": (sqrt(x**3 * y * l1) - x * sqrt(l1) * sqrt(x * y), (x, y)),
    "bounded sine": (sqrt((2 + sin(t1)) ** 2) - 2 - sin(t1), ()),
}  # fmt: skip

TWO_LINKS = [l1 * cos(t1) + l2 * cos(t1 + t2) - x, l1 * sin(t1) + l2 * sin(t1 + t2) - y]


def written(prove: Callable[[], Any]) -> Document:
    """What is recorded while something is proved, as it is read from a file."""
    with recording() as record:
        prove()
    assert not record.missing
    document: Document = json.loads(record.text("test", "digest"))
    return document


def two_links() -> None:
    counted = count_solutions(TWO_LINKS, [t1, t2])
    add_inverse("ik", 2, [(counted.certificate, 0)])


@pytest.fixture(scope="module")
def counted() -> Document:
    return written(two_links)


@pytest.mark.parametrize("name", IDENTITIES)
def test_an_identity_is_accepted(name: str) -> None:
    problem, assumed = IDENTITIES[name]
    document = written(lambda: decide(problem, assumed))
    assert [c["kind"] for c in document["certificates"]] == ["identity"]
    verify.check(document)


def test_counts_are_accepted(counted: Document) -> None:
    assert [c["kind"] for c in counted["certificates"]] == ["count", "inverse"]
    assert counted["certificates"][0]["count"] == 2
    verify.check(counted)


def test_a_count_with_denominators_given_values_and_merged_parameters_is_accepted() -> None:
    a, b, given = sp.symbols("a b given")
    for equations, unknowns, values, count in (
        ([1 / u - x, v * (u - v)], [u, v], {}, 2),
        ([u**2 - given], [u], {given: a**2 / (1 + b**2)}, 2),
        ([u**2 - 1, u - 2], [u], {}, 0),
        ([u * (a + b) - v, v**2 + (a + b)], [u, v], {}, 2),
        ([cos(t1) - cos(t2), sin(t1) - sin(t2)], [t1], {}, 1),
    ):
        document = written(
            lambda e=equations, n=unknowns, g=values: count_solutions(e, n, target_substitution=g)
        )
        assert document["certificates"][0]["count"] == count
        verify.check(document)


def test_infinitely_many_solutions_are_accepted() -> None:
    def prove() -> None:
        with pytest.raises(InfinitelyManyError):
            count_solutions([u * v - x], [u, v])

    document = written(prove)
    assert document["certificates"][0]["count"] is None
    verify.check(document)


def test_what_the_format_cannot_express_is_counted() -> None:
    with recording() as record:
        decide(sin(x + pi / 3) - sin(x) / 2 - sqrt(3) * cos(x) / 2)
    assert not record.certificates and sum(record.missing.values()) == 1


def test_a_basis_that_is_too_expensive_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("closedform.algebra.basis.LIMIT", 20)
    with recording() as record:
        two_links()
    assert not record.certificates and record.uncounted == ["ik"]
    assert sum(record.missing.values()) == 1


# Tampering, without a digest that would notice it at once


def changes(value: Any) -> Iterator[Any]:
    """Copies of a value with one thing changed: a number is another, an entry is dropped."""
    if isinstance(value, list):
        for i, item in enumerate(value):
            yield value[:i] + value[i + 1 :]
            for other in changes(item):
                yield [*value[:i], other, *value[i + 1 :]]
    elif isinstance(value, int):
        yield value + 1
        yield value - 1
    elif isinstance(value, str):
        number = set(value) <= set("-0123456789/")
        yield from (str(sp.Rational(value) + n) if number else "forged" for n in (1, -1))


def accepted(document: Document) -> bool:
    try:
        verify.check(document)
    except verify.Refused:
        return False
    return True


def with_certificate(document: Document, k: int, **content: Any) -> Document:
    certificates = list(document["certificates"])
    certificates[k] = {**certificates[k], **content}
    return {**document, "certificates": certificates}


def with_node(document: Document, k: int, node: list[Any]) -> Document:
    return {**document, "nodes": [*document["nodes"][:k], node, *document["nodes"][k + 1 :]]}


def intersection() -> None:
    counted = count_solutions([u**2 + v**2 - x, u * v - y], [u, v])
    add_inverse("ik", 4, [(counted.certificate, 0)])


@pytest.mark.parametrize("part", ["steps", "basis", "count", "equations"])
def test_no_number_of_a_count_can_be_changed(part: str) -> None:
    """Coefficients, exponents, multipliers, cofactors, and the entries of every list."""
    document = written(intersection)
    del document["certificates"][1]  # which would notice another count
    verify.check(document)
    for other in changes(document["certificates"][0][part]):
        assert not accepted(with_certificate(document, 0, **{part: other})), other


def test_no_number_of_an_inverse_can_be_changed() -> None:
    document = written(intersection)
    for part in ("branches", "counts", "per branch"):
        for other in changes(document["certificates"][1][part]):
            assert not accepted(with_certificate(document, 1, **{part: other})), other


def test_the_unknown_angles_cannot_be_changed() -> None:
    document = written(two_links)
    (certificate, _) = document["certificates"]
    for k, (node, row) in enumerate(certificate["angles"]):
        for other in changes(row):
            angles = [*certificate["angles"][:k], [node, other], *certificate["angles"][k + 1 :]]
            assert not accepted(with_certificate(document, 0, angles=angles)), angles
    for kind in ("name", "unknown", "angle"):
        generators = [[kind, *g[1:]] if g == ["circle"] else g for g in certificate["field"]]
        assert not accepted(with_certificate(document, 0, field=generators)), kind


@pytest.mark.parametrize("name", ["root", "nested root", "modulus", "assumption"])
def test_no_number_of_an_identity_can_be_changed(name: str) -> None:
    """The relation of a root, the value of a root, an assumption, the list of denominators."""
    problem, assumed = IDENTITIES[name]
    document = written(lambda: decide(problem, assumed))
    (certificate,) = document["certificates"]
    steps = certificate["field"]
    for k, step in enumerate(steps):
        if step[0] == "name":
            continue  # another order of the names of a statement is as good
        kept = [*steps[:k], *steps[k + 1 :]]
        assert not accepted(with_certificate(document, 0, field=kept)), step
        for other in changes(step):
            if other == ["root", [["-1", 0, 1, 1, 1]], 2]:
                continue  # the modulus of -f is that of f
            content = [*steps[:k], other, *steps[k + 1 :]]
            assert not accepted(with_certificate(document, 0, field=content)), other
    for k in range(len(certificate["assumed"])):
        kept = [*certificate["assumed"][:k], *certificate["assumed"][k + 1 :]]
        assert not accepted(with_certificate(document, 0, assumed=kept))
    for k in range(len(certificate["nonzero"])):
        kept = [*certificate["nonzero"][:k], *certificate["nonzero"][k + 1 :]]
        assert not accepted(with_certificate(document, 0, nonzero=kept))


@pytest.mark.parametrize("name", IDENTITIES)
def test_another_statement_is_refused(name: str) -> None:
    """Any number and any operation of the expression is another, or an operand is left out."""
    problem, assumed = IDENTITIES[name]
    document = written(lambda: decide(problem, assumed))
    (zero,) = document["certificates"][0]["zero"]
    op, *operands = document["nodes"][zero]
    for k in range(len(operands)):
        shorter = [op, *operands[:k], *operands[k + 1 :]]
        assert not accepted(with_node(document, zero, shorter))
    assert not accepted(with_node(document, zero, ["*", *operands]))
    assert not accepted(with_certificate(document, 0, zero=[]))


HARMLESS = {
    "of": "the name of the certificate, which only a fault repeats",
    "function": "the name of the inverse; its counts are checked, whatever it is called",
}
TAMPERED: dict[str, Callable[[], Any]] = {
    "intersection": intersection,
    "two links": two_links,
    **{n: lambda n=n: decide(*IDENTITIES[n]) for n in ("nested root", "modulus", "assumption")},
}  # fmt: skip


@pytest.mark.parametrize("name", TAMPERED)
def test_no_field_of_a_record_can_be_changed_or_dropped(name: str) -> None:
    """Every field that a record has, so that a new one cannot be forgotten here."""
    document = written(TAMPERED[name])
    for k, record in enumerate(document["certificates"]):
        for part in record.keys() - HARMLESS:
            for other in changes(record[part]):
                if multiple(part, record[part], other):
                    continue  # a multiple of a denominator vanishes where it does
                assert not accepted(with_certificate(document, k, **{part: other})), (part, other)
            others = {p: value for p, value in record.items() if p != part}
            certificates = [*document["certificates"][:k], others]
            certificates += document["certificates"][k + 1 :]
            assert not accepted({**document, "certificates": certificates}), part


def multiple(part: str, old: Any, new: Any) -> bool:
    """Whether the only change is the coefficient of a denominator of one term."""
    if part != "nonzero" or len(old) != len(new):
        return False
    (changed,) = [(a, b) for a, b in zip(old, new, strict=True) if a != b]
    return isinstance(changed[0], list) and (
        [term[1:] for term in changed[0]] == [term[1:] for term in changed[1]]
        and len(changed[0]) == 1
        and changed[1][0][0] != "0"
    )


# Certificates of what is false: each was accepted by a checker without the rule that refuses it


def certificate(nodes: list[Any], **content: Any) -> Document:
    empty: Document = {"assumed": [], "field": [], "nonzero": []}
    one = {"of": "a forgery", "kind": "identity", **empty, **content}
    written = [["number", node] if isinstance(node, str) else node for node in nodes]
    return {"format": verify.FORMAT, "nodes": written, "certificates": [one]}


X, Y = ["name", "x", 0], ["name", "y", 0]
PLUS_X, MINUS_X = [["1", 0, 1]], [["-1", 0, 1]]
ROOT_PLUS_X = [X, "2", ["^", 0, 2], ["sqrt", 2], ["+", 3, 0]]
ROOT_MINUS_X = [X, "-1", ["^", 0, 2], ["sqrt", 2], ["*", 1, 0], ["+", 3, 4]]
COSINE = [["name", "theta", 0], X, "-1", ["cos", 0], ["*", 2, 1], ["+", 3, 4]]
FORGERIES: dict[str, Document] = {
    "sqrt(x**2) = -x, because a root has the wrong sign": certificate(
        ROOT_PLUS_X, zero=[4], field=[["name", 0], ["value", 3, [[MINUS_X, 1]]]]
    ),
    "sqrt(x**2) = x, because x has no sign": certificate(
        ROOT_MINUS_X, zero=[5], field=[["name", 0], ["value", 3, [[PLUS_X, 1]]]]
    ),
    "sqrt(x**2) = -x, because x is assumed not to be negative": certificate(
        ROOT_PLUS_X,
        zero=[4],
        assumed=[0],
        field=[["name", 0], ["known", 0, PLUS_X, []], ["value", 3, [[MINUS_X, 1]]]],
    ),
    "sqrt(x**2) = x, because x is said to be assumed": certificate(
        ROOT_MINUS_X,
        zero=[5],
        field=[["name", 0], ["known", 0, PLUS_X, []], ["value", 3, [[PLUS_X, 1]]]],
    ),
    "sqrt(x**2) = x, because x is the radicand of a root elsewhere": certificate(
        [*ROOT_MINUS_X, ["sqrt", 0]],
        zero=[5],
        field=[["name", 0], ["known", 6, PLUS_X, []], ["value", 3, [[PLUS_X, 1]]]],
    ),
    "sqrt(x**2) = x, because x**2 = x*x and x is not negative": certificate(
        ROOT_MINUS_X,
        zero=[5],
        field=[["name", 0], ["known", 3, PLUS_X, [[PLUS_X, 1]]], ["value", 3, [[PLUS_X, 1]]]],
        nonzero=[PLUS_X],
    ),
    "sqrt(x**2) = x, because x is a factor of another power": certificate(
        ROOT_MINUS_X,
        zero=[5],
        field=[["name", 0], ["known", 3, PLUS_X, [[PLUS_X, 2]]], ["value", 3, [[PLUS_X, 1]]]],
        nonzero=[PLUS_X],
    ),
    "abs(x) = 1, because a root has another square": certificate(
        [X, ["abs", 0], "-1", ["+", 1, 2]], zero=[3], field=[["name", 0], ["value", 1, []]]
    ),
    "abs(x*y) = x*y, because x**2*y is assumed not to be negative": certificate(
        [X, Y, ["^", 0, 2], ["*", 2, 1], ["*", 0, 1], ["abs", 4], "-1", ["*", 6, 4], ["+", 5, 7]],
        zero=[8],
        assumed=[3],
        field=[
            ["name", 0],
            ["name", 1],
            ["known", 3, [["1", 1, 1]], [[PLUS_X, 2]]],
            ["value", 5, [[[["1", 0, 1, 1, 1]], 1]]],
        ],
        nonzero=[PLUS_X],
    ),
    "abs(y) = y, also where x = 0, because x**2*y is assumed not to be negative": certificate(
        [X, Y, ["^", 0, 2], ["*", 2, 1], ["abs", 1], "-1", ["*", 5, 1], ["+", 4, 6]],
        zero=[7],
        assumed=[3],
        field=[
            ["name", 0],
            ["name", 1],
            ["known", 3, [["1", 1, 1]], [[PLUS_X, 2]]],
            ["value", 4, [[[["1", 1, 1]], 1]]],
        ],
    ),
    "sqrt(x**2) = -x, because another root is imaginary": certificate(
        ROOT_PLUS_X,
        zero=[4],
        field=[["name", 0], ["root", MINUS_X, 1], ["value", 3, [[[["1", 1, 1]], 2]]]],
    ),
    "sqrt(x**2) = -x, because x is assumed not to be positive where 0 >= 0": certificate(
        [*ROOT_PLUS_X, "0"],
        zero=[4],
        assumed=[5],
        field=[["name", 0], ["known", 5, MINUS_X, [[[], 2]]], ["value", 3, [[MINUS_X, 1]]]],
    ),
    "cos(atan2(0, x)) = 1, because a length is negative": certificate(
        [X, "0", ["atan2", 1, 0], ["cos", 2], "-1", ["+", 3, 4]],
        zero=[5],
        field=[["name", 0], ["value", 2, [[PLUS_X, 1]]]],
        nonzero=[PLUS_X],
    ),
    "sqrt((1 + 2*sin(x))**2) = 1 + 2*sin(x)": certificate(
        [
            X,
            ["sin", 0],
            "2",
            ["*", 2, 1],
            "1",
            ["+", 4, 3],
            ["abs", 5],
            "-1",
            ["*", 7, 5],
            ["+", 6, 8],
        ],
        zero=[9],
        field=[["angle", 0, 1], ["value", 5, [[[["1"], ["2", 1, 1]], 1]]]],
    ),
    "cos(x) = 1, because the angle is divided by zero": certificate(
        [X, "-1", ["cos", 0], ["+", 2, 1]], zero=[3], field=[["angle", 0, 0]]
    ),
    "x = 0, because of a relation of its own": certificate(
        [X], zero=[0], field=[["name", 0], ["root", [["1", 0, 1], ["-1", 1, 1]], 1]]
    ),
    "atan2(x, x) = sin(x), because an inverse function has no generator": certificate(
        [X, ["atan2", 0, 0], ["sin", 0], "-1", ["*", 3, 2], ["+", 1, 4]],
        zero=[5],
        field=[["name", 0], ["angle", 0, 1]],
        nonzero=[[["1", 0, 1]]],
    ),
    "sin(x + 2) = sin(2*x), because a number is an angle": certificate(
        [X, "2", ["+", 0, 1], ["sin", 2], ["*", 1, 0], ["sin", 4], "-1", ["*", 6, 5], ["+", 3, 7]],
        zero=[8],
        field=[["angle", 0, 1]],
    ),
    "cos(x/2) = 1, because the angle is not divided enough": certificate(
        [X, "1/2", ["*", 1, 0], ["cos", 2], "-1", ["+", 3, 4]],
        zero=[5],
        field=[["angle", 0, 1]],
    ),
    "cos(atan2(0, -x**2)/2) = 1, because half an angle is none": certificate(
        [
            X,
            "-1",
            "1/2",
            "0",
            ["^", 0, 2],
            ["*", 1, 4],
            ["atan2", 3, 5],
            ["*", 2, 6],
            ["cos", 7],
            ["+", 8, 1],
        ],
        zero=[9],
        field=[["name", 0]],
    ),
    "cos(2*x*y) = cos(2*x), because a factor is dropped": certificate(
        [
            X,
            Y,
            "2",
            ["*", 2, 0, 1],
            ["cos", 3],
            ["*", 2, 0],
            ["cos", 5],
            "-1",
            ["*", 7, 6],
            ["+", 4, 8],
        ],
        zero=[9],
        field=[["angle", 0, 1]],
    ),
    "tan(x) = cos(x), because every function is one": certificate(
        [X, ["tan", 0], ["cos", 0], "-1", ["*", 3, 2], ["+", 1, 4]],
        zero=[5],
        field=[["angle", 0, 1]],
    ),
    "sqrt(1) = -1, because a relation has a denominator": certificate(
        [["name", "x", -1], "1", ["sqrt", 1], ["+", 2, 1]],
        zero=[3],
        field=[["name", 0], ["root", MINUS_X, -1], ["value", 2, [[[["1", 1, 1]], 2]]]],
        nonzero=[PLUS_X],
    ),
    "a sign that is none": certificate([["name", "x", 2], "0"], zero=[1]),
    "a function that is none": certificate(["1", ["exp", 0]], kind="point", matrix=[[1]], at=[]),
    "x/x = 0, because of a circle of nodes": certificate([["*", 0, 0]], zero=[0]),
    "a node that holds a later one": certificate([["*", 1, 1], "0"], zero=[0]),
    "another format": {**certificate(["0"], zero=[0]), "format": verify.FORMAT + 1},
    "branches that are counted by the inverse itself": certificate(
        ["0"], kind="inverse", counts=[[0, 0]], branches=2, count=2, **{"per branch": 1}
    ),
    "x/0 = 0": certificate(["0", ["^", 0, -1], ["*", 0, 1]], zero=[2]),
    "no solutions, because a relation is one of an identity": certificate(
        [X, ["^", 0, 2], "-1", ["+", 1, 2]],
        kind="count",
        equations=[3],
        given=[],
        angles=[],
        field=[["unknown", 0], ["root", [["2"]], 1]],
        steps=[],
        basis=[1],
        count=0,
    ),
    "two names for one quantity": certificate([["name", "x", 1], ["name", "x", -1], "0"], zero=[2]),
    "no solutions, because an element of the basis is zero": certificate(
        [X, ["^", 0, 2], "-1", ["+", 1, 2]],
        kind="count",
        equations=[3],
        given=[],
        angles=[],
        field=[["unknown", 0]],
        steps=[[[["1"]], [], []]],
        basis=[1],
        count=0,
    ),
    "no solutions, because a multiplier contains the unknown": certificate(
        [X, ["^", 0, 2], "-1", ["+", 1, 0]],
        kind="count",
        equations=[3],
        given=[],
        angles=[],
        field=[["unknown", 0]],
        steps=[[[["1", 0, 1]], [["1", 0, 1], ["1"]], [[0, [["1"]]]]]],
        basis=[1],
        count=1,
    ),
    "too many solutions, because the basis is not that of the system": certificate(
        [X, ["^", 0, 2], "-1", ["+", 1, 2], ["+", 0, 2]],
        kind="count",
        equations=[3, 4],
        given=[],
        angles=[],
        field=[["unknown", 0]],
        steps=[],
        basis=[0],
        count=2,
    ),
    "too many solutions, because the basis has an S-polynomial": certificate(
        [
            X,
            ["name", "y", 0],
            "-1",
            ["*", 0, 1],
            ["^", 0, 2],
            ["^", 1, 2],
            ["+", 3, 2],
            ["+", 4, 2],
        ],
        kind="count",
        equations=[6, 7, 5],
        given=[],
        angles=[],
        field=[["unknown", 0], ["unknown", 1]],
        steps=[],
        basis=[0, 1, 2],
        count=3,
    ),
    "four angles of one cosine, because the angle is doubled": certificate(
        COSINE,
        kind="count",
        equations=[5],
        given=[],
        angles=[[0, [2]]],
        field=[["name", 1], ["circle"]],
        steps=[],
        basis=[0, 1],
        count=4,
    ),
    "infinitely many angles, because a circle is free": certificate(
        COSINE,
        kind="count",
        equations=[5],
        given=[],
        angles=[[0, [1]]],
        field=[["name", 1], ["circle"], ["circle"]],
        steps=[],
        basis=[0, 1, 2],
        count=None,
    ),
    "infinitely many angles, because one angle is given two values": certificate(
        [*COSINE, ["name", "phi", 0]],
        kind="count",
        equations=[5],
        given=[],
        angles=[[0, [1, 0]], [0, [0, 1]]],
        field=[["name", 1], ["circle"], ["circle"]],
        steps=[],
        basis=[0, 1, 2],
        count=None,
    ),
    "two angles of one cosine, because twice the angle is the unknown": certificate(
        [X, "-1", Y, "2", ["*", 3, 2], ["cos", 4], ["*", 1, 0], ["+", 5, 6]],
        kind="count",
        equations=[7],
        given=[],
        angles=[[4, [1]]],
        field=[["name", 0], ["circle"]],
        steps=[],
        basis=[0, 1],
        count=2,
    ),
    "u = 0 and u = 1 from u**2/u - u**3/u**2 = 0, because a denominator is dropped": certificate(
        [X, ["^", 0, 2], ["^", 0, 3], ["^", 0, -1], "-1", ["*", 1, 4], ["+", 2, 5], ["*", 6, 3]],
        kind="count",
        equations=[7],
        given=[],
        angles=[],
        field=[["unknown", 0]],
        steps=[],
        basis=[0],
        count=2,
    ),
    "a name that is given itself": certificate(
        [X],
        kind="count",
        equations=[0],
        given=[[0, 0]],
        angles=[],
        field=[],
        steps=[],
        basis=[],
        count=1,
    ),
    "one solution, because the equation is given another value": certificate(
        [X, ["^", 0, 2], "-1", ["+", 1, 2]],
        kind="count",
        equations=[3],
        given=[[3, 0]],
        angles=[],
        field=[["unknown", 0]],
        steps=[],
        basis=[0],
        count=1,
    ),
    "a singular matrix": certificate(
        [X, "0", "1"], kind="point", matrix=[[0, 1], [0, 1]], at=[[0, 2]]
    ),
    "no matrix": certificate([X, "1"], kind="point", matrix=[], at=[[0, 1]]),
    "a length that is negative": certificate(
        [["name", "l", 1], "-1"], kind="point", matrix=[[0]], at=[[0, 1]]
    ),
    "x without a value": certificate([X], kind="point", matrix=[[0]], at=[]),
    "x with two values": certificate(
        [X, "1", "0"], kind="point", matrix=[[0]], at=[[0, 2], [0, 1]]
    ),
    "0 = 1, because an expression is given a value": certificate(
        ["0", "1"], kind="point", matrix=[[0]], at=[[0, 1]]
    ),
    "x + 1 = 0 differs from zero, because a sum is given a value": certificate(
        [X, "1", ["+", 0, 1]], kind="point", matrix=[[2]], at=[[2, 1]]
    ),
    "(1/0)**0 differs from zero": certificate(
        ["0", ["^", 0, -1], ["^", 1, 0]], kind="point", matrix=[[2]], at=[]
    ),
    "a point at which an assumption does not hold": certificate(
        [X, "-1"], kind="point", matrix=[[0]], at=[[0, 1]], assumed=[0]
    ),
    "1 + 0/0 differs from zero": certificate(
        [X, "0", ["^", 0, -1], ["*", 2, 0], "1", ["+", 3, 4]],
        kind="point",
        matrix=[[5]],
        at=[[0, 1]],
    ),
    "1 + 0*sqrt(-1) differs from zero": certificate(
        ["-1", "0", "1", ["sqrt", 0], ["*", 1, 3], ["+", 2, 4]],
        kind="point",
        matrix=[[5]],
        at=[],
    ),
    "1 + atan2(0, 0) differs from zero": certificate(
        ["0", "1", ["atan2", 0, 0], ["+", 1, 2]], kind="point", matrix=[[3]], at=[]
    ),
    "cos(pi/2) differs from zero": certificate(
        ["1/2", ["pi"], ["*", 0, 1], ["cos", 2]], kind="point", matrix=[[3]], at=[]
    ),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forgery_is_refused(name: str) -> None:
    with pytest.raises(verify.Refused):
        verify.check(FORGERIES[name])


def refutation() -> None:
    """An identity with a wrong sign, in an angle, a length, a root and an inverse function."""
    wrong = l1 * sin(t1) - sqrt(l1**2 + 1) * atan2(l2, l1) + tan(t1) ** 2
    assert not decide(wrong, (l1 - l2,)).holds


def test_a_refutation_is_a_point_that_is_evaluated() -> None:
    document = written(refutation)
    (refuted,) = document["certificates"]
    assert refuted["kind"] == "point" and len(refuted["matrix"]) == 1
    assert len(refuted["at"]) == 3 and len(refuted["assumed"]) == 1
    verify.check(document)


def test_the_point_of_a_refutation_cannot_be_tampered_with() -> None:
    """A value left out, of another sign or of no name; another node that vanishes; no matrix."""
    document = written(refutation)
    (refuted,) = document["certificates"]
    zero, negative = len(document["nodes"]), len(document["nodes"]) + 1
    document["nodes"] += ["0", "-7"]
    lengths = [k for k, (name, _) in enumerate(refuted["at"]) if document["nodes"][name][2] > 0]
    assert len(lengths) == 2
    at = refuted["at"]
    for k, (name, value) in enumerate(at):
        for other in ([], [[value, value]], [[name, value], [name, value]], [[name, zero + 9]]):
            content = [*at[:k], *other, *at[k + 1 :]]
            assert not accepted(with_certificate(document, 0, at=content)), content
        if k in lengths:
            content = [*at[:k], [name, negative], *at[k + 1 :]]
            assert not accepted(with_certificate(document, 0, at=content)), content
    for matrix in ([], [[]], [[zero]], [[zero + 9]], [refuted["matrix"][0] * 2]):
        assert not accepted(with_certificate(document, 0, matrix=matrix)), matrix
    for assumed in ([negative], [zero + 9]):
        assert not accepted(with_certificate(document, 0, assumed=assumed)), assumed


def test_the_rows_of_a_rank_are_chosen_so_that_they_are_independent() -> None:
    with recording() as record:
        point([[x, y], [2 * x, 2 * y], [0, sqrt(x)]], {x: sp.Rational(1, 3), y: sp.S(2)}, "rank")
    assert not record.missing and len(record.certificates[0]["matrix"]) == 2
    verify.check(json.loads(record.text("test", "digest")))
    with recording() as record:
        point([[x, y], [2 * x, 2 * y]], {x: sp.S(1), y: sp.S(2)}, "rank")
    assert not record.certificates and record.missing == {"rank": 1}


# The checker itself


def test_the_checker_imports_nothing_of_the_prover() -> None:
    text = Path(verify.__file__).read_text("utf-8")
    modules = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert not node.level
            modules.add(node.module or "")
    assert modules <= {
        "__future__",
        "collections.abc",
        "functools",
        "itertools",
        "math",
        "typing",
        "flint",
    }
