"""Bodies of a planar linkage that its hand does not depend on, and names that stay in the file."""

from pathlib import Path

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.loops.file import read_loop
from closedform.scaffold.loops.script import loop_script

FOLDER = TESTS / "held_out_loops"
STEERING = """
hand = "delta"
[bodies]
ground = {L = [-0.6, 0], R = [0.6, 0], O = [0, -0.1]}
rack = {T1 = [-0.25, -0.1], T2 = [0.25, -0.1]}
tie1 = {length = 0.32}
tie2 = {length = 0.32}
left = {L = [-0.6, 0], K1 = [-0.55, -0.15]}
right = {R = [0.6, 0], K2 = [0.55, -0.15]}
[joints]
q = {between = ["ground", "rack"], at = "O", kind = "prismatic", axis = [1, 0], driven = true}
d = {between = ["rack", "tie1"], at = "T1"}
cos = {between = ["rack", "tie2"], at = "T2"}
x = {between = ["tie1", "left"], at = "K1"}
y = {between = ["tie2", "right"], at = "K2"}
delta = {between = ["ground", "left"], at = "L"}
other = {between = ["ground", "right"], at = "R"}
"""
IDLER = """
hand = "delta"
[bodies]
ground = {P = [-0.3, 0], I = [0.3, 0], L = [-0.7, 0], R = [0.7, 0]}
pitman = {P = [-0.3, 0], A = [-0.3, -0.15]}
idler = {I = [0.3, 0], B = [0.3, -0.15]}
relay = {A = [0, 0], B = [0.6, 0]}
tie1 = {length = 0.35}
tie2 = {length = 0.35}
left = {L = [-0.7, 0], K1 = [-0.65, -0.14]}
right = {R = [0.7, 0], K2 = [0.65, -0.14]}
[joints]
q = {between = ["ground", "pitman"], at = "P", driven = true}
i = {between = ["ground", "idler"], at = "I"}
a = {between = ["pitman", "relay"], at = "A"}
b = {between = ["idler", "relay"], at = "B"}
t1 = {between = ["relay", "tie1"], at = "A"}
t2 = {between = ["relay", "tie2"], at = "B"}
k1 = {between = ["tie1", "left"], at = "K1"}
k2 = {between = ["tie2", "right"], at = "K2"}
delta = {between = ["ground", "left"], at = "L"}
other = {between = ["ground", "right"], at = "R"}
"""


def test_the_other_jaw_of_a_gripper_is_left_out(tmp_path: Path) -> None:
    path = FOLDER / "gripper.toml"
    loop = read_loop(path)
    script = loop_script("gripper", loop, path.name)[0]
    assert "arm2" not in script and "finger1" in script
    assert loop.notes == [
        "gripper.toml: rod2, arm2, side2 and finger2 do not move the hand and are left out"
    ]


def test_the_tip_of_the_finger_is_where_its_parallelogram_takes_it(tmp_path: Path) -> None:
    text = (FOLDER / "gripper.toml").read_text("utf-8")
    jaw = derived("jaw", script_of("jaw", text, tmp_path), tmp_path, crosscheck=True)
    rng, count = np.random.default_rng(1), 0
    for q in rng.uniform(-0.05, 0.05, (20, 1)):

        def missed(u: np.ndarray, q: float = q[0]) -> np.ndarray:
            arm = 0.02 + 0.02 * np.exp(1j * u[0])
            return np.array([abs(arm - 0.01 - 1j * q) - 0.03])

        for start in rng.uniform(-3, 3, (10, 1)):
            u = newton(missed, start)
            if u is None:
                continue
            tip = 0.02 + 0.05 * np.exp(1j * u[0]) + 0.06j  # the finger does not turn
            apart = np.linalg.norm(jaw.fk(q).p - [tip.real, tip.imag], axis=-1)
            assert np.nanmin(apart) < 1e-9
            count += 1
    assert count > 50


