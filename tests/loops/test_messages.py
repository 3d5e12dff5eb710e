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
h = {between = ["bar", "rear"], at = "D"}
"""
JACK = """
hand = "T"
[bodies]
ground = {A = [0, 0]}
bar1 = {length = 0.2}
bar2 = {length = 0.2}
bar3 = {length = 0.2}
bar4 = {length = 0.2}
nut = {}
screw = {}
roller = {T = [0, 0]}
[joints]
a1 = {between = ["ground", "bar1"], at = "A"}
a2 = {between = ["ground", "bar2"], at = "A"}
l = {between = ["bar1", "bar3"], at = "L"}
r = {between = ["bar2", "bar4"], at = "R"}
t = {between = ["bar3", "roller"], at = "T"}
u = {between = ["bar4", "roller"], at = "T"}
v = {between = ["ground", "roller"], at = "A", kind = "prismatic", axis = [0, 1]}
n = {between = ["bar1", "nut"], at = "L"}
q = {between = ["nut", "screw"], at = "L", kind = "prismatic", driven = true}
s = {between = ["bar2", "screw"], at = "R"}
"""
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
CRR = (TESTS / "held_out_loops" / "crr.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (KNEE, "degree 6; it can be solved if a or b is driven instead of q, whose length follows"),
        (JACK, "it can be solved if a1 or a2 or v is driven instead of q, whose length follows"),
        (KNEE.replace("rear = {", "bar = {length = 1}\nrear = {") + BAR, "q drives this linkage"),
        (PENTAPOD, "there are 5 driven joints; they leave it one freedom, such as a turn"),
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


def test_planes_that_meet_in_a_point_are_told_of(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops" / "exechon.toml").read_text("utf-8")
    text = text.replace('kind = "universal", axis = [1, 0, 0]', "axis = [1, 0, 0]")
    text = text.replace(", axis = [0, 1, 0]}", ', kind = "spherical"}').replace(
        '"platform"], at = "C3", axis = [1, 0, 0]', '"platform"], at = "C3", kind = "spherical"'
    )
    text = text.replace('"A3", kind = "spherical"', '"A3", axis = [0, 0, 1]')
    with pytest.raises(TableError, match="in one point alone, as in a 3-RPS cube"):
        script_of("t", text, tmp_path)


def test_a_cylindrical_joint_is_a_slide_and_a_turn(tmp_path: Path) -> None:
    """A 3-CRR mechanism, X. Kong and C. Gosselin (2002): each leg holds the hand in a plane."""
    script = script_of("crr", CRR, tmp_path)
    assert script.count("Plane(q") == 3 and "Slide(" not in script
    mechanism = derived("crr", script, tmp_path)
    p, status = mechanism.fk([0.1, 0.2, 0.3])  # the axes are those of x, y and z
    assert not status.any() and np.allclose(p, [0.1, 0.2, 0.3])
