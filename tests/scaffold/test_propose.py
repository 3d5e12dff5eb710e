"""Proposed inverses: the structure is recognised from the axes, and the proof accepts each."""

import ast
from collections.abc import Sequence
from dataclasses import replace

import pytest
import sympy as sp
from chains import run
from sympy import pi

from closedform.lemmas.chain import Chain
from closedform.lower.program import lower
from closedform.mechanics.arm import Serial, from_dh, from_screws
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import real
from closedform.proof.prove import prove
from closedform.proof.require import ProofError
from closedform.scaffold.chains.propose import NoChainError, propose
from closedform.scaffold.inputs.names import NUMBERED, TAKEN

LENGTHS = a, b, c, e, f, g = tuple(real(n, positive=True) for n in "abcefg")
T = t1, t2, t3, t4, t5, t6 = tuple(real(f"t{i}") for i in range(1, 7))
d1, d2, d3 = (real(f"d{i}") for i in range(1, 4))
Rows = Sequence[tuple]


def arm(joints: str, rows: Rows, *, modified: bool = False) -> tuple[Derivation, Serial]:
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    for length in LENGTHS:
        d.parameter(length.name, value=1, unit="m", meaning=length.name)
    for name in joints.split():
        d.joint(name, "prismatic" if name.startswith("d") else "revolute")
    return d, from_dh(d, rows, modified=modified)


SIX = "t1 t2 t3 t4 t5 t6"
KNOWN = {
    "planar arm of two links": (
        "t1 t2", 2,
        [(a, 0, c, t1), (b, 0, 0, t2)],
    ),
    "planar arm of two links and a yaw": (
        "t1 t2 t3", 2,
        [(a, 0, 0, t1), (b, 0, e, t2), (c, 0, 0, t3)],
    ),
    "planar arm of two links and a yaw, with a slide (SCARA)": (
        "t1 t2 d3 t4", 2,
        [(a, 0, c, t1), (b, pi, 0, t2), (0, 0, d3, 0), (0, 0, e, t4 + pi / 2)],
    ),
    "gantry": (
        "d1 d2 d3", 1,
        [(0, pi / 2, d1, pi / 2), (a, pi / 2, d2, pi / 2), (0, 0, d3 + b, 0)],
    ),
    "cylindrical arm": (
        "t1 d2 d3", 2,
        [(0, 0, a, t1), (0, -pi / 2, d2, 0), (0, 0, d3 + b, 0)],
    ),
    "turret and two parallel joints": (
        "t1 t2 t3", 4,
        [(a, pi / 2, b, t1), (c, 0, e, t2), (f, 0, 0, t3)],
    ),
    "axes 1, 2 and 3 neither meet nor are parallel": (
        "t1 t2 t3", 4,
        [(a, pi / 3, 0, t1), (b, pi / 3, e, t2), (c, 0, 0, t3)],
    ),
    "turret, a joint and a slide (polar arm)": (
        "t1 t2 d3", 4,
        [(0, -pi / 2, a, t1), (0, pi / 2, b, t2), (0, 0, d3, 0)],
    ),
    "turret and two parallel joints, with a spherical wrist": (
        SIX, 8,
        [
            (0, pi / 2, 0, t1), (a, 0, 0, t2), (b, -pi / 2, c, t3),
            (0, pi / 2, e, t4), (0, -pi / 2, 0, t5), (0, 0, g, t6),
        ],
    ),
    "turret, a joint and a slide (polar arm), with a spherical wrist": (
        "t1 t2 d3 t4 t5 t6", 8,
        [
            (0, -pi / 2, a, t1), (0, pi / 2, b, t2), (0, 0, d3, -pi / 2),
            (0, -pi / 2, 0, t4), (0, pi / 2, 0, t5), (0, 0, g, t6),
        ],
    ),
    "turret, three parallel joints and two more (UR)": (
        SIX, 8,
        [
            (0, pi / 2, a, t1), (-b, 0, 0, t2), (-c, 0, 0, t3),
            (0, pi / 2, e, t4), (0, -pi / 2, f, t5), (0, 0, g, t6),
        ],
    ),
}  # fmt: skip


@pytest.mark.parametrize("structure", KNOWN)
def test_the_proof_accepts_the_proposal(structure: str) -> None:
    joints, branches, rows = KNOWN[structure]
    d, serial = arm(joints, rows)
    found = propose(serial)
    assert found.structure == structure
    forward = serial.export(d)
    ik = Chain(d, forward, angles=["yaw"] if "yaw" in d.task else [])
    run(found.source, ik)
    ik.finish("Inverse.")
    (inverse,) = prove(d).inverses
    assert inverse.branches == branches == inverse.solutions == found.branches


