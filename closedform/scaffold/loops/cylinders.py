"""Cylinders in a linkage: a tube and a rod, pinned at their outer ends, are one bar."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop


def joined(loop: Loop) -> tuple[Loop, dict[str, Joint]]:
    """The loop with one rod in the place of both bodies of each cylinder, and these rods' joints.

    The length of such a rod is its driven joint.
    """
    bodies, rods, joints = dict(loop.bodies), dict(loop.rods), dict(loop.joints)
    found: dict[str, Joint] = {}
    for slide in [j for j in loop.joints.values() if j.driven and j.kind == "prismatic"]:
        if GROUND in slide.between:
            continue
        tube, piston = slide.between
        others = [j for j in joints.values() if j is not slide]
        ends = [[j for j in others if body in j.between] for body in slide.between]
        pins = [j for end in ends for j in end]
        pinned = all(j.kind == "revolute" and not j.driven for j in pins)
        places = [{j.at for j in end} for end in ends]
        if not pinned or [len(p) for p in places] != [1, 1] or places[0] == places[1]:
            continue
        if loop.hand in {*bodies[tube], *bodies[piston]} - places[0] - places[1]:
            continue  # the hand is elsewhere on it
        del bodies[piston], joints[slide.name]
        bodies[tube], rods[tube] = {}, sp.Symbol(slide.name, real=True)
        for j in ends[1]:
            joints[j.name] = replace(j, between=(tube, j.other(piston)))
        found[tube] = slide
    return replace(loop, bodies=bodies, rods=rods, joints=joints), found


__all__ = ["joined"]