def test_what_is_left_may_be_of_a_simpler_kind(tmp_path: Path) -> None:
    """Of a steering gear, one knuckle.  Pins that the script does not name have any name."""
    script = script_of("steering", STEERING, tmp_path)
    assert "coupled(" in script and "right" not in script
    assert len(read_script(script).actuated) == 1


@pytest.mark.parametrize("name", ["d", "cos"])
def test_a_joint_that_the_script_names_needs_a_name_of_its_own(name: str, tmp_path: Path) -> None:
    free = STEERING.replace(f"\n{name} =", "\nother_pin =")
    for joint in ("q", "delta"):
        clash = free.replace(f"\n{joint} =", f"\n{name} =").replace(f'"{joint}"', f'"{name}"')
        with pytest.raises(TableError, match=f"uses the name {name} itself"):
            script_of("t", clash, tmp_path)


def test_bars_that_are_pinned_together_twice_are_refused(tmp_path: Path) -> None:
    """A cylinder between two points of one bar."""
    text = (FOLDER / "landing_gear.toml").read_text("utf-8")
    ends = (
        text.replace('e = {between = ["piston", "upper"], at = "E"', '$at = "K"')
        .replace('f = {between = ["ground", "tube"], at = "F"}', "")
        .replace('at = "F", kind', 'at = "U", kind')
        .replace(
            "$",
            'f = {between = ["ground", "tube"], at = "U"}\ne = {between = ["piston", "upper"], ',
        )
    )
    with pytest.raises(TableError, match="both pinned at U and at K, so together they are one bar"):
        script_of("t", ends, tmp_path)


def test_the_shaft_of_a_delta_robot_is_left_out(tmp_path: Path) -> None:
    path = FOLDER / "delta_with_shaft.toml"
    loop = read_loop(path)
    d = read_script(loop_script("delta_with_shaft", loop, path.name)[0])
    assert [str(q) for q in d.actuated] == ["t1", "t2", "t3"]
    assert loop.notes == [
        "delta_with_shaft.toml: t4, u1, s, u2 and r leave the hand all freedoms and are left out; "
        "what t4 moves beside it is not derived"
    ]
    stiff = path.read_text("utf-8").replace(
        'u2 = {between = ["lower", "tool"], at = "Q", kind = "universal"}',
        'u2 = {between = ["lower", "tool"], at = "Q", axis = [1, 0, 0]}',
    )
    with pytest.raises(TableError, match="t4 moves upper"):
        script_of("t", stiff, tmp_path)


def test_two_legs_in_space_may_be_meant_in_a_plane(tmp_path: Path) -> None:
    text = (FOLDER / "delta_with_shaft.toml").read_text("utf-8")
    for n in ("t3", "t4", "b3", "c3", "u1", "s", "u2", "r", "crank3", "rod3", "upper", "fork"):
        text = "\n".join(row for row in text.splitlines() if not row.startswith(f"{n} ="))
    text = "\n".join(row for row in text.splitlines() if not row.startswith(("lower", "tool")))
    with pytest.raises(TableError, match="in a plane alone is written with two coordinates"):
        script_of("t", text, tmp_path)


def test_a_hand_that_turns_is_left_whole(tmp_path: Path) -> None:
    """Its point is where two legs meet, but its body turns with the third one."""
    legs = "".join(
        f"""
        t{k} = {{}}
        r{k} = {{}}"""
        for k in (1, 2, 3)
    )
    joints = "".join(
        f"""
        a{k} = {{between = ["ground", "t{k}"], at = "A{k}"}}
        q{k} = {{between = ["t{k}", "r{k}"], at = "A{k}", kind = "prismatic", driven = true}}
        c{k} = {{between = ["r{k}", "top"], at = "{end}"}}"""
        for k, end in ((1, "P"), (2, "P"), (3, "C"))
    )
    text = f"""
        hand = "P"
        [bodies]
        ground = {{A1 = [0, 0], A2 = [1, 0], A3 = [0, 1]}}
        top = {{P = [0, 0], C = [0.3, 0]}}{legs}
        [joints]{joints}
    """
    assert "platform(" in script_of("t", text, tmp_path)