@pytest.mark.parametrize("structure", KNOWN)
def test_a_table_may_not_use_a_name_of_the_proposal(structure: str) -> None:
    """Every name in the lines is that of a joint, of a parameter, or reserved."""
    joints, _, rows = KNOWN[structure]
    d, serial = arm(joints, rows)
    nodes = list(ast.walk(ast.parse(propose(serial).source)))
    used = {n.id for n in nodes if isinstance(n, ast.Name)}
    used |= {n.arg for n in nodes if isinstance(n, ast.arg)}
    own = {p.symbol.name for p in d.parameters} | {j.symbol.name for j in d.joints}
    own |= {f"{name}_" for name in own}
    assert {name for name in used - own - {"_"} if not NUMBERED.fullmatch(name)} <= TAKEN


def test_the_proposal_for_a_puma_costs_what_the_example_does() -> None:
    """The textbook's inverse takes 507 operations."""
    joints, _, rows = KNOWN["turret and two parallel joints, with a spherical wrist"]
    d, serial = arm(joints, rows)
    ik = Chain(d, serial.pose)
    run(propose(serial).source, ik)
    ik.finish("Inverse.")
    operations = lower(d["ik"], d).operations()
    assert operations["atan2"] == 20
    assert sum(operations.values()) <= 524  # 14 of them for the tool, which is g past the wrist


@pytest.mark.parametrize("robot", ["scara", "ur_arm", "puma560", "stanford_arm"])
def test_the_inverses_of_the_examples_are_proposed(robot: str) -> None:
    """The axes alone lead to the lemmas of the example, for the same joints."""
    import importlib

    module = importlib.import_module(f"closedform.derivations.{robot}")
    found = propose(module.arm)
    (inverse,) = module.d.inverses
    assert found.lemmas == tuple(link.lemma.kind for link in inverse.links)


def test_a_modified_table_and_screws_are_recognised_alike() -> None:
    d, serial = arm(
        "t1 t2 t3",
        [(0, 0, a, t1), (0, pi / 2, e, t2), (b, 0, 0, t3)],
        modified=True,
    )
    pointed = propose(serial)  # the tool is on the last axis
    assert pointed.structure == "a turret and a joint, and 1 joint that turns the tool"
    q = d.actuated
    axes = [
        (q[0], (0, 0, 1), (0, 0, 0)),
        (q[1], (0, 1, 0), (0, e, a)),
        (q[2], (0, 1, 0), (0, e, a + b)),
    ]
    home = sp.Matrix([[1, 0, 0, c], [0, 1, 0, e], [0, 0, 1, a + b], [0, 0, 0, 1]])
    serial = from_screws(d, axes, home)
    found = propose(serial)
    assert found.structure == "turret and two parallel joints"
    ik = Chain(d, serial.export(d))
    run(found.source, ik)
    ik.finish("Inverse.")
    assert prove(d).inverses[0].branches == 4


@pytest.mark.parametrize(
    ("joints", "rows", "why"),
    [
        (
            SIX,
            [(a, pi / 2, 0, x) for x in T],
            "no three neighbouring axes meet in a point or are parallel",
        ),
        (
            SIX,
            [
                *((a, pi / 2, 0, x) for x in T[:3]),
                (b, pi / 2, 0, T[3]),
                (0, pi / 2, 0, T[4]),
                (0, 0, g, T[5]),
            ],
            "no three neighbouring axes meet in a point or are parallel",
        ),
        (
            SIX,
            [
                *((a, 0, 0, x) for x in T[:3]),
                *((b, pi / 2, 0, x) for x in T[3:4]),
                *((b, 0, 0, x) for x in T[4:]),
            ],
            "at every posture its joints t1, t2, t3 and t4 can move while the tool stands still",
        ),
        (
            "t1 t2 t3 t4 t5",
            [(a, pi / 2, b, x) for x in T[:5]],
            "its last 3 axes do not meet in a point",
        ),
    ],
)
def test_it_says_plainly_when_it_knows_no_chain(joints: str, rows: Rows, why: str) -> None:
    """The obstacle is stated as a fact of this arm, separate from what is needed."""
    with pytest.raises(NoChainError, match=f"no chain of lemmas is known.* because .*{why}") as e:
        propose(arm(joints, rows)[1])
    assert why.replace("\\", "") in e.value.found and e.value.needed.endswith(".")


def test_the_proof_decides_and_not_the_proposal() -> None:
    """An edited proposal that is wrong is refused."""
    joints, _, rows = KNOWN["turret and two parallel joints"]
    d, serial = arm(joints, rows)
    found = propose(serial)
    wrong = replace(found, lines=tuple(line.replace("-p[1]", "p[1]") for line in found.lines))
    assert wrong != found
    ik = Chain(d, serial.export(d))
    run(wrong.source, ik)
    ik.finish("Inverse.")
    with pytest.raises(ProofError, match="does not follow from the forward map"):
        prove(d)
