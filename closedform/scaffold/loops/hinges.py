"""Recognises legs that revolute joints keep in planes, and what they leave the hand to do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.guides import GuideLine
from closedform.scaffold.loops.legs import Legs, LoopLeg

KIND = "a hand on hinged legs"
COUNTS = {0: "no", 1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}
FREE = 4
"""The degrees of freedom of a hand in a plane that turns, or on two hinged legs."""
TRIPOD = 3


def hinged(found: Legs, legs: Sequence[LoopLeg]) -> tuple[list[LoopLeg], GuideLine] | None:
    """The legs and what holds the hand; None if no leg is hinged, or if it may be a tripod."""
    ends = {leg.joint.name: ends_of(found, leg.joint) for leg in legs}
    inside = {name: e for name, e in ends.items() if _turns(*e)}
    standing = {name: e for name, e in ends.items() if _stands(*e)}
    on_hand: list[str] = []
    on_ground: list[str] = []
    if inside and standing and _same_axes(standing, inside):
        # to the plane of most legs, the others add no more than a hinge
        if len(inside) < len(standing):
            on_hand, inside = [*inside], {}
        else:
            on_ground, standing = [*standing], {}
    if inside and standing:
        raise found.loop.error(
            f"the legs of {listed([*inside])} keep the hand in a plane that turns, and those of "
            f"{listed([*standing])} in one that stands still; one or the other is supported"
        )
    inside = inside or standing
    on_hand += [name for name, e in ends.items() if name not in inside and _on_hand(*e)]
    on_ground += [name for name, e in ends.items() if name not in inside and _on_ground(*e)]
    if not inside and not on_hand and len(on_ground) in (0, TRIPOD):
        return _in_planes(found, legs, [ends[name][0] for name in on_ground])
    _check_balls(found, {name: ends[name] for name in on_hand})
    others = [*on_hand, *on_ground]
    three = len(on_hand) == TRIPOD and not (inside or on_ground)
    _check_count(found, (inside, others), len(legs), three=three)
    calls = []
    for leg in legs:
        near, far = ends[leg.joint.name]
        name = leg.joint.name
        if name not in inside and name not in others:
            calls.append(leg)
            continue
        by_near = name in on_ground or name in standing
        joint, where = (near, "on_ground") if by_near else (far, "on_hand")
        assert joint.axis is not None
        call = f"Hinged({leg.call}, {where}={found.at(joint.axis)})"
        calls.append(replace(leg, call=call, words=f"{leg.words}, hinged at {joint.name}"))
    if three:
        _check_reverse(found, legs, ends)
        words = "Hinges on the hand keep three legs in planes."
        return calls, GuideLine("ThreeHinges()", KIND, words)
    if not inside:
        words = "Hinges keep two legs in planes."
        return calls, GuideLine("TwoHinges()", KIND, words)
    (near, far), *_ = inside.values()
    _check_plane(found, inside)
    assert near.axis is not None
    assert far.axis is not None
    motion = "stands still" if standing else "turns"
    base = _near_end(found, near)
    foot = (base - near.axis * base.dot(near.axis)).applyfunc(sp.simplify)
    at, kind = (base - foot, "StandingPlane") if standing else (foot, "TurningPlane")
    call = f"{kind}({found.at(at)}, {found.at(near.axis)}, {found.at(far.axis)})"
    words = (
        f"The leg{'s' * (len(inside) > 1)} of {listed([*inside])} keep{'s' * (len(inside) == 1)} "
    )
    return calls, GuideLine(call, KIND, f"{words}the hand in a plane that {motion}.")


def _in_planes(
    found: Legs, legs: Sequence[LoopLeg], hinges: Sequence[Joint]
) -> tuple[list[LoopLeg], GuideLine] | None:
    """Three legs in planes that meet in one point; None if they share a direction."""
    axes = [h.axis for h in hinges if h.axis is not None and all(e.is_number for e in h.axis)]
    if not len(legs) == len(axes) == TRIPOD or sp.simplify(sp.Matrix.hstack(*axes).det()) == 0:
        return None
    if not all(_stays(leg.joint, axis) for leg, axis in zip(legs, axes, strict=True)):
        return None
    calls = [
        replace(
            leg,
            call=f"Hinged({leg.call}, on_ground={found.at(axis)})",
            words=f"{leg.words}, hinged at {hinge.name}",
        )
        for leg, axis, hinge in zip(legs, axes, hinges, strict=True)
    ]
    words = "Hinges on the ground keep three legs in planes that meet in one point."
    return calls, GuideLine("ThreePlanes()", KIND, words)


def _stays(driven: Joint, normal: sp.Matrix) -> bool:
    """Whether a motor moves the near end of its leg in the plane of the hinge."""
    if GROUND not in driven.between or driven.axis is None:
        return True
    off = driven.axis.cross(normal) if driven.kind == "revolute" else [driven.axis.dot(normal)]
    return not any(map(sp.simplify, off))


def ends_of(found: Legs, joint: Joint) -> tuple[Joint, Joint]:
    """The passive joints of a leg: that at its near end, and that on the hand."""
    loop = found.loop
    if GROUND in joint.between:
        body = joint.other(GROUND)
        (near,) = (j for j in loop.of(body) if j is not joint)
        rod = near.other(body)
        far = next(j for j in loop.of(rod) if j is not near)
        return near, far
    on = {GROUND in j.between: j for half in joint.between for j in loop.of(half) if j is not joint}
    return on[True], on[False]


def _near_end(found: Legs, near: Joint) -> sp.Matrix:
    """A point of the ground, or of a driven body, from which a leg begins."""
    body = next((b for b in near.between if near.at in found.loop.bodies[b]), GROUND)
    return found.point(GROUND if GROUND in near.between else body, near)


def _hinge(joint: Joint) -> bool:
    return joint.kind == "revolute" and joint.axis is not None


def _turns(near: Joint, far: Joint) -> bool:
    """Whether a leg keeps the hand in a plane that turns."""
    return near.kind == "universal" and near.axis is not None and _hinge(far)


def _stands(near: Joint, far: Joint) -> bool:
    """Whether a leg keeps an axis of the hand in a plane of the ground."""
    return _hinge(near) and far.kind == "universal" and far.axis is not None


def _same_axes(
    standing: Mapping[str, tuple[Joint, Joint]], inside: Mapping[str, tuple[Joint, Joint]]
) -> bool:
    """Whether the legs of both kinds have parallel axes on the ground, and on the hand."""
    ends = zip(*standing.values(), strict=True), zip(*inside.values(), strict=True)
    for some, others in zip(*ends, strict=True):
        first, *axes = [j.axis for j in (*some, *others) if j.axis is not None]
        if any(map(sp.simplify, (e for axis in axes for e in first.cross(axis)))):
            return False
    return True


def _on_hand(near: Joint, far: Joint) -> bool:
    return near.kind == "spherical" and _hinge(far)


def _on_ground(near: Joint, far: Joint) -> bool:
    return _hinge(near) and far.kind == "spherical"


def _check_count(
    found: Legs, hinges: tuple[Mapping[str, object], Sequence[str]], driven: int, *, three: bool
) -> None:
    """Refuse legs that leave the hand more or fewer degrees of freedom than are driven."""
    inside, others = hinges
    if inside:
        by = f"the leg{'s' * (len(inside) > 1)} of {listed([*inside])}, in one plane"
        by += f", and the hinge of the leg of {listed(others)}" * bool(others)
        left, most = max(FREE - len(others), 0), 1
    else:
        by = f"the hinge{'s' * (len(others) > 1)} of the leg{'s' * (len(others) > 1)} of "
        by, left, most = f"{by}{listed(others)}", max(6 - len(others), 0), 2
    by += f" leave{'s' * (len(inside) + len(others) == 1)}"
    if three:
        most = TRIPOD
    if len(others) > most or (not inside and len(others) < most):
        raise found.loop.error(
            f"{by} the hand {COUNTS[left]} degrees of freedom; this is supported for two "
            f"hinged legs, or one beside legs with universal joints that keep the hand in a plane, "
            f"or three that are all hinged on the ground, or all on the hand"
        )
    if driven != left:
        raise found.loop.error(
            f"{by} the hand {COUNTS[left]} degrees of freedom, so {COUNTS[left]} joints are "
            f"driven, not {driven}"
            + ".  With three, all legs are hinged on the ground, or all on the hand"
            * (driven == TRIPOD and not inside)
        )


def _check_balls(found: Legs, on_hand: Mapping[str, tuple[Joint, Joint]]) -> None:
    """Refuse a leg with a hinge on the hand whose ball joint moves."""
    for name, (near, far) in on_hand.items():
        if GROUND in found.loop.joints[name].between:
            raise found.loop.error(
                f"{far.name} holds {found.turning} by an axis, and {name} moves the ball joint "
                f"{near.name} of the same rod; this is supported if the ball joint stands still on "
                f"the ground, as that of a leg that stretches (SPR), or if the two are "
                f"exchanged (a ball joint on the hand).  The forward problem of three legs of this "
                f"kind has degree 16: the balls stand still, and are on circles of "
                f"{found.turning}.  It is supported if {found.turning} is the mirror image of the "
                f"ground, as that of a Canfield joint: each rod is as long as its crank, and the "
                f"points and axes of {found.turning} are those of the ground with the sign of one "
                f"coordinate changed"
            )


def _check_reverse(
    found: Legs, legs: Sequence[LoopLeg], ends: Mapping[str, tuple[Joint, Joint]]
) -> None:
    """Refuse planes of three legs hinged on the hand that do not meet in a line upright on it."""
    axes = [ends[leg.joint.name][1].axis for leg in legs]
    turns, off = [], sp.S.Zero
    for k, (leg, axis) in enumerate(zip(legs, axes, strict=True)):
        one, other = axes[(k + 1) % TRIPOD], axes[(k + 2) % TRIPOD]
        assert axis is not None
        assert one is not None
        assert other is not None
        turns.append(sp.simplify(one.cross(other)[2]))
        off += turns[-1] * axis.dot(leg.place)
        if axis[2] != 0 or not all(e.is_number for e in axis):
            raise found.loop.error(
                f"{ends[leg.joint.name][1].name} keeps the leg of {leg.joint.name} in a plane, "
                f"which has to be upright on {found.turning}: its axis is horizontal there, in "
                f"numbers"
            )
    if 0 in turns or sp.simplify(off) != 0:
        raise found.loop.error(
            f"the planes of the legs, which are normal to the axes of "
            f"{listed([far.name for _, far in ends.values()])}, have to have three directions and "
            f"to meet in a line of {found.turning}"
        )


def _check_plane(found: Legs, inside: Mapping[str, tuple[Joint, Joint]]) -> None:
    (near, far), *more = inside.values()
    for other in more:
        for one, two in zip((near, far), other, strict=True):
            assert one.axis is not None
            assert two.axis is not None
            if any(sp.simplify(e) for e in one.axis.cross(two.axis)):
                raise found.loop.error(
                    f"{one.name} and {two.name} need parallel axes, so that both legs keep the "
                    f"hand in one plane, which turns"
                )
    assert near.axis is not None
    assert far.axis is not None
    if sp.simplify(near.axis.dot(far.axis)) != 0:
        raise found.loop.error(
            f"the axes of {near.name} and {far.name} have to be at right angles where the hand is "
            f"not turned: both are axes of the universal joint, or parallel to them"
        )


__all__ = ["hinged"]
