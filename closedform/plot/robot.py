"""A generated module as the figures use it: postures, targets, and the points to draw."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots.mechanism import given_of
from closedform.spelling import by_number

Array = NDArray[np.float64]
OK = 0
TRIALS = 400
MANY = 20_000
SELDOM = 0.05
"""If fewer of random joints let a loop close, its slides are drawn over a wider range."""
SHORTER = (-8.0, 1.0)
"""Their shortest and longest length, in powers of two of the size."""
FARTHER = 4
"""Poses are sought up to 2^4 times nearer and farther."""
WIDEST = 16
"""Mechanisms whose lengths are numbers are sought from 2^-16 to 2^16 of their unit."""
MORE_THAN_SLIDES = 1.5
"""A drawing that is hardly larger than its shortest slides has no lengths."""
ELEVATION, AZIMUTH = 22.0, -58.0
"""The direction from which a drawing in space is seen, in degrees."""
_e, _a = np.radians(ELEVATION), np.radians(AZIMUTH)
SEEN = np.array(
    [
        [-np.sin(_a), np.cos(_a), 0.0],
        [-np.sin(_e) * np.cos(_a), -np.sin(_e) * np.sin(_a), np.cos(_e)],
    ]
)
"""The directions to the right and upwards in such a drawing."""
FLAT = 1e-12
STILL = 1e-9
"""What moves less than this part of the size does not move."""
POSITION = "xyz"
"""The coordinates of a task that are lengths, if no forward map gives it."""

JACOBIANS = ("jacobian", "jacobian_space", "jacobian_inverse")
"""Functions whose matrix has the condition number of the Jacobian."""

POSE = {"x": 3, "y": 7, "z": 11}
"""The places of the position among the 16 entries of a pose."""


@dataclass(frozen=True)
class Robot:
    """A generated module with its dimensions."""

    module: ModuleType
    params: Any
    target: Any = None
    """The pose of the hand, if no forward map gives it."""
    given: float | None = None
    """What an arm of seven joints takes besides a target; None: its value at `posture`."""

    @classmethod
    def of(
        cls, module: ModuleType | Robot, params: Any = None, given: float | None = None
    ) -> Robot:
        if isinstance(module, Robot):
            return module
        if not hasattr(module, "JOINTS") or not hasattr(module, "Parameters"):
            raise TypeError(f"{module!r} is not a generated module, such as closedform.planar_2r")
        return cls(module, module.Parameters() if params is None else params, None, given)

    @property
    def name(self) -> str:
        return self.module.__name__.rpartition(".")[2]

    def has(self, function: str) -> bool:
        return function in self.module.__all__

    def require(self, function: str) -> None:
        if not self.has(function):
            raise ValueError(f"{self.name} has no function {function}")

    def call(self, function: str, *arguments: Any) -> Any:
        self.require(function)
        return getattr(self.module, function)(*arguments, params=self.params)

    def measured(self, function: str, q: ArrayLike, x: ArrayLike) -> Any:
        """A function of postures that reach targets, which it takes too without a forward map."""
        return self.call(function, *([] if self.has_forward_map else [x]), q)

    def task(self, q: ArrayLike) -> Array:
        """The forward map; assembly modes come before the coordinates."""
        found = self.call("fk", q)
        return np.asarray(found.p if hasattr(found, "p") else found)

    def points(self, q: ArrayLike) -> Array:
        """The points of the skeleton, an axis for the assembly mode first, even for one mode."""
        if not self.has_forward_map and self.target is None:
            raise ValueError(
                f"{self.name} has no fk: its joints show no posture without the target x"
            )
        given = [] if self.has_forward_map else [self.target]
        found = np.asarray(self.call("skeleton", *given, q))
        return found if self.modes else found[..., None, :, :]

    @property
    def has_forward_map(self) -> bool:
        """Whether the joints determine the hand, by a formula."""
        return self.has("fk")

    @property
    def modes(self) -> tuple[str, ...]:
        return tuple(self.module.ASSEMBLY_MODES)

    def modes_at(self, q: ArrayLike) -> list[int]:
        """The assembly modes that exist for some joints."""
        found = np.isfinite(self.points(np.asarray(q, dtype=float))).all((-2, -1))
        return [int(k) for k in np.flatnonzero(found)]

    def first_mode(self, q: ArrayLike) -> int:
        """The first assembly mode that exists and is not singular; the first one if none is."""
        if not self.modes or not self.has_forward_map:
            return 0
        return int(np.argmax(np.asarray(self.call("fk", q).status) == OK))

    @cached_property
    def size(self) -> float:
        """The sum of the lengths, which is the scale of every figure; 1 on a sphere.

        If the lengths are numbers, it is how large the mechanism is where it can be assembled.
        """
        pairs = zip(self.module.Parameters._fields, self.params, strict=True)
        return sum(abs(float(v)) for name, v in pairs if not self.is_angle(name)) or self._extent()

    def _extent(self) -> float:
        """The size of the drawing where slides, or positions, are as small as they can be."""
        if not self.slides and self.has_forward_map:
            return 1.0
        for scale in 2.0 ** np.arange(-WIDEST, WIDEST):
            if self.has_forward_map:
                drawn = self.points(self._drawn(TRIALS, 0, scale))
            else:
                x = self._posed(TRIALS, 0, scale)
                q, status = self.branches(x)
                met = status == OK
                at = np.broadcast_to(x[:, None], (*met.shape, *x.shape[1:]))[met]
                drawn = np.asarray(self.call("skeleton", at, q[met]))
            drawn = drawn[np.isfinite(drawn).all((-1, -2))]
            if len(drawn):
                found = float(np.median(np.ptp(drawn, axis=-2).max(-1)))
                return found if found > 2.0**-WIDEST * MORE_THAN_SLIDES else 1.0
        return 1.0

    def is_angle(self, parameter: str) -> bool:
        """Whether a parameter is an angle, not a length."""
        return ", in rad" in (getattr(self.module.Parameters, parameter).__doc__ or "")

    def called(self, name: str) -> str:
        """What figures call a joint, or the name itself of anything else."""
        return self._called.get(name, name)

    @cached_property
    def _called(self) -> dict[str, str]:
        module = self.module
        kinds = {name: joint.kind for name, joint in module.SKELETON.joints.items()}
        return by_number(kinds, {*module.Parameters._fields, *module.TASK})

    @property
    def slides(self) -> list[int]:
        kinds = self.module.SKELETON.joints
        return [k for k, n in enumerate(self.module.JOINTS) if kinds[n].kind == "prismatic"]

    def draw(self, n: int, seed: int = 0) -> Array:
        """Random joints; slides have lengths like those of the mechanism, twin arms agree.

        If assembly modes give a pose, the joints are those of random poses; without an inverse,
        slides, such as a rack, are near zero.  Slides that hardly ever let a loop close, such as a
        short cylinder, have values at which it does.
        """
        q = self._drawn(n, seed, self.size)
        posed = self.modes and "T14" in self.module.TASK
        if posed and not self.has("ik"):
            q[:, self.slides] -= self.size / 2
        elif posed:  # random legs of a platform hardly ever close
            answers = self.call("ik", self.poses(n, seed)).q[:, 0]
            q = np.where(np.isfinite(answers).all(-1, keepdims=True), answers, q)
        elif len(self._closing):
            chosen = np.random.default_rng(seed + 1).integers(len(self._closing), size=n)
            q = np.where(self._closes(q)[:, None], q, self._closing[chosen])
        return q

    def _drawn(self, n: int, seed: int, size: float) -> Array:
        """Random angles, and slides around the half of a size."""
        q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (n, len(self.module.JOINTS)))
        for k in self.slides:
            q[:, k] = size / 2 * (1 + q[:, k] / (3 * np.pi))
        names = list(self.module.JOINTS)
        for k, name in enumerate(names):
            twin = name[:-1] + "R"
            if name.endswith("L") and twin in names:
                q[:, k] = q[:, names.index(twin)] + 0.02 * q[:, k]
        return q

    def _closes(self, q: Array) -> NDArray[np.bool_]:
        """Whether the mechanism can be assembled with some joints."""
        return np.asarray(np.isfinite(self.points(q)).all((-1, -2)).any(-1))

    @cached_property
    def _closing(self) -> Array:
        """Joints at which a loop closes, if slides around half of the size hardly ever let it."""
        usual = self._drawn(TRIALS, 0, self.size)
        if not (self.slides and self.modes) or self._closes(usual).mean() > SELDOM:
            return usual[:0]
        rng = np.random.default_rng(0)
        q = rng.uniform(-np.pi, np.pi, (MANY, usual.shape[-1]))
        q[:, self.slides] = self.size * 2.0 ** rng.uniform(*SHORTER, (MANY, len(self.slides)))
        return np.asarray(q[self._closes(q)])

    def reach(self, joint: int) -> tuple[float, float]:
        """Between which values a joint is shown."""
        if joint not in self.slides:
            return -np.pi, np.pi
        if not len(self._closing):
            return 0.0, self.size
        low, high = np.quantile(self._closing[:, joint], (0, 1))
        margin = 0.08 * (high - low)
        return float(low - margin), float(high + margin)

    def poses(self, n: int, seed: int = 0) -> Array:
        """Random poses near the base, for a hand without a forward map.

        If hardly any of them can be reached, they are among those that can, nearer or farther.
        """
        x = self._posed(n, seed, self.size)
        if not len(self._reached):
            return x
        chosen = np.random.default_rng(seed + 1).integers(len(self._reached), size=n)
        kept = self._reaches(x).reshape(-1, *[1] * (x.ndim - 1))
        return np.asarray(np.where(kept, x, self._reached[chosen]))

    def _reaches(self, x: Array) -> NDArray[np.bool_]:
        """Whether some branch reaches a target, and is not singular there."""
        return np.asarray((self.branches(x)[1] == OK).any(-1))

    @cached_property
    def _reached(self) -> Array:
        """Poses that are reached, if hardly any are at the usual distance."""
        usual = self._posed(TRIALS, 0, self.size)
        if not self.has("ik") or self._reaches(usual).mean() > SELDOM:
            return usual[:0]
        far = self.size * 2.0 ** np.arange(-FARTHER, FARTHER + 0.5, 0.5)
        x = np.concatenate([self._posed(TRIALS, k, size) for k, size in enumerate(far)])
        return np.asarray(x[self._reaches(x)])

    def _posed(self, n: int, seed: int, scale: float) -> Array:
        """Random poses whose distance is in proportion to a size."""
        rng = np.random.default_rng(seed)
        task = self.module.TASK
        matrix = next((name[0] for name in task if name[1:] == "11"), "")
        entries = 3 if matrix else len(task)
        place, turn = rng.uniform(-1, 1, (2, n, max(entries, 3)))[..., :entries]
        if not matrix:
            lengths = np.array([name in POSITION for name in task])
            raised = np.array([name == "z" for name in task])
            return np.asarray(np.where(lengths, (place / 4 + 0.35 * raised) * scale, turn))
        found = np.tile(np.eye(4), (n, 1, 1))
        x, y, z = 0.2 * turn.T
        o = 0 * x
        skew = np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)
        half = np.eye(3) + skew
        found[:, :3, :3] = np.linalg.solve(half.transpose(0, 2, 1), half)  # Cayley
        found[:, :3, 3] = place * np.array([0.1, 0.1, 0.25]) * scale
        found[:, 2, 3] += 0.35 * scale
        return found[:, :3, :3] if matrix == "R" else found

    def posture(self) -> Array:
        """A posture that can be assembled and is far from singular, the same on every run."""
        q = self.draw(TRIALS)
        drawn = self.points(q)
        good = np.isfinite(drawn).all((-1, -2)).any(-1)
        measure = np.where(good, 0.1 + self._conditioning(q), 0.0)
        hand = drawn[..., self.module.SKELETON.points.index(self.module.SKELETON.hand), :]
        ahead = np.nanmin(np.where(np.isfinite(hand), hand, np.inf), axis=-2) > 0.1 * self.size
        lowest = np.where(np.isfinite(drawn), drawn, np.inf)[..., 2].min((-1, -2))
        above = lowest > -0.02 * self.size
        seen = np.where(np.isfinite(drawn), drawn, 0.0).max(-3) @ SEEN.T
        spread = np.linalg.svd(seen - seen.mean(-2, keepdims=True), compute_uv=False)[..., -1]
        preferred = (1 + above) * (1 + ahead[..., :2].all(-1)) * (0.1 + spread / self.size)
        return np.asarray(q[np.argmax(measure * preferred)])

    def _conditioning(self, q: Array) -> Array:
        """The inverse condition number of the Jacobian, the best of the assembly modes."""
        name = next((n for n in JACOBIANS[:2] if self.has(n)), None)
        if name is None:
            return np.ones(len(q))
        sizes = singular_values(np.asarray(self.call(name, q)))
        with np.errstate(invalid="ignore", divide="ignore"):
            found = (sizes[..., -1] / sizes[..., 0]).reshape(len(q), -1)
        return np.asarray(np.where(np.isfinite(found), found, 0.0).max(-1))

    @property
    def flat(self) -> bool:
        """Whether the mechanism stays in the plane of x and y."""
        if not self.has_forward_map:
            return set(self.module.TASK) & set(POSITION) == {"x", "y"}
        z = self.points(self.draw(20))[..., 2]
        return bool(np.nanmax(np.abs(z)) <= FLAT * self.size)

    @property
    def mixes_units(self) -> bool:
        """Whether the Jacobian has entries of several units: of lengths and angles, or of poses."""
        task, joints = self.module.TASK, self.module.SKELETON.joints
        places = {c for c in task if c in POSITION or c[0] == "T"}
        kinds = {joints[name].kind for name in self.module.JOINTS if name in joints}
        return "T14" in task or 0 < len(places) < len(task) or len(kinds) > 1

    @cached_property
    def centre(self) -> str:
        """The fixed point of a spherical mechanism, or an empty string.

        All points of the skeleton keep their distance from it, and some moving link leads past it.
        """
        if not self.has_forward_map or self.flat:
            return ""
        skeleton = self.module.SKELETON
        drawn = self.points(self.draw(20)).reshape(-1, len(skeleton.points), 3)
        drawn = drawn[np.isfinite(drawn).all((-1, -2))]
        if not len(drawn):
            return ""
        moving = [link for link in skeleton.links.values() if not {*link} <= {*skeleton.ground}]
        for k, name in enumerate(skeleton.points):
            still = np.ptp(drawn[:, k], axis=0).max() <= STILL * self.size
            far = np.linalg.norm(drawn - drawn[:, k : k + 1], axis=-1)
            if still and np.ptp(far, axis=0).max() <= STILL * self.size:
                return name if any(name not in link for link in moving) else ""
        return ""

    @cached_property
    def rails(self) -> list[str]:
        """The slides along a line that is fixed on the ground; others lengthen or turn a link."""
        skeleton, q = self.module.SKELETON, self.draw(20)
        slides = {
            name: joint.points
            for name, joint in skeleton.joints.items()
            if joint.kind == "prismatic" and joint.points[0] in skeleton.ground
        }
        if not slides:
            return []
        given = [] if self.has_forward_map else [self.poses(20)]
        drawn = np.asarray(self.call("skeleton", *given, q)).reshape(-1, len(skeleton.points), 3)
        place = dict(zip(skeleton.points, np.moveaxis(drawn, 1, 0), strict=True))
        found = []
        for name, (start, end) in slides.items():
            gaps = place[end] - place[start]
            gaps = gaps[np.isfinite(gaps).all(-1)]
            if len(gaps) and np.linalg.matrix_rank(gaps, tol=STILL * self.size) < 2:
                found.append(name)
        return found

    def branches(self, x: ArrayLike) -> tuple[Array, NDArray[np.uint8]]:
        """All postures for a target, and their status."""
        found = self.call("ik", np.asarray(x, dtype=float), *self.beside.values())
        return np.asarray(found.q), np.asarray(found.status)

    @cached_property
    def beside(self) -> dict[str, float]:
        """What the inverse takes besides a target, by name."""
        name = given_of(self.module)
        if name is None:
            return {}
        if self.given is not None:
            return {name: self.given}
        q = self.posture()
        joints = dict(zip(self.module.JOINTS, q, strict=True))
        return {name: float(joints[name] if name in joints else self.call(name, q))}

    def mode_that_reaches(self, q: Array, x: ArrayLike) -> NDArray[np.intp]:
        """The assembly mode of each posture that is nearest to its target."""
        if not self.modes:
            return np.zeros(q.shape[:-1], dtype=np.intp)
        images, target = self.task(q), np.asarray(x)
        core = images.shape[q.ndim :]  # of a vector or of a matrix
        target = target.reshape(*target.shape[: target.ndim - len(core)], 1, *core)
        gap = np.abs(images - target).max(tuple(range(q.ndim, images.ndim)))
        return np.asarray(np.argmin(np.where(np.isfinite(gap), gap, np.inf), axis=-1))


def singular_values(J: Array) -> Array:
    """The singular values of Jacobians, the largest first; NaN where an entry is not finite."""
    finite = np.isfinite(J).all((-1, -2))
    found = np.full((*J.shape[:-2], min(J.shape[-2:])), np.nan)
    found[finite] = np.linalg.svd(J[finite], compute_uv=False)
    return found


def positions(r: Robot, target: Array) -> dict[str, int]:
    """The places of the position among the entries of a target."""
    task = list(r.module.TASK)
    return POSE if target.shape == (4, 4) else {n: task.index(n) for n in "xyz" if n in task}
