"""Certificates of what is false, each accepted by a checker without the rule that refuses it."""

from __future__ import annotations

from typing import Any

import pytest

from closedform import verify

Document = dict[str, Any]


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
    "one branch, because nothing is counted": certificate(
        ["0"], kind="inverse", counts=[], branches=1, **{"per branch": 1}
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
    "two solutions of t*x**2 + x = 1 at t = 0, because t has a second number": certificate(
        [["name", "t", 0], X, ["^", 1, 2], ["*", 0, 2], "-1", ["+", 3, 1, 4], "0"],
        kind="count",
        equations=[5],
        given=[[-7, 6]],
        angles=[],
        field=[["name", 0], ["unknown", 1]],
        steps=[],
        basis=[0],
        count=2,
    ),
    "infinitely many solutions of x = 1, because x has two generators": certificate(
        [X, "-1", ["+", 0, 1]],
        kind="count",
        equations=[2],
        given=[],
        angles=[],
        field=[["unknown", 0], ["unknown", 0]],
        steps=[],
        basis=[0],
        count=None,
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
INVERSES: dict[str, Document] = {
    "four branches, because a count is used twice": {"branches": 4, "counts": [[0, 0], [0, 0]]},
    "four branches, because a count has a second number": {
        "branches": 4,
        "counts": [[0, 0], [-2, 0]],
    },
    "four branches, because less than nothing is excluded": {"branches": 4, "counts": [[0, -2]]},
    "one branch, because half a solution is excluded": {
        "branches": 1,
        "counts": [[0, 0.5]],
        "per branch": 1.5,
    },
    "four branches, each of half a solution": {
        "branches": 4,
        "counts": [[0, 0]],
        "per branch": 0.5,
    },
    "a negative number of branches": {"branches": -2, "counts": [[0, 0]], "per branch": -1},
    "no branch, because all solutions are excluded": {"branches": 0, "counts": [[0, 2]]},
    "one branch, because nothing is counted": {"branches": 1, "counts": []},
}
"""Inverses of a system with two solutions."""


@pytest.mark.parametrize("name", INVERSES)
def test_an_inverse_needs_its_counts(name: str) -> None:
    document = certificate(
        [X, ["^", 0, 2], "-1", ["+", 1, 2]],
        kind="count",
        equations=[3],
        given=[],
        angles=[],
        field=[["unknown", 0]],
        steps=[],
        basis=[0],
        count=2,
    )
    inverse: Document = {"kind": "inverse", "of": "ik", "function": "ik", "per branch": 1}
    right = {"branches": 2, "counts": [[0, 0]]}
    verify.check({**document, "certificates": [*document["certificates"], inverse | right]})
    forged = {**document, "certificates": [*document["certificates"], inverse | INVERSES[name]]}
    with pytest.raises(verify.Refused):
        verify.check(forged)


def test_a_factor_that_does_not_occur_is_no_denominator() -> None:
    """The power 0 of zero is 1: the checker must not divide by this zero for ever."""
    verify.check(
        certificate(
            [X, "-1", ["*", 1, 0], ["+", 0, 2]],
            zero=[3],
            assumed=[0],
            field=[["name", 0], ["known", 0, PLUS_X, [[[], 0]]]],
            nonzero=[PLUS_X],
        )
    )


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forgery_is_refused(name: str) -> None:
    with pytest.raises(verify.Refused):
        verify.check(FORGERIES[name])
