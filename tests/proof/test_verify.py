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
            if record[part] == []:
                continue  # to have none is as good as not to say so
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


def test_the_checker_can_be_read_in_one_sitting() -> None:
    """It has fewer than 300 lines of code, which excludes docstrings, comments and blank lines."""
    text = Path(verify.__file__).read_text("utf-8")
    lines = {k for k, line in enumerate(text.splitlines(), 1) if line.split("#")[0].strip()}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            lines -= {*range(node.lineno, (node.end_lineno or node.lineno) + 1)}
    assert len(lines) < 300
