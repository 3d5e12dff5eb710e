"""Messages for the usual mistakes: what is wrong, where it is, and how to correct it."""

import dataclasses

import pytest
import sympy as sp

from closedform.algebra.shapes import ShapeError, coefficients
from closedform.lemmas.chain import Chain
from closedform.lemmas.links import remainder, slide, turn, two_links
from closedform.lemmas.sine_cosine import linear_pair, sine_cosine
from closedform.lemmas.triangle import Triangle
from closedform.lemmas.zyz import zyz
from closedform.mechanics.arm import RowError, from_dh, from_screws
from closedform.model.derivation import Derivation, Paper, Solved
from closedform.model.functions import Program, branches, real
from closedform.model.inverse import Inverse
from closedform.proof.prove import prove
from closedform.proof.require import ProofError

THETA1, THETA2 = real("theta1"), real("theta2")


def derivation(joints: int = 2) -> Derivation:
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A. Nonymous",)), "An arm.", task=["x", "y"])
    d.parameter("l1", value=2, unit="m", meaning="first link")
    d.parameter("l2", value=1, unit="m", meaning="second link")
    for i in range(joints):
        d.joint(f"theta{i + 1}")
    return d


def planar(d: Derivation) -> sp.Matrix:
    l1, l2 = (p.symbol for p in d.parameters)
    return sp.Matrix([l1 * f(THETA1) + l2 * f(THETA1 + THETA2) for f in (sp.cos, sp.sin)])


def by_hand(d: Derivation, *, wrong: sp.Expr = sp.S.Zero, labels=None) -> None:
    """The inverse of the planar arm as a user would write it, with a chosen error."""
    l1, l2 = (p.symbol for p in d.parameters)
    x, y, sigma, alpha = real("x"), real("y"), real("sigma"), real("alpha")
    program = Program()
    r = program.let("r", sp.sqrt(x**2 + y**2), nonnegative=True)
    triangle = Triangle.from_reach(program, (l1, l2), r, sigma).lemma((THETA2, alpha), r)
    d.function(
        "ik",
        "Inverse.",
        {"x": (x, y)},
        {"q": [sp.atan2(y, x) - triangle[alpha] + wrong, triangle[THETA2]]},
        program=program,
        branches=branches((sigma, labels or {1: "up", -1: "down"})),
        result="Solutions",
    )
    d.inverses.append(Inverse("ik", (THETA1, THETA2), (x, y), tuple(planar(d))))


def test_the_inverse_by_hand_is_right_if_nothing_is_changed() -> None:
    d = derivation()
    by_hand(d)
    assert prove(d).inverses[0].branches == 2


@pytest.mark.parametrize("row", [(1, 0, 0), (1, 0, 0, THETA1, 0)])
def test_a_row_of_the_wrong_length(row) -> None:
    d = derivation()
    message = rf"row 2 of the Denavit-Hartenberg table has {len(row)} entries .* it needs 4: a, al"
    with pytest.raises(RowError, match=message):
        from_dh(d, [(1, 0, 0, THETA1), row])


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ((real("l3"), 0, 0, THETA1), "row 1 .* the symbol l3 is neither a parameter nor a joint"),
        ((1, 0, 0, 0), "no row of the Denavit-Hartenberg table contains a joint"),
        ((1, 0, 0, THETA1 + THETA2), "at most one joint, not theta1, theta2"),
        ((1, 0, THETA1, 0), "the revolute joint theta1 must stand in the column theta"),
        ((0.5, 0, 0, THETA1), r"row 1 .* 0.5 is a float; write an integer or sympy.Rational"),
        ((0, sp.Float("0.5") * sp.pi, 0, THETA1), "the float 0.5"),
    ],
)
def test_a_row_that_makes_no_sense(row, message: str) -> None:
    with pytest.raises((RowError, TypeError), match=message):
        from_dh(derivation(), [row])


def test_a_joint_that_others_move_is_not_one_of_a_serial_arm() -> None:
    """The printed functions took the angles of all joints, and JOINTS had those with motors."""
    d = derivation()
    third = d.joint("theta3", coupling=-(THETA1 + THETA2))
    with pytest.raises(RowError, match=r"row 3 .*: theta3 is moved by other joints"):
        from_dh(d, [(1, 0, 0, THETA1), (1, 0, 0, THETA2), (1, 0, 0, third)])
    with pytest.raises(RowError, match="axis 1: theta3 is moved by other joints"):
        from_screws(d, [(third, (0, 0, 1), (0, 0, 0))], sp.eye(4))


def test_a_screw_that_makes_no_sense() -> None:
    d = derivation()
    for axis, message in (
        ((THETA1, (0, 0, 2), (0, 0, 0)), r"axis 1: the direction \(0, 0, 2\) has the length 2,"),
        ((THETA1, (0, 0), (0, 0, 0)), "a direction and a point of 3 coordinates"),
        ((real("q9"), (0, 0, 1), (0, 0, 0)), "q9 is not a joint"),
    ):
        with pytest.raises(RowError, match=message):
            from_screws(d, [axis], sp.eye(4))


