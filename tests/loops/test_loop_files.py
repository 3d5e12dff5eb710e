"""What ``closedform new`` says of the file of a closed loop."""

import re
from pathlib import Path

import pytest
from loop_files import read_script, script_of
from places import TESTS

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


def test_a_hand_on_a_ball_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="o joins platform to the ground itself"):
        script_of("wrist", BALL, tmp_path)


def test_a_revolute_joint_does_not_hold_a_hand_that_turns(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops/gough.toml").read_text("utf-8")
    with pytest.raises(ValueError, match="would hold platform by an axis"):
        script_of("gough", text.replace('kind = "spherical"', 'kind = "revolute"'), tmp_path)


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
        ("tricept", "a hand that something without a motor holds, of 11 joints"),
        ("watt", "a linkage of many bars, of 7 joints"),
        ("puu", "a hand that does not turn, of 9 joints"),
        ("rssr", "a single loop, of 4 joints"),
    ],
)
def test_new_says_what_kind_of_loop_it_read(name: str, kind: str) -> None:
    path = TESTS / "held_out_loops" / f"{name}.toml"
    assert new(name, "loop", path).inverse == kind
