"""A hand that hinges let move along a line alone: a Sarrus linkage, from its file.

The other route keeps all plates of both legs, and lets the table turn: Newton's method closes them.
"""

from pathlib import Path

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.loops.file import read_loop
from closedform.scaffold.loops.script import loop_script

TEXT = (TESTS / "held_out_loops" / "sarrus.toml").read_text("utf-8")
A, C, L, R = 0.2, 0.15, 0.3, 0.28


def gaps(theta: float, unknown: np.ndarray) -> np.ndarray:
    """By how much the plates miss the table: its pose and the passive angle are unknown."""
    place, (u, v, w), angle = unknown[:3], unknown[3:6], unknown[6]
    half = np.array([[0, -w, v], [w, 0, -u], [-v, u, 0]]) / 2
    turn = np.linalg.solve(np.eye(3) - half, np.eye(3) + half)  # Cayley's form of a rotation
    found = []
    for k, q in enumerate((theta, angle)):
        out, normal = np.eye(3)[k], np.eye(3)[1 - k]
        elbow = (A + L * np.cos(q)) * out + [0, 0, L * np.sin(q)]
        rod = place + turn @ (C * out) - elbow
        found += [rod @ rod - R**2, rod @ normal, *np.cross(turn @ normal, normal)]
    return np.array(found)


def test_the_table_of_a_sarrus_linkage_moves_along_a_line(tmp_path: Path) -> None:
    loop = derived("sarrus", script_of("sarrus", TEXT, tmp_path), tmp_path)
    for theta in (0.8, 1.3, 2.0):
        travel, status = loop.fk([theta])
        assert not status.any()
        for [height] in travel:
            assert np.allclose(np.nanmin(abs(loop.ik([height]).q - theta)), 0, atol=1e-12)
            start = np.array([0.02, -0.01, height + 0.01, 0.03, 0.02, -0.02, theta + 0.05])
            pose = newton(lambda u, q=theta: gaps(q, u), start)
            assert pose is not None
            assert np.allclose(pose[:6], [0, 0, height, 0, 0, 0], atol=1e-9)


def text_with(*changes: tuple[str, str]) -> str:
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


def test_the_line_passes_where_the_legs_hold_the_table(tmp_path: Path) -> None:
    ends = ('A1 = ["a", 0, 0]', 'A1 = ["a", "c", 0]'), ('"a + l", 0, 0', '"a + l", "c", 0')
    moved = text_with(*ends)
    script = script_of("moved", moved, tmp_path)
    assert "Crank(theta, l, r, (a, c, 0), (1, 0, 0), (0, 0, 1))" in script
    assert "Slide(travel, r, (c, c, 0), (0, 0, 1))" in script


def test_a_leg_of_other_sizes_is_named(tmp_path: Path) -> None:
    path = tmp_path / "wide.toml"
    path.write_text(text_with(('upper2 = {length = "r"}', 'upper2 = {length = "2*r"}')), "utf-8")
    loop = read_loop(path)
    loop_script("wide", loop, path.name)
    assert "the leg of a2 is not examined" in loop.notes[0]


CYLINDER = [
    (", driven = true", ""),
    ("ground = {", "tube = {}\npiston = {}\nground = {O = [0, 0, 0], "),
    (
        "[joints]\n",
        """[joints]
f = {between = ["ground", "tube"], at = "O", kind = "universal"}
q = {between = ["tube", "piston"], at = "O", kind = "prismatic", driven = true}
g = {between = ["piston", "table"], at = "P", kind = "spherical"}
""",
    ),
]


def test_a_cylinder_may_be_in_line_with_the_table_that_it_lifts(tmp_path: Path) -> None:
    """Its foot is on the line: the rod of the slide has no distance from it."""
    script = script_of("jack", text_with(*CYLINDER), tmp_path)
    loop = derived("jack", script, tmp_path, crosscheck=True)
    q = np.array([[0.05], [0.3], [0.5]])
    travel, status = loop.fk(q)
    assert not status.any() and np.allclose(travel[..., 0], q * [-1, 1], atol=1e-15)
    assert np.allclose(loop.ik(travel).q[..., 0, 0], q)
    assert np.allclose(loop.jacobian(q)[..., 0, 0], [-1, 1])
    assert np.allclose(loop.jacobian([1e300])[..., 0, 0], [-1, 1])  # nothing is squared


def test_two_sliders_may_be_on_one_line(tmp_path: Path) -> None:
    text = """
hand = "x"
[bodies]
ground = {O = [0, 0]}
ram = {B = [0.1, 0]}
car = {A = [0, 0]}
rod = {length = 0.3}
[joints]
q = {between = ["ground", "car"], at = "O", kind = "prismatic", axis = [1, 0], driven = true}
a = {between = ["car", "rod"], at = "A"}
b = {between = ["rod", "ram"], at = "B"}
x = {between = ["ground", "ram"], at = "O", kind = "prismatic", axis = [1, 0]}
"""
    loop = derived("on_one_line", script_of("on_one_line", text, tmp_path), tmp_path)
    x, status = loop.fk([0.7])
    assert not status.any() and np.allclose(sorted(x.ravel()), [0.3, 0.9])
    assert np.allclose(np.sort(loop.ik([0.3]).q.ravel()), [0.1, 0.7])


# a third leg whose hinges are along the line
THIRD_LEG = [
    ("[bodies]\n", '[bodies]\nlower3 = {length = "l"}\nupper3 = {length = "r"}\n'),
    (
        "[joints]\n",
        """[joints]
a3 = {between = ["ground", "lower3"], at = "A1", axis = [0, 0, 1]}
b3 = {between = ["lower3", "upper3"], at = "B3", axis = [0, 0, 1]}
c3 = {between = ["upper3", "table"], at = "C1", axis = [0, 0, 1]}
""",
    ),
]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([('at = "A2", axis', 'at = "A2", driven = true, axis')], "one joint has to be driven"),
        (THIRD_LEG, "no place"),
    ],
)
def test_what_cannot_move_along_a_line_is_refused(
    changes: list[tuple[str, str]], message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=f"as in a Sarrus linkage.*{message}"):
        script_of("bad", text_with(*changes), tmp_path)