def test_an_unknown_symbol() -> None:
    d = derivation()
    with pytest.raises(ValueError, match=r"arm.fk: the symbol l_1 is neither .* did you mean l1\?"):
        d.function("fk", "", {"q": [THETA1]}, {"x": [real("l_1") * sp.cos(THETA1)]})
    with pytest.raises(ValueError, match=r"theta2 .* is a joint: name it among the inputs of fk"):
        d.function("fk", "", {"q": [THETA1]}, {"x": [sp.cos(THETA2)]})


def test_two_joints_of_one_name() -> None:
    d = derivation()
    with pytest.raises(ValueError, match="theta1 is declared twice: there is a joint theta1"):
        d.joint("theta1", "prismatic")
    with pytest.raises(ValueError, match="l1 is declared twice: there is a parameter l1"):
        d.joint("l1")


def test_a_branch_that_does_not_satisfy_the_forward_map() -> None:
    """The residual, in which coordinate, and a point to try."""
    d = derivation()
    by_hand(d, wrong=sp.pi / 6)
    with pytest.raises(ProofError) as error:
        prove(d)
    message = str(error.value)
    assert message.startswith(
        "arm.ik, branch up: the answer, put into the forward map, does not give"
    )
    assert "x = " in message and "difference = " in message
    assert "; the residual in x is " in message
    residual = message.partition("the residual in x is ")[2]
    assert sp.sympify(residual, {"x": real("x"), "y": real("y")}).has(real("x"))


def test_a_missing_branch() -> None:
    """The count, how it was counted, and a posture that is lost."""
    d = derivation()
    by_hand(d, labels={1: "up"})
    with pytest.raises(ProofError) as error:
        prove(d)
    message = str(error.value)
    assert "2 solutions (counted from a Groebner basis), but 1 branch is given" in message
    assert (
        "The posture (theta1 = " in message and "is not covered: for its image up gives" in message
    )
    lost = float(message.partition("theta2 = ")[2].partition(")")[0])
    assert lost < 0  # the branch that is left has theta2 >= 0


def test_a_missing_branch_of_a_chain() -> None:
    d = derivation()
    ik = Chain(d, planar(d))
    l1, l2 = (p.symbol for p in d.parameters)
    ik.solve(two_links, (THETA1, THETA2), ik.x, (l1, l2), {-1: "down"})
    ik.finish("Inverse.")
    with pytest.raises(ProofError, match=r"2 solutions together, but 1 .* theta2 = .* not covered"):
        prove(d)


def test_a_wrong_equation_of_a_chain() -> None:
    """A sign error in the equation is shown with a posture at which it fails."""
    d = derivation()
    ik = Chain(d, planar(d))
    l1, l2 = (p.symbol for p in d.parameters)
    ik.solve(two_links, (THETA1, THETA2), (ik.x[0], -ik.x[1]), (l1, l2), {1: "up", -1: "down"})
    ik.finish("Inverse.")
    with pytest.raises(
        ProofError, match=r"does not follow from the forward map\. .* difference = "
    ):
        prove(d)


def test_a_chain_that_does_not_use_the_whole_target() -> None:
    """Without its equation for z the answers would not reach the target."""
    d = derivation()
    d.task = ["x", "y", "z"]
    slider = d.joint("d3", "prismatic")
    ik = Chain(d, [*planar(d), slider])
    l1, l2 = (p.symbol for p in d.parameters)
    ik.solve(two_links, (THETA1, THETA2), ik.x[:2], (l1, l2), {1: "up", -1: "down"})
    with pytest.raises(ShapeError, match="no lemma solves for d3"):
        ik.finish("Inverse.")
    d.functions.clear()
    ik.solve(slide, slider, ik.x[2] + ik.x[0])
    ik.finish("Inverse.")
    with pytest.raises(ProofError, match="does not follow from the forward map"):
        prove(d)


def test_a_chain_that_leaves_the_target_undetermined() -> None:
    d = derivation()
    d.task = ["x", "y", "z"]
    ik = Chain(d, [*planar(d), sp.S.Zero + THETA1 * 0 + d.parameters[0].symbol])
    l1, l2 = (p.symbol for p in d.parameters)
    ik.solve(two_links, (THETA1, THETA2), ik.x[:2], (l1, l2), {1: "up", -1: "down"})
    ik.finish("Inverse.")
    with pytest.raises(ProofError, match="leave 1 of the 3 coordinates of the target undetermined"):
        prove(d)


