"""What is said of mechanisms from the literature that are not derived, and what to do."""

from pathlib import Path

import numpy as np
import pytest
from loop_files import derived, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError

KNEE = """
hand = "P"
[bodies]
ground = {A = [0, 0], B = [0.04, 0.01], F = [0.05, 0.3]}
front = {length = 0.06}
rear = {length = 0.05}
shank = {C = [0, 0], D = [0.03, 0], E = [0.08, 0.02], P = [0, -0.4]}
tube = {}
piston = {}
[joints]
a = {between = ["ground", "front"], at = "A"}
b = {between = ["ground", "rear"], at = "B"}
c = {between = ["front", "shank"], at = "C"}
d = {between = ["rear", "shank"], at = "D"}
f = {between = ["ground", "tube"], at = "F"}
q = {between = ["tube", "piston"], at = "F", kind = "prismatic", driven = true}
e = {between = ["piston", "shank"], at = "E"}
"""
BAR = """
g = {between = ["front", "bar"], at = "C"}
h = {between = ["bar", "ground"], at = "F"}
"""
LIFT = (TESTS / "held_out_loops" / "folded_scissor.toml").read_text("utf-8")
LIFT = LIFT.replace('["bar1", "tube"], at = "E"', '["ground", "tube"], at = "R"')
LIFT = LIFT.replace("ground = {O", "ground = {R = [0.5, -0.1], O").replace(
    'at = "E", k', 'at = "R", k'
)
LEG = """
[bodies.t{k}]
[bodies.p{k}]
"""
LEGS = """
a{k} = {{between = ["ground", "t{k}"], at = "A{k}", kind = "universal"}}
q{k} = {{between = ["t{k}", "p{k}"], at = "A{k}", kind = "prismatic", driven = true}}
c{k} = {{between = ["p{k}", "spindle"], at = "C{k}", kind = "spherical"}}
"""
PENTAPOD = """
hand = "P"
[bodies]
ground = {A1 = [1, 0, 1], A2 = [0, 1, 1], A3 = [-1, 0, 1], A4 = [0, -1, 1], A5 = [0.7, 0.7, 0.2]}
[bodies.spindle]
P = [0, 0, 0]
C1 = [0, 0, 1]
C2 = [0, 0, 2]
C3 = [0, 0, 3]
C4 = [0, 0, 4]
C5 = [0, 0, 5]
"""
PENTAPOD += "".join(LEG.format(k=k) for k in range(1, 6))
PENTAPOD += "[joints]" + "".join(LEGS.format(k=k) for k in range(1, 6))
BENT = PENTAPOD.replace("C5 = [0, 0, 5]", "C5 = [0.5, 0, 5]")
SIX_BARS = (TESTS / "held_out_loops" / "stephenson_three.toml").read_text("utf-8")
OTHER_WAY = SIX_BARS.replace('"A", driven = true', '"A"').replace("\nq =", "\ntheta =")
OTHER_WAY = OTHER_WAY.replace('"G"}', '"G", driven = true}').replace('"psi"', '"theta"')
CRR = (TESTS / "held_out_loops" / "crr.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (KNEE, "degree 6; it can be solved if a or b is driven instead of q, whose length follows"),
        (
            KNEE.replace('hand = "P"', 'hand = "a"'),
            "if a or b is driven instead of q, whose length",
        ),
        (LIFT, "it can be solved if w or o is driven instead of q, whose length follows"),
        (KNEE.replace("rear = {", "bar = {length = 1}\nrear = {") + BAR, "q drives this linkage"),
        (
            OTHER_WAY,
            'driven.  Driven by theta, with hand = "psi", its fk is the inverse of this one',
        ),
        (BENT, "there are 5 driven joints; they leave it one freedom, .* all five legs end on one"),
        (CRR.replace("driven = true", "driven = false"), "is supported on the ground, with"),
        (CRR.replace('at = "O", kind', "kind"), "needs its axis, and at which point it is"),
        (CRR.replace('at = "O", kind', 'at = "Q", kind'), "ground has no point Q"),
    ],
)
def test_a_mechanism_without_a_formula_is_told_what_to_do(
    text: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=message):
        script_of("t", text, tmp_path)


