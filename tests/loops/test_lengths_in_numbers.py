"""Mechanisms whose lengths are numbers cannot be scaled, so powers of a large target overflow.

What cannot vanish, because it is a number, is no special case of them.
"""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from loop_files import derived, read_script, script_of
from places import TESTS

from closedform import prove
from closedform.emit.pages import pages

STAGE = """
from closedform import Derivation, Paper, Stretch, platform

d = Derivation("three_legs", "3-RPR", Paper("three_legs", "Three legs", ("A. Nonymous",)), "Legs.")
legs = [((0, 0), (0, 0)), ((16, 0), (17, 0)), ((0, 10), (13, 16))]
platform(
    d,
    [
        Stretch(d.joint(f"q{k}", "prismatic"), foot, on_hand=end)
        for k, (foot, end) in enumerate(legs, 1)
    ],
)
"""


def test_a_leg_that_overflows_is_no_answer(tmp_path: Path) -> None:
    stage = derived("three_legs", STAGE, tmp_path, crosscheck=True)
    near, far = [3, 4, 0.5], [1e299, 1e299, 0.5]
    q, status = stage.ik([near, far])
    assert np.isclose(q[0, 0, 0], 5) and status.tolist() == [[0], [1]]
    assert np.isnan(q[1]).all()
    assert np.isclose(stage.ik([3e100, 4e100, 0.5]).q[0, 0], 5e100)


def in_numbers(name: str) -> str:
    """A file of a mechanism with the values of its parameters instead of their names."""
    text = (TESTS / "held_out_loops" / f"{name}.toml").read_text("utf-8")
    values = {k: p["value"] for k, p in tomllib.loads(text)["parameters"].items()}
    head, _, rest = text.partition("[bodies")
    bodies, _, joints = rest.partition("[joints")
    for letter, value in values.items():
        head = re.sub(rf"^{letter} = .*\n", "", head, flags=re.MULTILINE)
        bodies = re.sub(rf'\b{letter}\b(?=[^"\n]*"[],}}])', value, bodies)
    return f"{head}[bodies{bodies}[joints{joints}"


@pytest.mark.parametrize(
    ("name", "forward", "back"),
    [("three_rrp", 2, 8), ("three_psp", 2, 1), ("tilted_tripteron", 1, 1)],
)
def test_roots_of_numbers_in_equations_are_proved(
    name: str, forward: int, back: int, tmp_path: Path
) -> None:
    """Coefficients that are irrational numbers, where parameters give names to them."""
    proof = prove(read_script(script_of(name, in_numbers(name), tmp_path)))
    assert {i.function: i.solutions for i in proof.inverses} == {"fk": forward, "ik": back}


@pytest.mark.parametrize("name", ["ankle", "capaman", "cylinder", "double_wishbone", "oldham"])
def test_articles_have_no_case_in_which_a_number_is_zero(name: str, tmp_path: Path) -> None:
    """A crank of 0.04 had none, and the article of a suspension ended in a ValueError."""
    d = read_script(script_of(name, in_numbers(name), tmp_path))
    (article,) = pages(d, prove(d), ["latex"]).files.values()
    assert not re.search(r"\$(\\frac\{\d+\}\{\d+\}|\d+) = 0\$ \(", article)
    assert "crank has no length" not in article
