"""Arms of up to six joints in other orders: parallel, meeting, oblique and sliding joints."""

import numpy as np
import pytest
import sympy as sp
from chains import arm, solved
from sympy import pi

from closedform.mechanics.mobility import SingularEverywhereError
from closedform.proof.prove import prove
from closedform.proof.require import ProofError
from closedform.scaffold.chains.propose import propose

H = sp.Rational(1, 2)
WRIST = [(0, -pi / 2, 0), (0, pi / 2, 0), (0, 0, H)]
AL, BE = sp.symbols("al be", real=True)

CHAINS = {
    "spherical wrist, axes 2 and 3 parallel": (
        [(0, pi / 2, 1), (2, 0, 0), (H, pi / 2, 0), (0, pi / 4, 2), (0, pi / 4, 0), (0, 0, 1)], 8,
    ),
    "axes 1, 2 and 3 parallel, 5 and 6 meet": (
        [(2, 0, 1), (1, 0, 0), (0, pi / 2, H), (1, pi / 2, H), (0, -pi / 2, 1), (0, 0, H)], 8,
    ),
    "axes 6, 5 and 4 parallel, 3 and 2 meet": (
        [(H, -pi / 2, 1), (0, pi / 2, 0), (1, pi / 2, H), (1, 0, 0), (2, 0, 0), (0, 0, H)], 8,
    ),
    "axes 5, 4 and 3 parallel, 2 and 1 meet": (
        [(0, -pi / 2, 1), (1, pi / 2, 0), (2, 0, 0), (1, 0, H), (H, -pi / 2, 0), (0, 0, 1)], 8,
    ),
    "axes 2, 3 and 4 meet in a point, 5 and 6 meet": (
        [(1, pi / 2, 1), (0, -pi / 2, 0), (0, pi / 2, 0), (1, pi / 2, 1), (0, pi / 2, H),
         (0, 0, 1)], 8,
    ),
    "axes 2, 3 and 4 meet in a point, 5 and 6 are parallel": (
        [(1, pi / 2, H), (0, -pi / 2, 0), (0, pi / 2, 0), (H, pi / 2, 1), (2, 0, 0), (0, 0, 1)], 8,
    ),
}  # fmt: skip


def proved(rows: list, joints: str = "t1 t2 t3 t4 t5 t6 t7") -> tuple[str, int]:
    d, serial = arm(rows, joints)
    serial.require_regular("arm")
    found = propose(serial)
    solved(d, serial, found.source)
    (inverse,) = prove(d).inverses
    assert inverse.branches == found.branches
    return found.structure, inverse.branches


@pytest.mark.parametrize("structure", CHAINS)
def test_the_proof_accepts_six_joints_in_other_orders(structure: str) -> None:
    rows, branches = CHAINS[structure]
    assert proved(rows) == (structure, branches)


def test_the_angles_of_a_wrist_may_be_parameters() -> None:
    rows = [(0, pi / 2, 1), (2, 0, 0), (0, pi / 2, 0), (0, AL, 2), (0, BE, 0), (0, 0, 1)]
    d, serial = arm(rows, al="0.8", be="1.1")
    solved(d, serial, propose(serial).source)
    assert prove(d).inverses[0].branches == 8


SLIDES = {
    "a turret and two slides": ([(H, 0, 1), (0, -pi / 2, None, 0), (0, 0, None, 0)], "t1 d2 d3", 2),
    "a turret, a joint and a slide": (
        [(H, pi / 2, 1), (1, pi / 2, 0), (0, 0, None, 0)], "t1 t2 d3", 4,
    ),
    "spherical wrist, a turret, a joint and a slide": (
        [(0, pi / 3, 1), (0, pi / 4, 1), (0, 0, None, 0), *WRIST], "t1 t2 d3 t4 t5 t6", 8,
    ),
    "spherical wrist, a slide and two joints": (
        [(0, pi / 2, None, 0), (0, pi / 3, 0), (1, pi / 2, H), *WRIST], "d1 t2 t3 t4 t5 t6", 8,
    ),
    "a turret and two slides, and a turn of the level tool": (
        [(0, 0, 1), (0, -pi / 2, None, 0), (0, pi / 2, None, 0), (H, 0, 0)], "t1 d2 d3 t4", 2,
    ),
    "gantry, and 2 joints that turn the tool": (
        [(0, -pi / 2, None, -pi / 2), (0, pi / 2, None, -pi / 2), (0, 0, None, 0),
         (0, -pi / 2, 0), (0, 0, 1)], "d1 d2 d3 t4 t5", 1,
    ),
}  # fmt: skip


@pytest.mark.parametrize("structure", SLIDES)
def test_the_proof_accepts_joints_that_slide(structure: str) -> None:
    rows, joints, branches = SLIDES[structure]
    assert proved(rows, joints) == (structure, branches)


def test_a_wrist_whose_tool_is_beside_its_centre_has_a_pose_as_its_task() -> None:
    rows = [(0, pi / 4, 0), (0, -pi / 3, 0), (H, 0, 1)]
    assert arm(rows)[1].coordinates() is None
    assert proved(rows) == ("a wrist alone, and 3 joints that turn the tool", 2)


def test_joints_that_depend_on_each_other_are_refused_all_the_same() -> None:
    with pytest.raises(SingularEverywhereError, match="has rank 2, not 3"):
        arm([(0, 0, 0), (0, pi / 2, 0), (0, 0, 1)])[1].require_regular("arm")


def test_why_a_rotation_is_one_about_z_must_follow() -> None:
    """The last rotation of a wrist keeps z only if the earlier equations say so."""
    d, serial = arm(CHAINS["spherical wrist, axes 2 and 3 parallel"][0])
    lines = propose(serial).source
    assert "-R_last[0, k]" in lines
    solved(d, serial, lines.replace("-R_last[0, k]", "R_last[0, k]"))
    with pytest.raises(ProofError, match=r"rotation is one about z.*does not follow so"):
        prove(d)


def test_ranks_are_those_of_the_jacobian() -> None:
    """From link to link as from the matrix that is written out."""
    rows = [(0, pi / 2, 1), (2, 0, 0), (1, 0, 0), (1, 0, 0), (0, pi / 2, 1), (0, 0, 0)]
    with pytest.raises(SingularEverywhereError, match="has rank 5, not 6"):
        arm(rows)[1].require_regular("arm")
    serial = arm(CHAINS["axes 1, 2 and 3 parallel, 5 and 6 meet"][0])[1]
    J = sp.lambdify(serial.joints, serial.space)(0.3, 0.7, 1.1, 0.4, 0.9, 0.2)
    assert np.linalg.matrix_rank(J) == 6
