"""A paper with every kind of error, about an arm with one link."""

import sympy as sp

from closedform import (
    Agree,
    Count,
    Derivation,
    Gravity,
    Notation,
    Paper,
    Postures,
    Reading,
    Rounded,
    Solves,
    Undecidable,
    Under,
)
from closedform.model.functions import real
from closedform.proof.claims import as_printed, erratum_result, judge
from closedform.proof.prove import Proof

PAPER = Paper(
    "wrong",
    "On one link & its errors",
    ("A. Nonymous", "B_C"),
    "Proc. {X} ~ 2",
    "The text was read from a scan; a scan error may touch eq. (5).",
)


def derivation(name: str = "one_link", paper: Paper = PAPER) -> Derivation:
    """The derivation, with the errors not in the order of their gravity."""
    d = Derivation(name, "One link", paper, "One link of length l turns about the origin.")
    l = d.parameter("l", value=2, unit="m", meaning="length")
    theta = d.joint("theta")
    hand = sp.Matrix([l * sp.cos(theta), l * sp.sin(theta)])
    d.step("Position", "The link is a vector.", {"x": hand[0]}, published=("(1)", "(2)"))
    x, y, t = real("x"), real("y"), real("t")
    notation = Notation(
        {"x": hand[0], "y": hand[1], "l": l, r"\theta": theta, r"\operatorname{atan2}": sp.atan2}
    )

    def claim(label: str, printed: str, check: object = None, **more: object) -> None:
        d.claim(label, printed, check, where="II. Kinematics", notation=notation, **more)  # type: ignore[arg-type]

    d.erratum(
        "typo", "A misprint | of a sign", Gravity.MISPRINT, why="It is $x$.", use="Nothing follows."
    )
    d.erratum(
        "one-branch",
        "The arctangent has one value",
        Gravity.OMISSION,
        why="It is between $-90^\\circ$ and $90^\\circ$.",
        use="Half of all targets are missed.",
    )
    d.erratum(
        "two-lengths",
        "The link has two lengths",
        Gravity.INCONSISTENCY,
        why="Both cannot hold.",
        use="Measure it.",
    )
    d.erratum(
        "solutions", "The solutions are miscounted", Gravity.STATEMENT, why="One.", use="None."
    )
    d.erratum("root", "A root is rounded wrongly", Gravity.RESULT, why="Digits.", use="Little.")
    d.erratum(
        "cosine",
        "The ordinate has a cosine",
        Gravity.MOTION,
        why="It is the sine.",
        use="The hand is at a wrong place.",
    )
    claim("eq. (1)", r"$x = l \cos\theta$")
    right = r"$y = l \sin\theta$"
    claim("eq. (2)", r"$y = l \cos\theta$", corrected=right, erratum="cosine")
    claim(
        "eq. (3)",
        r"$\theta = \tan^{-1}\left(\frac{y}{x}\right)$",
        lambda f: Solves(
            {f.left: f.right},
            [sp.sin(theta) * x - sp.cos(theta) * y, sp.Integer(0)],
            Postures({x: hand[0], y: hand[1]}, [theta], {l: 2}),
        ),
        means={"x": x, "y": y},
        corrected=r"",
        erratum="one-branch",
    )
    claim(
        "eq. (4)",
        r"“$l = 2 l$”",
        lambda f: Agree(f.left, f.right, ("the length in II", "the length in III")),
        erratum="two-lengths",
    )
    claim(
        "eq. (5)",
        r"$x = -\left(l \cos\theta + l \sin\theta\right) + \left(l \sin\theta\right)$",
        corrected=r"$x = l \cos\theta$",
        erratum="typo",
    )
    claim(
        "Table I",
        r"$\sqrt{2} = 1.42$",
        lambda f: Rounded(f, f.left),
        corrected=r"$\sqrt{2} = 1.41$",
        erratum="root",
    )
    claim(
        "number of solutions",
        "“For a position there are {two} solutions”",
        lambda n: Count([l * sp.cos(theta) - x, l * sp.sin(theta) - y], [theta], n,
                        {x: l * (1 - t**2) / (1 + t**2), y: 2 * l * t / (1 + t**2)}),
        readings=[
            Reading("both coordinates are given"),
            Reading("only $x$ is given", lambda n: Count([l * sp.cos(theta) - x], [theta], n)),
        ],
        corrected="“For a position there are {one} solutions”",
        erratum="solutions",
    )  # fmt: skip
    claim(
        "length",
        r"$\sqrt{x^2 + y^2} = l$",
        lambda f: Under(as_printed(f), "the length $l$ is not negative"),
    )
    claim("speed", "“The method is fast | easy.”", lambda: Undecidable("nobody measured it"))
    d.claim("eq. (2), again", r"$y = l \cos\theta$", where="Abstract", notation=notation,
            corrected=right, erratum="cosine")  # fmt: skip
    return d


def proof(d: Derivation) -> Proof:
    """The verdicts alone."""
    return Proof(
        name=d.name,
        paper=d.paper.key,
        steps=tuple(s.title for s in d.steps),
        identities=0,
        inverses=(),
        claims=tuple(judge(c, d.errata) for c in d.claims),
        errata=tuple(map(erratum_result, d.errata)),
    )
