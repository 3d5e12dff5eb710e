"""The shape of a mechanism: named points, links through them, and joints at them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from closedform.model.names import check_labels


@dataclass(frozen=True)
class Skeleton:
    """The names behind the exported function ``skeleton``.

    ``points`` are in the order of its values.  ``links`` are polylines through points of one rigid
    body, ``ground`` the points that are fixed to the base.  A joint has its kind and the points
    where it is: one for a revolute joint, the two ends of the slide for a prismatic one.
    """

    points: tuple[str, ...]
    links: Mapping[str, tuple[str, ...]]
    joints: Mapping[str, tuple[str, ...]]
    hand: str
    ground: tuple[str, ...]
    kinds: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_labels(self.points, "points of the skeleton")
        check_labels(tuple(self.links), "links of the skeleton")
        named = {p for group in (*self.links.values(), *self.joints.values()) for p in group}
        unknown = sorted((named | {self.hand, *self.ground}) - set(self.points))
        if unknown:
            raise ValueError(f"the skeleton has no point {unknown[0]}")
        unused = sorted(set(self.points) - {p for link in self.links.values() for p in link})
        unused = [p for p in unused if p not in {q for j in self.joints.values() for q in j}]
        if unused:
            raise ValueError(f"no link and no joint of the skeleton has the point {unused[0]}")
