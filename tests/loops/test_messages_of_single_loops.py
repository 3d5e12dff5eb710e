"""What is said of single loops, counts of freedoms and suspensions that are not derived."""

from pathlib import Path

import pytest
from loop_files import script_of

from closedform.scaffold.inputs.tables import TableError

FOUR_BAR = """
hand = "psi"
[bodies]
ground = {O = [0, 0], C = [0.4, 0]}
crank = {O = [0, 0], A = [0.1, 0]}
rod = {A = [0, 0], B = [0.35, 0], P = [0.2, 0.1]}
rocker = {C = [0.4, 0], B = [0.4, 0.3], T = [0.4, 0.5]}
[joints]
theta = {between = ["ground", "crank"], at = "O", driven = true}
a = {between = ["crank", "rod"], at = "A"}
b = {between = ["rod", "rocker"], at = "B"}
psi = {between = ["ground", "rocker"], at = "C"}
"""
ON_COUPLER = FOUR_BAR.replace(", driven = true", "").replace(
    '"rod"], at = "A"', '"rod"], at = "A", driven = true'
)
KNEE_MOTOR = """
hand = "P"
[bodies]
ground = {O = [0, 0]}
thigh = {O = [0, 0], K = [0.4, 0]}
shank = {K = [0, 0], P = [0.4, 0], L = [-0.1, 0]}
crank = {O = [0, 0], M = [0.1, 0]}
rod = {length = 0.4}
[joints]
hip = {between = ["ground", "thigh"], at = "O", driven = true}
knee = {between = ["thigh", "shank"], at = "K"}
motor = {between = ["thigh", "crank"], at = "O", driven = true}
m = {between = ["crank", "rod"], at = "M"}
l = {between = ["rod", "shank"], at = "L"}
"""
CARDAN = """
hand = "psi"
[bodies]
ground = {O = [0, 0, 0], Q = [1, 0.2, 0]}
shaft1 = {O = [0, 0, 0]}
middle = {O = [0, 0, 0], Q = [1, 0, 0]}
shaft2 = {Q = [1, 0.2, 0]}
[joints]
q = {between = ["ground", "shaft1"], at = "O", axis = [1, 0, 0], driven = true}
u1 = {between = ["shaft1", "middle"], at = "O", kind = "universal"}
u2 = {between = ["middle", "shaft2"], at = "Q", kind = "universal"}
psi = {between = ["ground", "shaft2"], at = "Q", axis = [1, 0, 0]}
"""
ONE_CARDAN = CARDAN.replace('"middle", "shaft2"], at = "Q"', '"shaft1", "shaft2"], at = "O"')
ONE_CARDAN = ONE_CARDAN.replace('"Q", axis = [1', '"O", axis = [1, 1').replace(
    "1, 1, 0, 0", "1, 1, 0"
)
ONE_CARDAN = "\n".join(
    line for line in ONE_CARDAN.splitlines() if "middle" not in line and "u1" not in line
)
BRICARD = """
hand = "f"
[bodies]
ground = {A = [0, 0, 0], F = [1, 0, 0]}
l1 = {A = [0, 0, 0], B = [0, 1, 0]}
l2 = {length = 1}
l3 = {length = 1}
l4 = {length = 1}
l5 = {F = [1, 0, 0], E = [1, 1, 0]}
[joints]
a = {between = ["ground", "l1"], at = "A", axis = [0, 0, 1], driven = true}
b = {between = ["l1", "l2"], at = "B", axis = [1, 0, 0]}
c = {between = ["l2", "l3"], at = "C", axis = [0, 1, 0]}
d = {between = ["l3", "l4"], at = "D", axis = [0, 0, 1]}
e = {between = ["l4", "l5"], at = "E", axis = [1, 0, 0]}
f = {between = ["ground", "l5"], at = "F", axis = [0, 1, 0]}
"""
SPHERE = """
hand = "P"
[bodies]
ground = {O = [0, 0, 0]}
k1 = {}
c = {P = [0, 0, 1]}
k2 = {}
[joints]
q = {between = ["ground", "k1"], at = "O", axis = [1, 0, 0], driven = true}
b = {between = ["k1", "c"], at = "O", axis = [1, 1, 0]}
e = {between = ["c", "k2"], at = "O", axis = [0, 1, 1]}
f = {between = ["k2", "ground"], at = "O", axis = [0, 1, 0]}
"""