WINGS = """
hand = "psi"
[bodies]
ground = {O = [0, 0, 0], W1 = [0.02, 0.06, 0], W2 = [-0.02, 0.06, 0], D = [0.1, 0, 0.1]}
crank = {A = [0.01, 0, 0], B = [-0.01, 0, 0]}
rod1 = {length = 0.06}
rod2 = {length = 0.06}
wing1 = {W1 = [0.02, 0.06, 0], C1 = [0.04, 0.06, 0]}
wing2 = {W2 = [-0.02, 0.06, 0], C2 = [-0.04, 0.06, 0]}
tube = {}
rod3 = {}
[joints]
theta = {between = ["ground", "crank"], at = "O", axis = [0, 0, 1], driven = true}
psi = {between = ["ground", "wing1"], at = "W1", axis = [0.2, 0, 1]}
other = {between = ["ground", "wing2"], at = "W2", axis = [-0.2, 0, 1]}
a = {between = ["crank", "rod1"], at = "A", kind = "spherical"}
b = {between = ["crank", "rod2"], at = "B", kind = "spherical"}
c = {between = ["rod1", "wing1"], at = "C1", kind = "spherical"}
e = {between = ["rod2", "wing2"], at = "C2", kind = "spherical"}
f = {between = ["ground", "tube"], at = "D", kind = "spherical"}
g = {between = ["tube", "rod3"], at = "D", kind = "prismatic"}
h = {between = ["rod3", "crank"], at = "A", kind = "spherical"}
"""
"""A crank in space that two wings follow, and a damper."""


@pytest.mark.parametrize("hand", ["psi", "other"])
def test_what_follows_a_driven_body_in_space_is_left_out(hand: str, tmp_path: Path) -> None:
    text = WINGS.replace('hand = "psi"', f'hand = "{hand}"')
    wing = derived(f"wing_{hand}", script_of(f"wing_{hand}", text, tmp_path), tmp_path)
    loop = read_loop(tmp_path / f"wing_{hand}.toml")
    loop_script("wing", loop, "")
    gone = "wing2, rod2, tube and rod3" if hand == "psi" else "wing1, rod1, tube and rod3"
    assert loop.notes == [
        f"wing_{hand}.toml: {gone} follow a driven body, and do not move the hand; they are left "
        f"out"
    ]
    side = 1 if hand == "psi" else -1
    axis = np.array([0.2 * side, 0, 1]) / np.sqrt(1.04)
    arm = np.array([0.02 * side, 0, 0])
    for q in np.linspace(-3, 3, 20):
        p, status = wing.fk([q])
        assert not status.any()
        for psi in p[:, 0]:  # Rodrigues' formula
            turned = arm * np.cos(psi) + np.cross(axis, arm) * np.sin(psi)
            turned += axis * axis.dot(arm) * (1 - np.cos(psi))
            end = turned + np.array([0.02 * side, 0.06, 0])
            near = 0.01 * side * np.array([np.cos(q), np.sin(q), 0])
            assert abs(np.linalg.norm(end - near) - 0.06) < 1e-14


def test_what_follows_the_hand_stays(tmp_path: Path) -> None:
    text = WINGS.replace('hand = "psi"', 'hand = "C2"')
    with pytest.raises(TableError, match=r'other holds wing2 .* write hand = "other"; C2 follows'):
        script_of("tip", text, tmp_path)


