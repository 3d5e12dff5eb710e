"""Proposes the chain of lemmas for arms of known structure, as the lines that you would write.

Known structures come first (:mod:`closedform.scaffold.known`), then chains of subproblems for
axes of any direction: :mod:`~closedform.scaffold.subproblems` for wrists and shoulders,
:mod:`~closedform.scaffold.six` for six joints without one, :mod:`~closedform.scaffold.slides` for
joints that slide.  You accept or edit the lines, and the proof decides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import sympy as sp

from closedform.mechanics.arm import Serial
from closedform.mechanics.frames import rotation
from closedform.scaffold.arm_angle import NAME as ARM_ANGLE
from closedform.scaffold.arm_angle import ArmAngleMaker
from closedform.scaffold.chainlinks import Single, Singles, singles
from closedform.scaffold.decoupled import DecoupledMaker
from closedform.scaffold.known import KnownMaker
from closedform.scaffold.maker import Maker
from closedform.scaffold.proposal import NoChainError, Proposal, Tried
from closedform.scaffold.recognise import general_degree
from closedform.scaffold.six import SixMaker
from closedform.scaffold.source import GIVEN
from closedform.scaffold.subproblems import SubproblemMaker


def propose(
    arm: Serial,
    given: str = "",
    progress: Callable[[str], None] = lambda _: None,
    refused: Sequence[Tried] = (),
) -> Proposal:
    """The first chain for an arm that is not ``refused``; :class:`NoChainError` if none is known.

    Of an arm of seven joints one is ``given``, by default one that makes the chain short, or
    ``arm_angle``.
    """
    tried: list[Tried] = [*refused]
    never = {t.name for t in refused}
    names = {ARM_ANGLE, *(j.name for j in arm.joints)}
    if given and (len(arm.joints) != 7 or given not in names):
        raise NoChainError(
            f"{given} cannot be given",
            "Of an arm of seven joints one can be given, by its name in the table, or arm_angle.",
        )
    for degree in (2, 4):
        left = {t.name for t in tried if t.error.degree == degree}
        for name, maker, structure in _candidates(arm, given):
            if name in never or (degree > 2 and name not in left):
                continue
            progress(f"trying {name}")
            maker.degree = degree
            try:
                found = structure()
            except NoChainError as error:
                tried = [*(t for t in tried if t.name != name), Tried(name, error)]
                continue
            tried = [t for t in tried if t.name != name]
            lemmas = tuple(dict.fromkeys(maker.used))
            return Proposal(name, found, tuple(maker.lines), lemmas, maker.branches, tuple(tried))
    raise refused[0].error.after(tried) if refused else _refusal(arm, tried)


def _refusal(arm: Serial, tried: Sequence[Tried]) -> NoChainError:
    """Why no chain is known, with the degree of what is left if that is known."""
    if len(arm.joints) == 7 and len(tried) > 2:
        return NoChainError(
            "none of its seven joints, if it is given, leaves a spherical wrist or shoulder, and "
            "two neighbours among the rest that are parallel or meet",
            "Use ssik for a numeric inverse, or write a chain of your own.",
            tried=tried,
        )
    error = next((t.error for t in tried if t.error.degree), tried[0].error)
    if not error.degree and (degree := general_degree(arm)):
        error = NoChainError(error.found, f"{error.needed}  {degree}")
    return error.after(tried)


def _candidates(arm: Serial, given: str) -> Iterator[tuple[str, Maker, Callable[[], str]]]:
    """The chains to try, the cheapest first: a name, a maker, and what writes the lines."""
    n = len(arm.joints)
    known = KnownMaker(arm)
    slides = any(row.slides for group in arm.groups for row in group.rows)
    if n != 7 or slides:
        yield "a known structure", known, known.whole
    if slides and n > 6:
        return
    whole = singles(arm)
    task = arm.coordinates()
    if n == 7 and given == ARM_ANGLE:
        angled = ArmAngleMaker(arm)
        yield "the arm angle", angled, partial(angled.solved_by_arm_angle, whole)
    elif n == 7:
        for single in (whole.joints[k] for k in (2, 6, 4, 0, 3, 1, 5)):
            if given in ("", single.joint.name):
                yield from _six(arm, whole, f", with {single.joint} given", single)
    elif n == 6:
        yield from _six(arm, whole, "", None)
    elif task is not None and task.names == ("x", "y", "z"):
        maker = SubproblemMaker(arm)
        yield (
            "three joints for a point",
            maker,
            partial(maker.solved_point, _met(whole, ((0, 2), (1, 2)))),
        )
    elif task is not None and task.names == ("x", "y", "z", "yaw"):
        maker = SubproblemMaker(arm)
        met = _met(whole, ((0, 2), (1, 2)))
        yield "three joints and a level tool", maker, partial(maker.solved_level, met)
    elif task is None:
        for wrist in (w for w in (3, 2, 1) if 0 <= n - w <= 3):
            maker = SubproblemMaker(arm)
            yield f"the last {wrist} of {n} joints", maker, partial(_fewer, maker, whole, wrist)
        for wrist in (w for w in (3, 2) if 0 <= n - w <= 3):
            maker = SubproblemMaker(arm)
            seen = f"the first {wrist} of {n} joints"
            yield seen, maker, partial(_fewer, maker, whole.reversed(), wrist)
        if n == 5 and not slides:
            maker = SubproblemMaker(arm)
            met = _met(whole, ((3, 2),))
            yield "three parallel joints", maker, partial(maker.solved_in_plane, met)
    if slides and task is None:
        for seen, view in (("", whole), (", from the tool", whole.reversed())):
            apart = DecoupledMaker(arm)
            yield f"slides apart from turns{seen}", apart, partial(apart.decoupled, view)


def _met(whole: Singles, pairs: Sequence[tuple[int, int]]) -> Singles:
    """The arm with the origins of those neighbours that meet moved to where they do."""
    for first, count in pairs:
        whole = whole.met(first, count) or whole
    return whole


def _fewer(maker: SubproblemMaker, whole: Singles, wrist: int) -> str:
    start = len(whole.joints) - wrist
    found = whole.met(start, wrist)
    if found is None:
        which = "first" if whole.inverted else "last"
        raise NoChainError(
            f"its {which} {wrist} axes do not meet in a point",
            "Known are arms of up to three joints before others whose axes meet in a point.",
        )
    structure = maker.solved(_met(found, [(k, 2) for k in range(start - 1)]), wrist)
    joints = f"{wrist} joints that turn" if wrist > 1 else "1 joint that turns"
    return f"{structure}, and {joints} the tool"


def _six(
    arm: Serial, whole: Singles, more: str, given: Single | None
) -> Iterator[tuple[str, Maker, Callable[[], str]]]:
    """An arm of six joints that are not given, from its base and from its tool."""
    for inverted, wrist in ((False, "spherical wrist"), (True, "spherical shoulder")):
        maker = SubproblemMaker(arm)
        yield f"{wrist}{more}", maker, partial(_with_wrist, maker, whole, given, inverted, more)
    if any(joint.slides for joint in whole.joints):
        return
    for name, solve in (
        ("three parallel axes in the middle", SixMaker.parallel_middle),
        ("three parallel axes at the end", SixMaker.parallel_first),
        ("three axes in the middle that meet", SixMaker.meeting_middle),
    ):
        for inverted in (False, True):
            six = SixMaker(arm)
            seen = ", from the tool" if inverted else ""
            yield (
                f"{name}{seen}{more}",
                six,
                partial(_in_six, six, solve, whole, given, inverted, more),
            )


def _in_six(
    maker: SixMaker,
    solve: Callable[[SixMaker, Singles], str],
    whole: Singles,
    given: Single | None,
    inverted: bool,
    more: str,
) -> str:
    return solve(maker, _left_of(maker, whole, given, inverted)) + more


def _left_of(
    maker: SubproblemMaker, whole: Singles, given: Single | None, inverted: bool
) -> Singles:
    """The six joints that are not given, from the base or from the tool."""
    if given is not None:
        maker.give(given)
        turned = rotation("z", given.turn.xreplace({given.joint: GIVEN})).applyfunc(sp.expand_trig)
        whole = whole.with_given(given.number, turned)
    return whole.reversed() if inverted else whole


def _with_wrist(
    maker: SubproblemMaker, whole: Singles, given: Single | None, inverted: bool, more: str
) -> str:
    whole = _left_of(maker, whole, given, inverted)
    ends = [s.number for s in whole.joints[3:]]
    found = whole.met(3, 3)
    if found is None:
        raise NoChainError(
            f"axes {ends[0]}, {ends[1]} and {ends[2]} do not meet in a point",
            "A spherical wrist or shoulder needs three axes that meet.",
        )
    structure = maker.solved(_met(found, ((0, 2), (1, 2))), 3)
    name = "shoulder" if inverted else "wrist"
    return f"spherical {name}, {structure}{more}"


__all__ = ["NoChainError", "Proposal", "propose"]
