"""Rods that are written as bodies with two points, and pairs of rods that are parallelograms."""

from pathlib import Path

import pytest
from loop_files import script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
FIVE_BAR = """
hand = "P"
[bodies]
ground = {A = [0, 0], B = ["g", 0]}
crank1 = {A = [0, 0], C = ["l", 0]}
crank2 = {B = ["g", 0], D = ["g + l", 0]}
rod1 = {length = "r"}
rod2 = {length = "r"}
[joints]
theta1 = {between = ["ground", "crank1"], at = "A", driven = true}
theta2 = {between = ["ground", "crank2"], at = "B", driven = true}
c = {between = ["crank1", "rod1"], at = "C"}
f = {between = ["crank2", "rod2"], at = "D"}
p = {between = ["rod1", "rod2"], at = "P"}
"""
FOUR_BAR = """
hand = "psi"
[bodies]
ground = {O = [0, 0], C = ["g", 0]}
crank = {O = [0, 0], A = ["r", 0]}
coupler = {length = "l"}
rocker = {C = ["g", 0], B = ["g + s", 0]}
[joints]
theta = {between = ["ground", "crank"], at = "O", driven = true}
psi = {between = ["ground", "rocker"], at = "C"}
a = {between = ["crank", "coupler"], at = "A"}
b = {between = ["coupler", "rocker"], at = "B"}
"""
DELTA = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = ["f", 0, 0]}
hand = {P = [0, 0, 0], C1 = ["e", 0, 0]}
crank1 = {B1 = ["f + L", 0, 0]}
rod1 = {length = "l", parallelogram = [0, "w", 0]}
[joints]
theta1 = {between = ["ground", "crank1"], at = "A1", axis = [0, 1, 0], driven = true}
b1 = {between = ["crank1", "rod1"], at = "B1"}
c1 = {between = ["rod1", "hand"], at = "C1"}
"""
PAIRS = (
    DELTA.replace('C1 = ["e", 0, 0]', 'C1 = ["e", "w/2", 0], D1 = ["e", "-w/2", 0]')
    .replace('B1 = ["f + L", 0, 0]', 'B1 = ["f + L", "w/2", 0], E1 = ["f + L", "-w/2", 0]')
    .replace(', parallelogram = [0, "w", 0]}', '}\nother1 = {length = "l"}')
    .replace('at = "B1"}', 'at = "B1", kind = "spherical"}')
    .replace('at = "C1"}', 'at = "C1", kind = "spherical"}')
    + """
e1 = {between = ["crank1", "other1"], at = "E1", kind = "spherical"}
f1 = {between = ["other1", "hand"], at = "D1", kind = "spherical"}
"""
)
TRIPTERON = (FOLDER / "tripteron.toml").read_text("utf-8")
HEXA = (FOLDER / "hexa.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("text", "rods"),
    [
        (FIVE_BAR, {"rod1": 'C = [0, 0], P = ["r", 0]', "rod2": 'D = [1, 0], P = [1, "-r"]'}),
        (FIVE_BAR, {"rod2": 'D = ["3*r/5", 0], P = [0, "4*r/5"]'}),
        (FOUR_BAR, {"coupler": 'A = [0, 0], B = ["l", 0]'}),
        (DELTA, {"rod1": 'B1 = [0, 0, 0], C1 = [0, 0, "-l"], parallelogram = [0, "w", 0]'}),
        (TRIPTERON, {"upper1": 'B = [0, 0, 0], E = [0, "l", 0]'}),
        (TRIPTERON, {"lower2": 'E = [0, 0, 0], Y = [0, 0, "r"]'}),
        (HEXA, {f"rod{k}": f'B{k} = [0, 0, 0], C{k} = [0, 0, "r"]' for k in (1, 2)}),
    ],
)
def test_a_rod_may_have_two_points(text: str, rods: dict[str, str], tmp_path: Path) -> None:
    lines = text.splitlines()
    for rod, points in rods.items():
        (k,) = (k for k, line in enumerate(lines) if line.startswith(f"{rod} = "))
        lines[k] = f"{rod} = {{{points}}}"
    written = "\n".join(lines)
    assert script_of("same", written, tmp_path) == script_of("same", text, tmp_path)


def test_two_rods_of_a_leg_are_a_parallelogram(tmp_path: Path) -> None:
    turned = DELTA.replace('[0, "w", 0]', '[0, "-w", 0]')  # from the first rod to the other one
    one, two = (script_of("same", text, tmp_path).split("\nL = ") for text in (turned, PAIRS))
    told = " ".join(two[0].replace('"', " ").split())
    assert "The rods rod1 and other1 are the long sides of a parallelogram." in told
    assert two[1] == one[1]


@pytest.mark.parametrize(
    ("old", "other"),
    [
        ('other1 = {length = "l"}', 'other1 = {length = "2*l"}'),
        ('D1 = ["e", "-w/2", 0]', 'D1 = ["e", "-w", 0]'),
        ('D1 = ["e", "-w/2", 0]', 'D1 = ["e", "-w/2", "w"]'),
    ],
)
def test_other_rods_of_a_leg_say_why(old: str, other: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match="are equally long, and are as far apart on it"):
        script_of("same", PAIRS.replace(old, other), tmp_path)