@pytest.mark.parametrize(
    ("file", "told"),
    [
        (ON_COUPLER, "a is driven, so it must be between .* with crank or rod as the ground"),
        (KNEE_MOTOR, "motor is driven, on thigh, .* each loop is a file of its own"),
        (FOUR_BAR.replace('hand = "psi"', 'hand = "a"'), "Of this loop psi may be the hand"),
        (
            FOUR_BAR.replace("{O = [0, 0], A = [0.1, 0]}", "{length = 0.1}"),
            "give crank its points instead of a length",
        ),
        (FOUR_BAR.replace('"A"}', '"A", kind = "gear", ratio = 2}'), "put their ratio between"),
        (FOUR_BAR.replace('"A"}', '"A", kind = "cam"}'), "let the joint of its follower be driven"),
        (
            FOUR_BAR.replace('"A"}', '"A", driven = "2*theta"}'),
            "must be true or false; for a joint",
        ),
        (CARDAN, "If u1 is a joint of Cardan between two shafts, .* are two files"),
        (
            ONE_CARDAN,
            "If u2 is a joint of Cardan between two shafts, write it as a body, its cross",
        ),
        (BRICARD, "a single loop of 6 hinges in space, which moves by its special dimensions"),
        (SPHERE, 'this is a spherical four-bar linkage.  It is derived with hand = "f"'),
    ],
)
def test_single_loops_are_told_what_to_do(file: str, told: str, tmp_path: Path) -> None:
    """A motor on the coupler was taken for the length of the coupler."""
    with pytest.raises(TableError, match=told):
        script_of("t", file, tmp_path)


SCISSORS = """
hand = "h"
[bodies]
ground = {A = [0, 0]}
nut = {R = [0, 0]}
bar1 = {A = [0, 0], M = [0.5, 0], B = [1, 0]}
bar2 = {R = [0, 0], M = [0.5, 0], C = [1, 0]}
table = {C = [0, 0]}
[joints]
a = {between = ["ground", "bar1"], at = "A"}
q = {between = ["ground", "nut"], at = "A", kind = "prismatic", axis = [1, 0], driven = true}
r = {between = ["nut", "bar2"], at = "R"}
m = {between = ["bar1", "bar2"], at = "M"}
c = {between = ["bar2", "table"], at = "C"}
h = {between = ["ground", "table"], at = "A", kind = "prismatic", axis = [0, 1]}
"""
"""Its table is guided, though C stays above A."""
THIRD_BAR = """
hand = "P"
[bodies]
ground = {A = [0, 0], B = [0.2, 0], C = [0.4, 0]}
crank = {A = [0, 0], D = [0, 0.3]}
bar1 = {length = 0.3}
bar2 = {length = 0.3}
table = {D = [0, 0], E = [0.2, 0], F = [0.4, 0], P = [0.2, 0.1]}
[joints]
q = {between = ["ground", "crank"], at = "A", driven = true}
b = {between = ["ground", "bar1"], at = "B"}
c = {between = ["ground", "bar2"], at = "C"}
d = {between = ["crank", "table"], at = "D"}
e = {between = ["bar1", "table"], at = "E"}
f = {between = ["bar2", "table"], at = "F"}
"""

LOOSE = "\n".join(line for line in THIRD_BAR.splitlines() if line[:3] not in ("b =", "c ="))
LOOSE = LOOSE.replace("bar1 = {length = 0.3}", "bar1 = {E = [0, 0], G = [0.3, 0]}")
LOOSE = LOOSE.replace("bar2 = {length = 0.3}", "bar2 = {F = [0, 0], H = [0.3, 0]}")


@pytest.mark.parametrize(
    ("file", "told"),
    [
        (SCISSORS, "it has 0 degrees of freedom.  If its dimensions let it move .* leave out what"),
        (THIRD_BAR, "it has 0 degrees of freedom.  If its dimensions let it move all the same"),
        (LOOSE, "it has 4 degrees of freedom.  Drive more joints, or see whether a joint"),
    ],
)
def test_a_count_of_freedoms_says_what_may_be_meant(file: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match=told):
        script_of("t", file, tmp_path)


def test_points_of_a_rod_without_a_joint_are_of_no_account(tmp_path: Path) -> None:
    script = script_of("t", FOUR_BAR, tmp_path)
    plain = FOUR_BAR.replace(", P = [0.2, 0.1]", "").replace(", T = [0.4, 0.5]", "")
    assert "coupled(" in script and script == script_of("t", plain, tmp_path)


