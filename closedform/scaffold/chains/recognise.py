"""Says in words how the axes of an arm are placed: parallel, normal, meeting in a point."""

from __future__ import annotations

from itertools import pairwise

import sympy as sp

from closedform.mechanics.arm import Serial
from closedform.scaffold.chains.chainlinks import Single, parallel, singles
from closedform.scaffold.chains.maker import Z


def recognised(arm: Serial) -> list[str]:
    """What holds between neighbouring axes at every posture, and which three meet."""
    whole = singles(arm)
    joints = whole.joints
    lines = [_relation(a, b) for a, b in pairwise(joints)]
    for k in range(len(joints) - 2):
        three = joints[k : k + 3]
        names = f"axes {three[0].number}, {three[1].number} and {three[2].number}"
        if any(j.slides for j in three):
            continue
        if parallel(three[0]) and parallel(three[1]):
            lines.append(f"{names} are parallel")
        elif whole.met(k, 3) is not None:
            lines.append(f"{names} meet in a point")
    return lines


def _relation(a: Single, b: Single) -> str:
    names = f"axes {a.number} and {b.number}"
    if parallel(a):
        same = a.shift[:2, 0].applyfunc(sp.simplify).is_zero_matrix
        return f"{names} {'coincide' if same and not (a.slides or b.slides) else 'are parallel'}"
    axis = a.end * Z
    normal = sp.simplify(axis[2]) == 0
    if a.slides or b.slides:
        which = " and ".join(f"joint {j.number}" for j in (a, b) if j.slides)
        slide = "slides" if a.slides != b.slides else "slide"
        return f"{names} are {'normal to each other' if normal else 'oblique'}; {which} {slide}"
    meet = sp.simplify(Z.cross(axis).dot(a.shift)) == 0
    if normal:
        return f"{names} {'meet at a right angle' if meet else 'are normal to each other, apart'}"
    return f"{names} {'meet at an oblique angle' if meet else 'are skew, at an oblique angle'}"


__all__ = ["recognised"]
