"""How scripts are laid out: no line is long, and nothing of them changes."""

import ast
from pathlib import Path

import pytest
from places import TESTS

from closedform.scaffold.new import new
from closedform.scaffold.source import LINE, fitted

LONG = [
    "p = ik.vector('p0', Matrix([[0, 0, -1], [1, 0, 0], [0, -1, 0]]) * (p - Matrix([[Rational(-59, "
    "50000000)], [Rational(-1787763, 50000000)], [Rational(995941, 20000000)]])))",
    "pair1 = ik.solve(spin, alpha4, R_rest, [{alpha3: (-R_last[0, k], -R_last[1, k]), alpha2: "
    "(-R_last[2, k]*(0), -R_last[2, k]*(1))} for k in (0, 1)])",
    "links = Links(lambda pair: Matrix([[0, 0, 1], [1, 0, 0], [0, 1, 0]]) * (turned(pair).T * p - "
    "Matrix([[Rational(677, 20000)], [0], [0]])), 3*sqrt(7511247649)/5000000, sqrt(1226)/1000)",
    "    return Matrix([[-1, 0, 0], [0, 0, 1], [0, 1, 0]]) * (turned(pair).T * p), Matrix([[0], "
    "[1], [0]]) * turned(other), -sqrt(x[0]**2 + x[1]**2) + 2*y/3",
    'd.no_inverse("none of its seven joints, if it is given, leaves a spherical wrist (such as '
    'this one, or that),  and two more that  are parallel or meet")',
    "alone = f(first_of_several_names_that_are_long, second_of_several_names_that_are_long)[0]**2 *"
    " (third_of_several_names,)",
    "x = {first_of_several_names_that_are_long: (second_of_several_names, -third_of_several_names),"
    " 1: 'a, (b'}",
]


@pytest.mark.parametrize("line", LONG)
def test_a_long_line_is_broken_and_says_the_same(line: str) -> None:
    rows = fitted(line)
    assert len(line) > LINE >= max(map(len, rows)) and len(rows) > 2
    if line.startswith(" "):
        line, rows = f"def f():\n{line}", ["def f():", *rows]
    assert ast.dump(ast.parse("\n".join(rows))) == ast.dump(ast.parse(line))


def test_a_comment_is_wrapped() -> None:
    line = "# " + "The inverse proposed for this structure. " * 4
    rows = fitted(line)
    assert all(row.startswith("# ") and len(row) <= LINE for row in rows)
    assert " ".join(row[2:] for row in rows) == line[2:].strip()


def test_no_line_of_a_script_is_long(tmp_path: Path) -> None:
    """They had up to 1000 characters: matrices of numbers, equations, reasons."""
    path = tmp_path / "arm.csv"
    path.write_text((TESTS / "held_out" / "s4_abb_2p8.csv").read_text("utf-8"), "utf-8")
    for text in (
        new("arm", "dh", path).text,
        new("romeo", "urdf", TESTS / "urdf" / "romeo_left_arm.urdf").text,
    ):
        assert max(map(len, text.splitlines())) <= LINE
        ast.parse(text)


@pytest.mark.parametrize(
    "text", ["q" * 150, "q" * 150 + " ", "abc " * 60, "a " + "q" * 150 + "  b"]
)
def test_a_text_is_the_same_in_several_lines(text: str) -> None:
    """A long word had no end, in a meaning or a unit without blanks."""
    line = f'x = d.parameter("x", meaning="{text}", unit="m")'
    broken = "\n".join(fitted(line))
    assert ast.dump(ast.parse(broken)) == ast.dump(ast.parse(line))