HUB = """
hand = "f1"
[bodies]
ground = {O = [0, 0, 0], D = [0.05, 0.05, -0.2]}
hub = {A = [0.1, 0, 0], B = [-0.1, 0, 0]}
blade1 = {A = [0.1, 0, 0], C = [0.15, 0.06, 0]}
blade2 = {B = [-0.1, 0, 0], E = [-0.15, -0.06, 0]}
link1 = {length = 0.23}
link2 = {length = 0.23}
[joints]
theta = {between = ["ground", "hub"], at = "O", axis = [0, 0, 1], driven = true}
f1 = {between = ["hub", "blade1"], at = "A", axis = [1, 0, 0]}
f2 = {between = ["hub", "blade2"], at = "B", axis = [-1, 0, 0]}
c = {between = ["blade1", "link1"], at = "C", kind = "spherical"}
g = {between = ["link1", "ground"], at = "D", kind = "spherical"}
e = {between = ["blade2", "link2"], at = "E", kind = "spherical"}
h = {between = ["link2", "ground"], at = "D", kind = "spherical"}
"""
"""A rotor with two blades, which rods from the ground turn on the hub."""


@pytest.mark.parametrize(("hand", "way"), [("f1", 1), ("f2", -1)])
def test_a_second_follower_on_a_driven_body_is_left_out(
    hand: str, way: int, tmp_path: Path
) -> None:
    text = HUB.replace('hand = "f1"', f'hand = "{hand}"')
    hub = derived(f"hub_{hand}", script_of(f"hub_{hand}", text, tmp_path), tmp_path)
    closed = 0
    for theta in np.linspace(-3, 3, 40):
        p, status = hub.fk([theta])
        for f in p[status == 0, 0]:
            C = np.array([0.15 * way, 0.06 * way * np.cos(f), 0.06 * np.sin(f)])
            x, y = (
                np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]) @ C[:2]
            )
            assert abs(np.linalg.norm([x - 0.05, y - 0.05, C[2] + 0.2]) - 0.23) < 1e-14
            closed += 1
    assert closed > 20


@pytest.mark.parametrize("name", ["c", "R_2", "slide_2"])
def test_a_hand_may_have_the_name_of_a_quantity_of_a_program(name: str, tmp_path: Path) -> None:
    """The crank of a shaper, whose hand is the lever."""
    text = (
        'hand = "psi"\n[parameters]\ng = {value = "0.3"}\nr = {value = "0.1"}\n[bodies]\n'
        'ground = {C = [0, 0], O = [0, "g"]}\ncrank = {P = ["r", "g"]}\nblock = {P = [0, 0]}\n'
        "lever = {}\n[joints]\n"
        'theta = {between = ["ground", "crank"], at = "O", driven = true}\n'
        'psi = {between = ["ground", "lever"], at = "C"}\n'
        'pin = {between = ["crank", "block"], at = "P"}\n'
        's = {between = ["block", "lever"], at = "C", kind = "prismatic", axis = [1, 0]}\n'
    ).replace("psi", name)
    folder = f"named_{name}".lower()
    lever = derived(folder, script_of(folder, text, tmp_path), tmp_path)
    psi, status = lever.fk([0.4])
    assert not status.any()
    pin = 0.3j + 0.1 * np.exp(0.4j)
    assert np.abs(np.imag(pin * np.exp(-1j * psi[:, 0]))).max() < 1e-15
    q, status = lever.ik(psi)
    assert not status.any()
    assert np.allclose(np.abs(q - 0.4).min(axis=(1, 2)), 0, atol=1e-12)


def test_bodies_stay_together_at_a_pin_of_one_that_is_left_out(tmp_path: Path) -> None:
    """The tie rod of a steering gear is pinned to the relay rod where this is pinned to the arm."""
    script = script_of("idler", IDLER, tmp_path)
    assert "coupled(" in script and "relay" not in script
    gear = derived("idler", script, tmp_path)
    q = np.linspace(-0.4, 0.4, 9)[:, None]
    p, status = gear.fk(q)
    pin = -0.3 - 0.15j * np.exp(1j * q)
    arm = -0.7 + (0.05 - 0.14j) * np.exp(1j * p[..., 0])
    assert (status == 0).all() and np.abs(np.abs(pin - arm) - 0.35).max() < 1e-14
