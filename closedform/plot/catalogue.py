"""Figures with a name and a caption: those of every mechanism, and those of a paper."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.plot.maps import field as field_map
from closedform.plot.maps import workspace
from closedform.plot.motion import motion
from closedform.plot.postures import branches, mechanism, spoken
from closedform.plot.robot import JACOBIANS, Array, Robot
from closedform.plot.sections import Limits, unsectioned
from closedform.plot.style import new_panels, styled
from closedform.plot.symbols import symbol

PANELS = 16
"""The most branches that are drawn side by side."""
INVERSE = "ik"
"""The function whose section in an article has figures, beside the steps."""


@dataclass(frozen=True)
class Figure:
    """A figure of a mechanism: ``draw`` takes its generated module and returns axes.

    ``step`` is the title of the step of the derivation that it belongs to; ``INVERSE``
    stands for the section of that function.  Other figures belong to the description of the
    mechanism.
    """

    name: str
    caption: str
    draw: Callable[[ModuleType], Any]
    step: str = ""


@dataclass(frozen=True)
class PaperFigures:
    """The figures of a paper: those that are drawn, by their numbers, and why others are not."""

    paper: str
    """Its key, as in the errata."""
    heading: str
    """Its authors and title."""
    count: int
    """How many figures it has."""
    drawn: Mapping[int, tuple[str, Figure]]
    """For each number, the mechanism and its figure."""
    missing: Mapping[int, str]
    contradicted: Mapping[int, str] = field(default_factory=dict)
    """What a figure of the paper, or its caption, says that does not hold."""


@dataclass(frozen=True)
class View:
    """How to show a mechanism; angles in radians.

    ``home`` and ``general`` are joints, or targets if there is no forward map.
    """

    home: Sequence[float] | None = None
    general: Sequence[float] | None = None
    mode: int = 0
    shown: Mapping[str, float] = field(default_factory=dict)
    """Dimensions that the example does not have, because they would not be seen in it."""
    faint: Collection[str] = ()
    hues: Mapping[str, int] = field(default_factory=dict)
    """The numbers of the colours of links that have one of their own."""
    plane: tuple[str, str] | None = None
    at: Sequence[float] | None = None
    """A target, for the other coordinates of the section."""
    given: float | None = None
    """What the inverse takes besides a target, if it is not that of a regular posture."""
    limits: Limits | None = None
    on_sphere: bool = False
    """Whether the hand stays on a sphere, so that its workspace is a part of that."""
    measured: tuple[str, str] | None = None
    """The plane of the map of conditioning, if it is another one."""
    unit: str = ""
    """That of lengths; none if the dimensions may have any."""
    published: str = ""
    """The mechanism that models this one as its paper does, to be compared with it."""


def standard(view: View) -> list[Figure]:
    """The figures that every mechanism has, as far as its task allows them."""
    return [
        Figure(
            "mechanism",
            "The mechanism at home (left) and in a general posture (right), with the axes of its "
            "joints, its lengths and its angles." + _shown(view),
            lambda robot: _both(robot, view),
        ),
        Figure(
            "branches",
            "All postures that reach one target, one for each branch of the inverse.",
            lambda robot: branches(
                robot, faint=view.faint, given=view.given,
                general=view.general, mode=view.mode,
            ),
            INVERSE,
        ),
        Figure(
            "workspace",
            f"How many branches reach each point of {_shown_part(view)}. Black lines are where "
            "branches end; the legend names the factors of the singular set that vanish there. "
            "Other lines are where a factor of some branch vanishes inside.",
            lambda robot: workspace(
                robot, view.plane, at=view.at, limits=view.limits, unit=view.unit, given=view.given
            ),
            INVERSE,
        ),
        Figure(
            "conditioning",
            "The inverse condition number of the Jacobian: 1 where all directions are alike, 0 "
            "where the mechanism is singular. Between them it depends on the units if the "
            "Jacobian mixes lengths and angles; the scale then names them.",
            lambda robot: field_map(
                robot, "condition", view.measured or view.plane, at=view.at,
                limits=None if view.measured else view.limits, unit=view.unit, given=view.given,
            ),
            INVERSE,
        ),
        Figure(
            "motion",
            "The task and its derivative over the joint, a curve for each assembly mode. Dots are "
            "where a factor of the singular set vanishes, which the legend names.",
            lambda robot: motion(robot, unit=view.unit),
            INVERSE,
        ),
    ]  # fmt: skip


def _shown_part(view: View) -> str:
    """What part of the workspace is drawn."""
    return "the sphere on which the hand stays" if view.on_sphere else "a section of the workspace"


def _shown(view: View) -> str:
    """Which dimensions are drawn that the example does not have."""
    if not view.shown:
        return ""
    values = ", ".join(f"{symbol(name)} = {value:g}" for name, value in view.shown.items())
    return f" Here {values}, more than in the example, so that it can be seen."


def fits(robot: ModuleType, figure: str) -> bool:
    """Whether a figure makes sense for a mechanism.

    Branches are shown if there are several, and if they fit on a page.  A map needs two joints;
    with one, the motion is shown.
    """
    r = Robot.of(robot)
    one = len(robot.JOINTS) == 1
    if figure == "branches":
        return 1 < len(robot.BRANCHES) <= PANELS
    if figure == "motion":
        return one and len(robot.TASK) == 1
    if figure not in ("workspace", "conditioning"):
        return True
    if figure == "conditioning":
        return not one and any(map(r.has, JACOBIANS))
    return not one and r.has("ik") and not unsectioned(r)


@styled
def _both(robot: ModuleType, view: View) -> Any:
    r = Robot.of(robot)
    postures = (_at_zero(r) if view.home is None else view.home, view.general)
    if postures[0] is None:  # both are chosen, and the same
        return pictured(robot, view, postures[1])
    panels = new_panels(1, 2, spatial=not r.flat, size=(7.4, 3.7))
    for ax, posture in zip(panels, postures, strict=True):
        pictured(robot, view, posture, ax=ax, lettered=ax is not panels[0])
    return panels[0]


def _at_zero(r: Robot) -> Array | None:
    """The joints at zero, if the mechanism can be assembled there, and is more than a point."""
    q = np.zeros(len(r.module.JOINTS))
    if not r.has_forward_map or not (modes := r.modes_at(q)):
        return None
    return q if np.ptp(r.points(q)[modes[0]], axis=0).any() else None


def pictured(robot: ModuleType, view: View, posture: ArrayLike | None, **style: Any) -> Any:
    """Draw one of the postures of a view; by default a posture that is far from singular."""
    r = Robot.of(robot)
    params = r.params._replace(**view.shown)
    style |= {"faint": view.faint, "hues": view.hues, "params": params}
    if r.has_forward_map:
        r = Robot.of(robot, params)
        q = r.posture() if posture is None else posture
        mode = view.mode if view.mode in r.modes_at(q) else None
        return mechanism(robot, posture, mode=mode, **style)
    return mechanism(robot, x=posture, **style)


__all__ = ["Figure", "PaperFigures", "View", "fits", "spoken", "standard"]