def test_a_lemma_on_an_equation_of_another_shape() -> None:
    d = derivation()
    by_hand(d)
    x, y = real("x"), real("y")
    lemma = sine_cosine(Program(), THETA1, (x, y, x), real("sigma"))
    for equation, message in (
        (sp.sin(THETA1) ** 2 - y, r"linear in sin\(theta1\), cos\(theta1\).* has the term sin\(th"),
        (THETA1 - y, "the unknown occurs elsewhere"),
        (x - y, "does not contain theta1"),
        (sp.sin(2 * THETA1) - y, r"has the term 2\*sin\(theta1\)\*cos\(theta1\)"),
    ):
        bad = dataclasses.replace(d, solved=[Solved("ik", THETA1, lemma, equation)])
        with pytest.raises(ProofError, match=message):
            prove(bad)
        with pytest.raises(ShapeError, match=message):
            coefficients(equation, THETA1)
    bad = dataclasses.replace(d, solved=[Solved("ik", THETA1, linear_pair(THETA1, y, x), x - y)])
    with pytest.raises(ProofError, match="does not contain theta1"):
        prove(bad)


def test_a_lemma_before_its_time() -> None:
    """A coefficient contains a joint that is still unknown, or one is solved twice."""
    d = derivation()
    ik = Chain(d, planar(d))
    x, y = ik.x
    with pytest.raises(ShapeError, match="its coefficients contain theta2, which no lemma has"):
        ik.solve(turn, THETA1, (x, y, d.parameters[1].symbol * sp.cos(THETA2)), {1: "a", -1: "b"})
    d = derivation()
    ik = Chain(d, planar(d))
    ik.solve(remainder, THETA1, ik.x[0])
    with pytest.raises(ShapeError, match="solves for theta1, which an earlier lemma has solved"):
        ik.solve(remainder, THETA1, ik.x[1])
    with pytest.raises(ShapeError, match="beta, which is neither a joint nor an auxiliary"):
        ik.solve(remainder, real("beta"), ik.x[1])


def test_a_lemma_on_a_degenerate_equation() -> None:
    """An equation whose coefficients vanish at every posture says nothing (IKBT's UR5)."""
    d = derivation(1)
    l1, l2 = (p.symbol for p in d.parameters)
    ik = Chain(d, [l1 + 0 * THETA1, l2 + 0 * THETA1])
    x, y = ik.x
    ik.solve(turn, THETA1, (ik.let("a", x - l1), ik.let("b", y - l2), 0), {1: "a", -1: "b"})
    ik.finish("Inverse.")
    with pytest.raises(ProofError, match="degenerate at every posture: the target is on the axis"):
        prove(d)


def test_a_float() -> None:
    d = derivation()
    l1 = d.parameters[0].symbol
    for act in (
        lambda: d.step("S", "", {"x": 0.5 * l1}),
        lambda: d.step("S", "", {"x": l1}, equal=[(sp.Matrix([0.5 * l1]), sp.Matrix([l1]))]),
        lambda: d.step("S", "", {"x": 0.5}),
        lambda: d.function("f", "", {"q": [THETA1]}, {"x": [0.5 * THETA1]}),
        lambda: Program().let("a", 0.5 * l1),
        lambda: d.parameter("l3", value=0.5, unit="m", meaning=""),
    ):
        with pytest.raises(
            TypeError, match=r"0\.5.*|exact rational: write sympy.Rational\('0.5'\)"
        ):
            act()


def test_identities_that_are_computed_later_are_proved_all_the_same() -> None:
    """A function gives them when the proof asks for them, and no earlier."""
    asked = []

    def pairs(right: sp.Expr) -> list[tuple[sp.Expr, sp.Expr]]:
        asked.append(right)
        return [(sp.sin(THETA1) ** 2, right)]

    for right, identities in ((1 - sp.cos(THETA1) ** 2, 1), (sp.cos(THETA1), 0)):
        d = derivation()
        step = d.step("S", "", {"x": THETA1}, equal=lambda right=right: pairs(right))
        assert asked == []
        if identities:
            assert prove(d).identities == identities and len(step.vanishes) == 1
        else:
            with pytest.raises(ProofError, match="'S': the sides of an equation differ"):
                prove(d)
        assert asked == [right]
        asked.clear()
    step = derivation().step("S", "", {}, equal=lambda: [(THETA1, 0.5 * THETA1)])
    with pytest.raises(TypeError, match=r"step 'S'.*0\.5"):
        _ = step.vanishes


def test_a_zyz_lemma_on_what_is_no_such_rotation() -> None:
    """Rz Rx Rz is not a ZYZ rotation: the proof names the lemma, and says where it fails."""
    d = Derivation("wrist", "Wrist", Paper("toy", "Toys", ("A.",)), "A wrist.", task=["T"])
    q = [d.joint(f"theta{i}") for i in (1, 2, 3)]
    arm = from_dh(d, [(0, sp.pi / 2, 0, q[0]), (0, sp.pi / 2, 0, q[1]), (0, 0, 0, q[2])])
    ik = Chain(d, arm.pose)
    ik.solve(zyz, ik.R, q, {1: "noflip", -1: "flip"})
    ik.finish("Inverse.")
    with pytest.raises(ProofError, match="'ZYZ angles' does not follow from the forward map"):
        prove(d)