def test_planes_that_share_another_line_are_told_of(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops" / "exechon.toml").read_text("utf-8")
    text = text.replace('kind = "universal", axis = [1, 0, 0]', "axis = [1, 0, 0]")
    text = text.replace(", axis = [0, 1, 0]}", ', kind = "spherical"}').replace(
        '"platform"], at = "C3", axis = [1, 0, 0]', '"platform"], at = "C3", kind = "spherical"'
    )
    text = text.replace('"A3", kind = "spherical"', '"A3", axis = [0, 0, 1]')
    with pytest.raises(TableError, match="has to contain the z axis; put the origin where"):
        script_of("t", text, tmp_path)


def test_a_cylindrical_joint_is_a_slide_and_a_turn(tmp_path: Path) -> None:
    """A 3-CRR mechanism, X. Kong and C. Gosselin (2002): each leg holds the hand in a plane."""
    script = script_of("crr", CRR, tmp_path)
    assert script.count("Plane(q") == 3 and "Slide(" not in script
    mechanism = derived("crr", script, tmp_path)
    p, status = mechanism.fk([0.1, 0.2, 0.3])  # the axes are those of x, y and z
    assert not status.any() and np.allclose(p, [0.1, 0.2, 0.3])


def test_a_delta_robot_on_cylinders_is_two_files(tmp_path: Path) -> None:
    """Cylinders push its arms; each of them and its arm are a loop in a plane."""
    text = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = [0.2, 0, 0], F1 = [0.2, 0, 0.3]}
arm1 = {A1 = [0.2, 0, 0], B1 = [0.5, 0, 0], L1 = [0.3, 0, 0]}
tube1 = {}
piston1 = {}
rod1 = {length = 0.6, parallelogram = [0, 0.1, 0]}
hand = {P = [0, 0, 0], C1 = [0.05, 0, 0]}
[joints]
a1 = {between = ["ground", "arm1"], at = "A1", axis = [0, 1, 0]}
f1 = {between = ["ground", "tube1"], at = "F1", axis = [0, 1, 0]}
q1 = {between = ["tube1", "piston1"], at = "F1", kind = "prismatic", driven = true}
l1 = {between = ["piston1", "arm1"], at = "L1", axis = [0, 1, 0]}
b1 = {between = ["arm1", "rod1"], at = "B1"}
c1 = {between = ["rod1", "hand"], at = "C1"}
"""
    with pytest.raises(TableError, match=r'Drive a1 here, and write .* with hand = "a1"'):
        script_of("t", text, tmp_path)


def test_a_spherical_mechanism_of_axes_alone_is_told_how_to_write_arcs(tmp_path: Path) -> None:
    text = """
