"""Planar linkages of files as rigid bodies in numbers, which Newton's method puts together.

This reads a file by other means than the project: each body has a place and a direction, and each
pin is a point.
"""

import tomllib
from pathlib import Path

import numpy as np
from loop_files import newton

GROUND = "ground"


def turned(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


class Linkage:
    """The bodies and joints of a file, whose driven joints have the values ``q``, in order."""

    def __init__(self, path: Path, *q: float):
        data = tomllib.loads(path.read_text("utf-8"))
        values = {k: float(p["value"]) for k, p in data.get("parameters", {}).items()}

        def number(entry: object) -> float:
            return float(eval(str(entry), {"sqrt": np.sqrt, **values}))

        self.hand, self.joints = data["hand"], data["joints"]
        driven = [name for name, joint in self.joints.items() if joint.get("driven")]
        self.q = dict(zip(driven, q, strict=True))
        self.bodies, self.rods = {}, {}
        for name, body in data["bodies"].items():
            points = {k: e for k, e in body.items() if isinstance(e, list)}
            self.bodies[name] = {k: np.array([*map(number, e)]) for k, e in points.items()}
            if "length" in body:
                self.rods[name] = number(body["length"])
        self.free = [n for n, points in self.bodies.items() if n != GROUND and points]
        self.pins = sorted({j["at"] for j in self.joints.values() if not self.slides(j)})
        places = [at for points in self.bodies.values() for at in points.values()]
        self.size = float(np.abs(places).max())

    def slides(self, joint: dict) -> bool:
        return joint.get("kind") == "prismatic"

    def other(self, joint: dict) -> str:
        (body,) = {*joint["between"]} - {GROUND}
        return body

    def held(self, body: str) -> list[str]:
        """The pins of a body."""
        on = [j for j in self.joints.values() if body in j["between"]]
        return list(dict.fromkeys(j["at"] for j in on if not self.slides(j)))

    def split(self, t: np.ndarray) -> tuple[dict, dict]:
        """Where pins are, and the place and direction of each body."""
        n = 2 * len(self.pins)
        pins = dict(zip(self.pins, t[:n].reshape(-1, 2), strict=True))
        return pins, dict(zip(self.free, t[n:].reshape(-1, 3), strict=True))

    def missed(self, t: np.ndarray) -> np.ndarray:
        """By how much pins, rods and joints miss."""
        pins, poses = self.split(t)
        poses = {**poses, GROUND: np.zeros(3)}
        gaps = []
        for name, (x, y, turn) in poses.items():
            for pin in sorted({*self.held(name)} & {*self.bodies[name]}):
                gaps += [*(pins[pin] - [x, y] - turned(turn) @ self.bodies[name][pin])]
        for name, length in self.rods.items():
            a, b = self.held(name)
            gaps.append(np.hypot(*(pins[a] - pins[b])) - length)
        for name, joint in self.joints.items():
            q = self.q.get(name)
            if self.slides(joint):
                gaps += self.slid(joint, (pins, poses), q)
            elif q is not None or name == self.hand:
                gaps += self.pivoted(joint, poses, q)
        return np.array(gaps)

    def pivoted(self, joint: dict, poses: dict, q: float | None) -> list[float]:
        """A body whose angle is a joint has its points where they are at the angle zero."""
        x, y, turn = poses[self.other(joint)]
        pivot = self.bodies[GROUND][joint["at"]]
        gaps = [*(turned(turn) @ pivot + [x, y] - pivot)]
        return gaps if q is None else [*gaps, np.sin((turn - q) / 2)]

    def slid(self, joint: dict, at: tuple[dict, dict], q: float | None) -> list[float]:
        """A cylinder has a length; a body on the ground slides along an axis."""
        pins, poses = at
        if GROUND not in joint["between"]:
            a, b = (p for body in joint["between"] for p in self.held(body))
            return [np.hypot(*(pins[a] - pins[b])) - q]
        (x, y, turn), axis = poses[self.other(joint)], np.array(joint["axis"])
        gaps = [np.sin(turn / 2), axis[0] * y - axis[1] * x]
        return gaps if q is None else [*gaps, axis @ [x, y] - q]

    def hand_at(self, t: np.ndarray) -> np.ndarray:
        _, poses = self.split(t)
        joint = self.joints.get(self.hand)
        if joint is None:
            [body] = [n for n in self.free if self.hand in self.bodies[n]]
            x, y, turn = poses[body]
            place = turned(turn) @ self.bodies[body][self.hand] + [x, y]
            return np.array([*place, turn]) if len(self.turns) > 2 else place
        x, y, turn = poses[self.other(joint)]
        return np.array([[x, y] @ np.array(joint["axis"]) if self.slides(joint) else turn])

    @property
    def turns(self) -> list[bool]:
        """Which coordinates of the hand are angles."""
        if self.hand in self.joints:
            return [not self.slides(self.joints[self.hand])]
        return [False, False, True] if len(self.q) > 2 else [False, False]

    def assembled(self, rng: np.random.Generator) -> np.ndarray | None:
        """The hand in a posture that is found from a random start, if any is."""
        places = rng.uniform(-self.size, self.size, 2 * len(self.pins))
        bodies = rng.uniform(-1, 1, (len(self.free), 3)) * [self.size, self.size, 3]
        t = newton(self.missed, np.array([*places, *bodies.ravel()]))
        return None if t is None else self.hand_at(t)
