"""What ``closedform new`` says of the file of a closed loop."""

import re
from pathlib import Path

import pytest
from loop_files import read_script, script_of, unbroken
from places import TESTS

from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.new import new

BALL = """hand = "P"
copies = 3
[bodies]
ground = {A1 = [0.5, 0, -0.4]}
tube1 = {}
piston1 = {}
platform = {P = [0, 0, 0], C1 = [0.3, 0, 0.1]}
[joints]
o = {between = ["ground", "platform"], at = "P", kind = "spherical"}
a1 = {between = ["ground", "tube1"], at = "A1", kind = "universal"}
q1 = {between = ["tube1", "piston1"], at = "A1", kind = "prismatic", driven = true}
c1 = {between = ["piston1", "platform"], at = "C1", kind = "spherical"}
"""


def test_a_hand_on_a_hinge_is_refused_by_name(tmp_path: Path) -> None:
    hinge = BALL.replace('at = "P", kind = "spherical"', 'at = "P"')
    with pytest.raises(ValueError, match="o joins platform to the ground itself"):
        script_of("wrist", hinge, tmp_path)
    with pytest.raises(ValueError, match="ground has no point P, where o is"):
        script_of("wrist", BALL, tmp_path)
    held = script_of("wrist", BALL.replace("{A1", "{P = [0, 0, 0], A1"), tmp_path)
    assert "Ball((0, 0, 0))" in held