hand = "P"
[bodies]
ground = {O = [0, 0, 0]}
arm1 = {}
arm2 = {}
link1 = {}
link2 = {O = [0, 0, 0], P = [0, 0, 1]}
[joints]
t1 = {between = ["ground", "arm1"], at = "O", axis = [1, 0, 0], driven = true}
t2 = {between = ["ground", "arm2"], at = "O", axis = [0, 1, 0]}
a = {between = ["arm1", "link1"], at = "O", axis = [0, 1, 0]}
b = {between = ["arm2", "link2"], at = "O", axis = [1, 0, 0]}
c = {between = ["link1", "link2"], at = "O", axis = [0, 0, 1]}
"""
    with pytest.raises(
        TableError, match=r"All axes meet in O, .* and hold the hand by a rod from O"
    ):
        script_of("t", text, tmp_path)


TWO_MOTORS = """
hand = "P"
copies = 3
[parameters]
b = {value = "0.3", meaning = "base"}
c = {value = "0.15", meaning = "hand"}
[bodies]
ground = {A1 = ["b", 0, 0]}
cart1 = {A1 = ["b", 0, 0]}
tube1 = {}
rod1 = {}
hand = {P = [0, 0, 0], C1 = ["c", 0, 0]}
[joints]
p1 = {between = ["ground", "cart1"], at = "A1", kind = "prismatic", axis = [0, 1, 0], driven = true}
r1 = {between = ["cart1", "tube1"], at = "A1", axis = [0, 1, 0]}
q1 = {between = ["tube1", "rod1"], at = "A1", kind = "prismatic", driven = true}
c1 = {between = ["rod1", "hand"], at = "C1", kind = "spherical"}
"""
TURRET = TWO_MOTORS.replace(
    'kind = "prismatic", axis = [0, 1, 0], driven', "axis = [0, 0, 1], driven"
)
BOTH_TURN = TURRET.replace("q1 =", "s1 =").replace('kind = "prismatic", driven = true', "SLIDE")
BOTH_TURN = BOTH_TURN.replace("r1 =", "q1 =").replace(
    '1", axis = [0, 1, 0]', '1", axis = [0, 1, 0], driven = true'
)
BOTH_TURN = BOTH_TURN.replace("SLIDE", "axis = [0, 1, 0]")
WITH_TOOL = """
hand = "P"
[parameters]
b = {value = "0.2", meaning = "base"}
l = {value = "0.3", meaning = "crank"}
r = {value = "0.6", meaning = "rod"}
[bodies]
ground = {A1 = ["b", 0, 0], A2 = [0, "b", 0], A3 = ["-b", 0, 0], Z = [0, 0, 0]}
crank1 = {B1 = ["b + l", 0, 0]}
crank2 = {B2 = [0, "b + l", 0]}
crank3 = {B3 = ["-b - l", 0, 0]}
rod1 = {length = "r", parallelogram = [0, 0.1, 0]}
rod2 = {length = "r", parallelogram = [0.1, 0, 0]}
rod3 = {length = "r", parallelogram = [0, 0.1, 0]}
plate = {N = [0, 0, 0], C1 = [0.05, 0, 0], C2 = [0, 0.05, 0], C3 = [-0.05, 0, 0]}
tool = {N = [0, 0, 0], P = [0, 0, -0.1]}
[joints]
q1 = {between = ["ground", "crank1"], at = "A1", axis = [0, 1, 0], driven = true}
q2 = {between = ["ground", "crank2"], at = "A2", axis = [1, 0, 0], driven = true}
q3 = {between = ["ground", "crank3"], at = "A3", axis = [0, 1, 0], driven = true}
b1 = {between = ["crank1", "rod1"], at = "B1"}
b2 = {between = ["crank2", "rod2"], at = "B2"}
b3 = {between = ["crank3", "rod3"], at = "B3"}
c1 = {between = ["rod1", "plate"], at = "C1"}
c2 = {between = ["rod2", "plate"], at = "C2"}
c3 = {between = ["rod3", "plate"], at = "C3"}
w = {between = ["plate", "tool"], at = "N", axis = [0, 0, 1], driven = true}
"""


@pytest.mark.parametrize(
    ("file", "told"),
    [
        (TWO_MOTORS.replace("axis = [0, 1, 0]}", "axis = [0, 0, 1]}"), "hold one of both motors"),
        (TURRET.replace("axis = [0, 1, 0]}", "axis = [0, 1, 1]}"), "turns the plane of the leg"),
        (
            TURRET.replace("cart1 = {A1", "cart1 = {D1 = [1, 1, 0], A1").replace(
                '"tube1"], at = "A1"', '"tube1"], at = "D1"'
            ),
            "r1 is beside the axis of p1",
        ),
        (BOTH_TURN, "p1 and q1 drive one leg, so it has two motors"),
        (WITH_TOOL, "Nothing else holds tool, so w is in no loop.*take a point of plate"),
    ],
)
def test_what_is_recognised_and_not_derived(file: str, told: str, tmp_path: Path) -> None:
    """These were told that a slider must be joined to one rod, or that a leg has one rod."""
    with pytest.raises(TableError, match=told):
        script_of("refused", file, tmp_path)


CANFIELD = """
# 3-RSR (Canfield joint)
hand = "P"
copies = 3
[parameters]
b = {value = "0.2", meaning = "base"}
l = {value = "0.3", meaning = "links"}
[bodies]
ground = {A1 = ["b", 0, 0]}
lower1 = {A1 = ["b", 0, 0], B1 = ["b + l", 0, 0]}
upper1 = {length = "l"}
hand = {P = [0, 0, 0], C1 = ["b", 0, 0]}
[joints]
q1 = {between = ["ground", "lower1"], at = "A1", axis = [0, 1, 0], driven = true}
b1 = {between = ["lower1", "upper1"], at = "B1", kind = "spherical"}
c1 = {between = ["upper1", "hand"], at = "C1", axis = [0, 1, 0]}
"""
CAPAMAN = """
# CaPaMan: four-bar parallelograms carry sliders with balls
hand = "P"
copies = 3
[parameters]
b = {value = "0.3", meaning = "base"}
l = {value = "0.1", meaning = "cranks"}
c = {value = "0.2", meaning = "hand"}
[bodies]
ground = {A1 = ["b", 0, 0]}
crank1 = {A1 = ["b", 0, 0], B1 = ["b", 0, "l"]}
coupler1 = {B1 = [0, 0, 0], D1 = [0, 0, 0]}
car1 = {D1 = [0, 0, 0]}
hand = {P = [0, 0, 0], D1 = ["c", 0, 0]}
[joints]
q1 = {between = ["ground", "crank1"], at = "A1", axis = [1, 0, 0], driven = true}
b1 = {between = ["crank1", "coupler1"], at = "B1", axis = [1, 0, 0]}
s1 = {between = ["coupler1", "car1"], at = "D1", kind = "prismatic", axis = [0, 1, 0]}
c1 = {between = ["car1", "hand"], at = "D1", kind = "spherical"}
"""
CYLINDERS = """
# 3-PRC translational
hand = "P"
[parameters]
l = {value = "0.4", meaning = "bars"}
[bodies]
ground = {A1 = [0, 0, 0], A2 = [0, 0, 0], A3 = [0, 0, 0]}
s1 = {B1 = [0, 0, 0]}
s2 = {B2 = [0, 0, 0]}
s3 = {B3 = [0, 0, 0]}
r1 = {length = "l"}
r2 = {length = "l"}
r3 = {length = "l"}
hand = {P = [0, 0, 0], C1 = [0, 0, 0], C2 = [0, 0, 0], C3 = [0, 0, 0]}
block1 = {}
block2 = {}
block3 = {}
[joints]
q1 = {between = ["ground", "s1"], at = "A1", kind = "prismatic", axis = [1, 0, 0], driven = true}
q2 = {between = ["ground", "s2"], at = "A2", kind = "prismatic", axis = [0, 1, 0], driven = true}
q3 = {between = ["ground", "s3"], at = "A3", kind = "prismatic", axis = [0, 0, 1], driven = true}
b1 = {between = ["s1", "r1"], at = "B1", axis = [0, 1, 0]}
b2 = {between = ["s2", "r2"], at = "B2", axis = [0, 0, 1]}
b3 = {between = ["s3", "r3"], at = "B3", axis = [1, 0, 0]}
c1 = {between = ["r1", "block1"], at = "E1", axis = [0, 1, 0]}
d1 = {between = ["block1", "hand"], at = "C1", kind = "prismatic", axis = [0, 1, 0]}
c2 = {between = ["r2", "block2"], at = "E2", axis = [0, 0, 1]}
d2 = {between = ["block2", "hand"], at = "C2", kind = "prismatic", axis = [0, 0, 1]}
c3 = {between = ["r3", "block3"], at = "E3", axis = [1, 0, 0]}
d3 = {between = ["block3", "hand"], at = "C3", kind = "prismatic", axis = [1, 0, 0]}
"""


@pytest.mark.parametrize(
    ("file", "told"),
    [
        (
            CANFIELD.replace('upper1 = {length = "l"}', 'upper1 = {length = "2*l"}'),
            "is supported if hand is the mirror image of the ground, as that of a Canfield joint",
        ),
        (CAPAMAN, "Three points of a hand on three lines are an equation of degree eight"),
        (
            CYLINDERS.replace('at = "B2", axis = [0, 0, 1]', 'at = "B2", axis = [1, 0, 1]'),
            "c1 and d1 are a cylindrical joint .* if all three legs are of this kind",
        ),
    ],
)
def test_a_message_says_of_which_degree_it_would_be(file: str, told: str, tmp_path: Path) -> None:
    """These said what a leg must be joined to, and nothing of the mechanism."""
    with pytest.raises(TableError, match=told):
        script_of("refused", file, tmp_path)


QUADRUPED = """
hand = "F"
[bodies]
ground = {O = [0, 0, 0]}
hip = {O = [0, 0, 0], H = [0, 0.06, 0]}
thigh = {H = [0, 0, 0], K = [0, 0, -0.2]}
crank = {H = [0, 0, 0], B = [0.03, 0, 0]}
rod = {length = 0.2}
shank = {K = [0, 0, 0], C = [0.03, 0, 0], F = [0, 0, -0.2]}
[joints]
q0 = {between = ["ground", "hip"], at = "O", axis = [1, 0, 0], driven = true}
q1 = {between = ["hip", "thigh"], at = "H", axis = [0, 1, 0], driven = true}
q2 = {between = ["hip", "crank"], at = "H", axis = [0, 1, 0], driven = true}
b = {between = ["crank", "rod"], at = "B", axis = [0, 1, 0]}
c = {between = ["rod", "shank"], at = "C", axis = [0, 1, 0]}
k = {between = ["thigh", "shank"], at = "K", axis = [0, 1, 0]}
"""
OMNI_WRIST = """
hand = "P"
copies = 4
[bodies]
ground = {O = [0, 0, 0], A1 = [0.1, 0, 0]}
low1 = {B1 = [0.1, 0, 0.1]}
mid1 = {}
up1 = {}
hand = {P = [0, 0, 0], C1 = [0.1, 0, 0]}
[joints]
q1 = {between = ["ground", "low1"], at = "A1", axis = [1, 0, 0], driven = true}
b1 = {between = ["low1", "mid1"], at = "B1", axis = [0, 1, 0]}
m1 = {between = ["mid1", "up1"], at = "M1", axis = [0, 1, 0]}
c1 = {between = ["up1", "hand"], at = "C1", axis = [1, 0, 0]}
"""
MULTI_LINK = """
hand = "W"
[bodies]
ground = {L = [0, 0.25, 0], U = [-0.02, 0.3, 0.2], V = [0.12, 0.3, 0.2], R = [0.12, 0.28, 0.04]}
lower = {B = [0, 0.6, 0]}
r1 = {length = 0.25}
r2 = {length = 0.27}
r3 = {length = 0.31}
upright = {W = [0, 0, 0], B = [0, 0, -0.1], C = [0, 0, 0.1], D = [0.05, 0, 0.1], T = [0.13, 0, 0]}
[joints]
q = {between = ["ground", "lower"], at = "L", axis = [1, 0, 0], driven = true}
b = {between = ["lower", "upright"], at = "B", kind = "spherical"}
u = {between = ["ground", "r1"], at = "U", kind = "spherical"}
c = {between = ["r1", "upright"], at = "C", kind = "spherical"}
v = {between = ["ground", "r2"], at = "V", kind = "spherical"}
d = {between = ["r2", "upright"], at = "D", kind = "spherical"}
r = {between = ["ground", "r3"], at = "R", kind = "spherical"}
t = {between = ["r3", "upright"], at = "T", kind = "spherical"}
"""
I4 = """
hand = "P"
[bodies]
ground = {A1 = [0.3, 0.1, 0], A2 = [0.3, -0.1, 0], A3 = [-0.3, -0.1, 0], A4 = [-0.3, 0.1, 0]}
half1 = {P = [0, 0, 0], C1 = [0, 0.08, 0], C2 = [0, -0.08, 0]}
half2 = {M = [0, 0, 0], C3 = [0, -0.08, 0], C4 = [0, 0.08, 0]}
s1 = {B1 = [0.3, 0.1, 0]}
s2 = {B2 = [0.3, -0.1, 0]}
s3 = {B3 = [-0.3, -0.1, 0]}
s4 = {B4 = [-0.3, 0.1, 0]}
rod1 = {length = 0.5, parallelogram = [0, 0.07, 0]}
rod2 = {length = 0.5, parallelogram = [0.07, 0, 0]}
rod3 = {length = 0.5, parallelogram = [0, 0.07, 0]}
rod4 = {length = 0.5, parallelogram = [0.07, 0, 0]}
[joints]
q1 = {between = ["ground", "s1"], at = "A1", kind = "prismatic", axis = [0, 0, 1], driven = true}
q2 = {between = ["ground", "s2"], at = "A2", kind = "prismatic", axis = [0, 0, 1], driven = true}
q3 = {between = ["ground", "s3"], at = "A3", kind = "prismatic", axis = [0, 0, 1], driven = true}
q4 = {between = ["ground", "s4"], at = "A4", kind = "prismatic", axis = [0, 0, 1], driven = true}
b1 = {between = ["s1", "rod1"], at = "B1"}
b2 = {between = ["s2", "rod2"], at = "B2"}
b3 = {between = ["s3", "rod3"], at = "B3"}
b4 = {between = ["s4", "rod4"], at = "B4"}
c1 = {between = ["rod1", "half1"], at = "C1"}
c2 = {between = ["rod2", "half1"], at = "C2"}
c3 = {between = ["rod3", "half2"], at = "C3"}
c4 = {between = ["rod4", "half2"], at = "C4"}
s = {between = ["half1", "half2"], at = "M", kind = "prismatic", axis = [0, 1, 0]}
"""


@pytest.mark.parametrize(
    ("file", "told"),
    [
        (QUADRUPED, "q0 turns hip, which carries the rest, as on the leg of a quadruped"),
        (OMNI_WRIST, "low1, mid1 and up1 are one after the other, .* as of an Omni-Wrist III"),
        (MULTI_LINK, "b is known if the driven joint is, and 3 rods turn upright about it"),
        (I4, "s lets half2 slide on half1, as the halves of an I4"),
    ],
)
def test_what_such_a_mechanism_is_called_is_said(file: str, told: str, tmp_path: Path) -> None:
    """These were told of a joint alone, not what they are."""
    with pytest.raises(TableError, match=told):
        script_of("refused", file, tmp_path)


def test_one_degree_of_freedom_is_one(tmp_path: Path) -> None:
    """It was called 1 degrees."""
    text = KNEE.replace('at = "A"}', 'at = "A", driven = true}')
    with pytest.raises(TableError, match="it has 1 degree of freedom"):
        script_of("knee", text, tmp_path)


def test_a_file_without_joints_says_so(tmp_path: Path) -> None:
    text = 'hand = "P"\n[bodies]\nground = {A = [2, 0, 3]}\ncam = {P = [0, 0, 0]}\n[joints]\n'
    with pytest.raises(TableError, match="no joint is driven"):
        script_of("t", text, tmp_path)


def test_halves_that_slide_on_each_other_are_told_of(tmp_path: Path) -> None:
    """Both halves have the point of the hand, as in an I4."""
    legs = "".join(
        f'q{k} = {{between = ["ground", "car{k}"], at = "A{k}", kind = "prismatic", '
        f"axis = [1, 0, 0], driven = true}}\n"
        f'b{k} = {{between = ["car{k}", "rod{k}"], at = "B{k}"}}\n'
        f'c{k} = {{between = ["rod{k}", "half{(k + 1) // 2}"], at = "C{k}"}}\n'
        for k in range(1, 5)
    )
    bodies = "".join(
        f"car{k} = {{B{k} = [0, {k}, 0]}}\nrod{k} = {{length = 3, parallelogram = [0, 0.1, 0]}}\n"
        for k in range(1, 5)
    )
    ground = ", ".join(f"A{k} = [0, {k}, 0]" for k in range(1, 5))
    i4 = (
        f'hand = "P"\n[bodies]\nground = {{{ground}}}\n{bodies}'
        "half1 = {P = [0, 0, 0], C1 = [0, 0.2, 0], C2 = [0, 0.1, 0]}\n"
        "half2 = {P = [0, 0, 0], C3 = [0, -0.1, 0], C4 = [0, -0.2, 0]}\n"
        f"[joints]\n{legs}"
        's = {between = ["half1", "half2"], at = "P", kind = "prismatic", axis = [1, 0, 0]}\n'
    )
    with pytest.raises(TableError, match=r"no leg contains s; .* s lets half2 slide on half1, as"):
        script_of("t", i4, tmp_path)