RODS = "".join(f"l{k} = {{length = 0.3}}\n" for k in range(1, 6))
ENDS = "".join(
    f'a{k} = {{between = ["ground", "l{k}"], at = "A{k}", kind = "spherical"}}\n'
    f'c{k} = {{between = ["l{k}", "upright"], at = "C{k}", kind = "spherical"}}\n'
    for k in range(1, 6)
)
FIVE_LINKS = f"""
hand = "W"
[bodies.ground]
D = [0, 0.5, 0.6]
A1 = [0, 0.4, 0]
A2 = [0.2, 0.4, 0.05]
A3 = [-0.2, 0.4, 0.1]
A4 = [0.1, 0.45, 0.3]
A5 = [-0.1, 0.45, 0.32]
[bodies.upright]
W = [0, 0, 0]
E = [0, -0.05, 0.15]
C1 = [0, -0.05, -0.1]
C2 = [0.1, -0.05, -0.08]
C3 = [-0.1, -0.05, -0.05]
C4 = [0.05, -0.05, 0.1]
C5 = [-0.05, -0.06, 0.1]
[bodies]
tube = {{}}
rod = {{}}
{RODS}
[joints]
d = {{between = ["ground", "tube"], at = "D", kind = "spherical"}}
q = {{between = ["tube", "rod"], at = "D", kind = "prismatic", driven = true}}
e = {{between = ["rod", "upright"], at = "E", kind = "spherical"}}
{ENDS}
"""
MACPHERSON = """
hand = "W"
[bodies]
ground = {L = [0, 0.3, 0], T = [0.1, 0.5, 0.6], R = [-0.15, 0.3, 0.05]}
arm = {L = [0, 0.3, 0], B = [0, 0.7, 0]}
tie = {length = 0.38}
strut = {}
upright = {W = [0, 0, 0], B = [0, -0.05, -0.1], N = [-0.13, -0.05, -0.05], S = [0, -0.1, 0.1]}
[joints]
q = {between = ["ground", "arm"], at = "L", axis = [1, 0, 0], driven = true}
t = {between = ["ground", "strut"], at = "T", kind = "universal"}
s = {between = ["strut", "upright"], at = "S", kind = "prismatic", axis = [0, 0, 1]}
b = {between = ["arm", "upright"], at = "B", kind = "spherical"}
r = {between = ["ground", "tie"], at = "R", kind = "spherical"}
n = {between = ["tie", "upright"], at = "N", kind = "spherical"}
"""


@pytest.mark.parametrize(
    ("file", "told"),
    [
        (FIVE_LINKS, "l4, l5 and the leg of q give six distances of the hand, .* degree 40"),
        (MACPHERSON, "upright slides on strut, .* a MacPherson .* supported if t is spherical"),
    ],
)
def test_suspensions_in_space_are_told_what_they_are(file: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match=told):
        script_of("t", file, tmp_path)


def test_guides_that_motors_turn_are_told_what_they_are(tmp_path: Path) -> None:
    text = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = [0.5, 0]}
plate = {P = [0, 0], C1 = [0.1, 0]}
guide1 = {A1 = [0.5, 0]}
rod1 = {C1 = [0, 0]}
[joints]
t1 = {between = ["ground", "guide1"], at = "A1", driven = true}
s1 = {between = ["guide1", "rod1"], at = "A1", kind = "prismatic", axis = [1, 0]}
c1 = {between = ["rod1", "plate"], at = "C1"}
"""
    assert "on_levers(" in script_of("t", text, tmp_path)
    crank = text.replace("rod1 = {C1 = [0, 0]}", "rod1 = {length = 0.4}").replace(
        's1 = {between = ["guide1", "rod1"], at = "A1", kind = "prismatic", axis = [1, 0]}',
        's1 = {between = ["guide1", "rod1"], at = "B1"}',
    )
    crank = crank.replace("copies = 3", "").replace("guide1 = {A1", "guide1 = {B1 = [0.2, 0], A1")
    other = text[text.index("guide1") : text.index("[joints]")] + text[text.index("t1 =") :]
    for old, new in (("[0.5, 0]", "[-0.5, 0]"), ("1", "2")):
        other = other.replace(old, new)
    bodies, joints = other.split("t2 = ")
    ground = "ground = {A2 = [-0.5, 0], A3 = [0, 0.5], "
    mixed = crank.replace("ground = {", ground).replace(
        "[0.1, 0]", "[0.1, 0], C2 = [0, 0], C3 = [0, 0.1]"
    )
    mixed = mixed.replace("[joints]", f"{bodies}{bodies.replace('2', '3')}[joints]")
    mixed += f"t2 = {joints}t3 = {joints.replace('2', '3')}"
    with pytest.raises(TableError, match=r"if all three legs are of this kind.* drive s2 instead"):
        script_of("t", mixed, tmp_path)
    driven = text.replace(", driven = true", "").replace("axis = [1, 0]", "driven = true")
    assert "platform(" in script_of("t", driven, tmp_path)