def test_a_revolute_joint_does_not_hold_a_hand_that_turns(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/gough.toml").read_text("utf-8")
    with pytest.raises(ValueError, match="would hold platform by an axis"):
        script_of("gough", text.replace('kind = "spherical"', 'kind = "revolute"'), tmp_path)


BENNETT = """hand = "psi"

[bodies]
ground = {O = [0, 0, 0], G = [0.3, 0, 0]}
crank = {A = [0, 0.2, 0]}
lever = {B = [0.3, 0.2, 0]}
rod = {length = "0.3"}

[joints]
theta = {between = ["ground", "crank"], at = "O", axis = [0, 0, 1], driven = true}
psi = {between = ["ground", "lever"], at = "G", axis = [0, 3, 4]}
a = {between = ["crank", "rod"], at = "A", axis = [0, 3, 4]}
b = {between = ["rod", "lever"], at = "B", axis = [0, 0, 1]}
"""


def test_a_rod_in_space_is_not_held_by_axes_that_are_not_parallel(tmp_path: Path) -> None:
    """The loop would stand still, or be a Bennett linkage; it was read as one with ball joints."""
    with pytest.raises(TableError, match=r"a and b would hold .* by an axis.*Bennett"):
        script_of("bennett", BENNETT, tmp_path)
    level = BENNETT.replace("[0, 3, 4]", "[0, 0, 1]")
    assert "coupled(" in script_of("level", level, tmp_path)
    balls = BENNETT.replace('"A", axis = [0, 3, 4]', '"A", kind = "spherical"')
    balls = balls.replace('"B", axis = [0, 0, 1]', '"B", kind = "spherical"')
    assert "coupled(" in script_of("balls", balls, tmp_path)


def test_axes_that_meet_in_the_hand_are_told_of_a_spherical_mechanism(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/coaxial_wrist.toml").read_text("utf-8")
    text = re.sub(r"\nball = .*", "", text)
    text = text.replace('at = "B1", kind = "spherical"', 'at = "B1"')
    for x, message in (("0", "would hold"), ("sin(gamma)", "meet in P, so this is a spherical")):
        hinged = f'at = "C1", axis = ["{x}", 0, "cos(gamma)"]'
        with pytest.raises(TableError, match=f"c1, c2 and c3 {message}"):
            script_of("wrist", text.replace('at = "C1", kind = "spherical"', hinged), tmp_path)


def test_a_script_tells_of_legs_that_are_alike_once(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/gough.toml").read_text("utf-8")
    told = read_script(script_of("gough", text, tmp_path)).mechanism
    assert told.count("is the length of a leg") == 1
    assert told.endswith("The same holds for q2, q3, q4, q5 and q6.")


def test_a_length_without_a_value_is_named(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/watt.toml").read_text("utf-8")
    (tmp_path / "a.toml").write_text(text, "utf-8")
    assert not new("a", "loop", tmp_path / "a.toml").notes
    (tmp_path / "a.toml").write_text(re.sub(r"\nr = .*", "", text), "utf-8")
    (note,) = new("a", "loop", tmp_path / "a.toml").notes
    assert "no value is given for r, so 1 is taken" in note


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("gough", "a hand that turns, of 18 joints"),
        ("tricept", "a hand on a passive leg, of 11 joints"),
        ("ankle", "a hand on a universal joint, of 7 joints"),
        ("coaxial_wrist", "a hand on a ball joint, of 10 joints"),
        ("watt", "a linkage of many bars, of 7 joints"),
        ("puu", "a hand that does not turn, of 9 joints"),
        ("rssr", "a single loop, of 4 joints"),
    ],
)
def test_new_says_what_kind_of_loop_it_read(name: str, kind: str) -> None:
    path = TESTS / "held_out_loops" / f"{name}.toml"
    assert new(name, "loop", path).inverse == kind


EXECHON = """hand = "P"
[bodies]
ground = {A1 = [0.3, 0, 0], A2 = [-0.3, 0, 0], A3 = [0, 0.3, 0]}
platform = {P = [0, 0, 0], C1 = [0.15, 0, 0], C2 = [-0.15, 0, 0], C3 = [0, 0.15, 0]}
t1 = {}
p1 = {}
t2 = {}
p2 = {}
t3 = {}
p3 = {}
[joints]
a1 = {between = ["ground", "t1"], at = "A1", kind = "universal", axis = [1, 0, 0]}
a2 = {between = ["ground", "t2"], at = "A2", kind = "universal", axis = [1, 0, 0]}
a3 = {between = ["ground", "t3"], at = "A3", kind = "spherical"}
q1 = {between = ["t1", "p1"], at = "A1", kind = "prismatic", driven = true}
q2 = {between = ["t2", "p2"], at = "A2", kind = "prismatic", driven = true}
q3 = {between = ["t3", "p3"], at = "A3", kind = "prismatic", driven = true}
c1 = {between = ["p1", "platform"], at = "C1", axis = [0, 1, 0]}
c2 = {between = ["p2", "platform"], at = "C2", axis = [0, 1, 0]}
c3 = {between = ["p3", "platform"], at = "C3", axis = [1, 0, 0]}
"""


def test_planes_that_turn_and_stand_still_are_told_apart(tmp_path: Path) -> None:
    text = EXECHON.replace('at = "A1", kind = "universal"', 'at = "A1"')
    text = text.replace('at = "C1", axis', 'at = "C1", kind = "universal", axis')
    with pytest.raises(TableError, match="hand two degrees of freedom"):
        script_of("exechon", text, tmp_path)
    text = text.replace('at = "A1", axis = [1, 0, 0]', 'at = "A1", axis = [0, 0, 1]')
    with pytest.raises(TableError, match="in a plane that turns, and those of q1 in one that"):
        script_of("exechon", text, tmp_path)


EXCAVATOR = """hand = "P"
[bodies]
ground = {O = [0, 0], F = [0.3, -0.2]}
boom = {O = [0, 0], B = [1, 0.2], S = [1.5, 0.2], E = [2.5, 0]}
stick = {E = [0, 0], T = [-0.4, 0.1], P = [1.5, 0]}
t1 = {}
p1 = {}
t2 = {}
p2 = {}
[joints]
o = {between = ["ground", "boom"], at = "O"}
f = {between = ["ground", "t1"], at = "F"}
q1 = {between = ["t1", "p1"], at = "F", kind = "prismatic", axis = [1, 0], driven = true}
b = {between = ["p1", "boom"], at = "B"}
e = {between = ["boom", "stick"], at = "E"}
s = {between = ["boom", "t2"], at = "S"}
q2 = {between = ["t2", "p2"], at = "S", kind = "prismatic", axis = [1, 0], driven = true}
t = {between = ["p2", "stick"], at = "T"}
"""


BUCKET = EXCAVATOR.replace("P = [1.5, 0]}", "K = [1.5, 0], U = [0.2, 0.3]}").replace(
    "[joints]", "bucket = {K = [0, 0], V = [-0.1, 0.3], P = [0.6, 0]}\nt3 = {}\np3 = {}\n[joints]"
)
THIRD = """k = {between = ["stick", "bucket"], at = "K"}
u = {between = ["stick", "t3"], at = "U"}
q3 = {between = ["t3", "p3"], at = "U", kind = "prismatic", axis = [1, 0], driven = true}
v = {between = ["p3", "bucket"], at = "V"}
"""


CLAW = BUCKET.replace("P = [0.6, 0]}", "W = [0.2, 0], X = [0.1, 0.2]}").replace(
    "[joints]", "claw = {W = [0, 0], Y = [0.1, 0.2], P = [0.4, 0]}\nt4 = {}\np4 = {}\n[joints]"
)
FOURTH = """w = {between = ["bucket", "claw"], at = "W"}
x = {between = ["bucket", "t4"], at = "X"}
q4 = {between = ["t4", "p4"], at = "X", kind = "prismatic", axis = [1, 0], driven = true}
y = {between = ["p4", "claw"], at = "Y"}
"""


LAMP = """hand = "P"
[parameters]
l = {value = "0.4"}
r = {value = "0.35"}
w = {value = "0.05"}
[bodies]
ground = {A = [0, 0], A2 = ["w", 0]}
lower = {A = [0, 0], B = [0, "l"]}
lower2 = {length = "l"}
elbow = {B = [0, 0], B2 = ["w", 0], E = [0, "w"]}
upper = {B = [0, 0], C = ["r", 0]}
upper2 = {length = "r"}
head = {C = [0, 0], F = [0, "w"], P = [0.1, 0]}
[joints]
theta1 = {between = ["ground", "lower"], at = "A", driven = true}
a2 = {between = ["ground", "lower2"], at = "A2"}
b = {between = ["lower", "elbow"], at = "B"}
b2 = {between = ["lower2", "elbow"], at = "B2"}
theta2 = {between = ["elbow", "upper"], at = "B", driven = true}
e2 = {between = ["elbow", "upper2"], at = "E"}
c = {between = ["upper", "head"], at = "C"}
f = {between = ["upper2", "head"], at = "F"}
"""


def test_the_file_of_a_desk_lamp_is_told_what_to_write_instead(tmp_path: Path) -> None:
    with pytest.raises(TableError, match=r"between elbow and upper.*a table of joints with motors"):
        script_of("lamp", LAMP, tmp_path)


def test_the_file_of_an_excavator_is_told_what_to_write_instead(tmp_path: Path) -> None:
    assert "linkage(" in script_of("excavator", EXCAVATOR, tmp_path)
    assert 'real("yaw")' in script_of("excavator", BUCKET + THIRD, tmp_path)
    with pytest.raises(TableError, match=r'write each loop as a file of its own.*hand = "o"'):
        script_of("excavator", CLAW + THIRD + FOURTH, tmp_path)
    first = CLAW.replace("[joints]", "[joints]\n" + FOURTH) + THIRD
    with pytest.raises(TableError, match=r"leg of q4.*write each loop as a file of its own"):
        script_of("excavator", first, tmp_path)
    boom = 'hand = "o"' + EXCAVATOR.removeprefix('hand = "P"').split("e = {between")[0]
    lines = [line for line in boom.splitlines() if not line.startswith(("stick", "t2", "p2"))]
    assert "coupled(" in script_of("boom", "\n".join(lines), tmp_path)


def test_a_leg_more_than_a_hand_needs_is_redundant(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/y_star.toml").read_text("utf-8")
    with pytest.raises(TableError, match=r"4 joints are driven, .* is redundant: leave it out"):
        script_of("y_star", text.replace("copies = 3", "copies = 4"), tmp_path)


ECLIPSE = """hand = "P"
copies = 3
[bodies]
ground = {O = [0, 0, 0]}
column1 = {B1 = [0.5, 0, 0]}
slider1 = {B1 = [0.5, 0, 0]}
rod1 = {length = "l"}
platform = {P = [0, 0, 0], C1 = [0.2, 0, 0]}
[joints]
phi1 = {between = ["ground", "column1"], at = "O", axis = [0, 0, 1], driven = true}
q1 = {between = ["column1", "slider1"], at = "B1", kind = "prismatic", axis = [0, 0, 1]}
b1 = {between = ["slider1", "rod1"], at = "B1", axis = [0, 1, 0]}
c1 = {between = ["rod1", "platform"], at = "C1", kind = "spherical"}
"""


def test_a_leg_with_two_motors_is_told_so(tmp_path: Path) -> None:
    """The slide with a motor was said to be passive."""
    with pytest.raises(TableError, match="q1 slides; a passive"):
        script_of("eclipse", ECLIPSE, tmp_path)
    motor = ECLIPSE.replace('"prismatic", ', '"prismatic", driven = true, ')
    script = unbroken(script_of("eclipse", motor.replace("0.5", '"1/2"'), tmp_path))
    assert "OnTurret(Slide(q1, l, (Rational(1, 2), 0), (0, 1))" in script
    oblique = motor.replace('"B1", axis = [0, 1, 0]', '"B1", axis = [0, 1, 1]')
    with pytest.raises(TableError, match="q1 is driven, on column1, which phi1 moves; a leg has"):
        script_of("eclipse", oblique, tmp_path)


def test_a_motor_between_rods_in_space_is_not_that_of_a_desk_lamp(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/hexa.toml").read_text("utf-8")
    between = text.replace('"B1", kind = "universal"', '"B1", axis = [0, 1, 0], driven = true')
    with pytest.raises(TableError, match=r"between crank1 and rod1\.  theta1 and b1 drive one leg"):
        script_of("hexa", between, tmp_path)


@pytest.mark.parametrize(
    ("kind", "meant"),
    [
        ("ball", "a ball joint is spherical"),
        ("Hooke", "a joint of Cardan or Hooke is universal"),
    ],
)
def test_another_name_of_a_joint_is_told(kind: str, meant: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match=f"kind must be one of revolute, .*; {meant}"):
        script_of("named", BALL.replace("spherical", kind), tmp_path)
    with pytest.raises(TableError, match=r"cylindrical$"):
        script_of("named", BALL.replace("spherical", "welded"), tmp_path)
