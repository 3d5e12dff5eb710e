"""Serial chains: from a table of joints to the pose, the Jacobians and their determinant.

A chain is given by rows of Denavit-Hartenberg (standard or modified) or by the screws of its axes
at home.  One call derives, proves and exports all that serial arms have in common.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.operations import operations
from closedform.mechanics import coupled, linkwise, mounted
from closedform.mechanics.by_axes import AXES, by_axes
from closedform.mechanics.entries import RowError, check_unit, constant, dh_row, exact, rigid
from closedform.mechanics.factored import factored_determinant
from closedform.mechanics.frames import (
    denavit_hartenberg,
    exponential,
    frame_along,
    homogeneous,
    multiplied_out,
    plane_angle,
    reduce_circle,
    rotation,
    simplest,
)
from closedform.mechanics.links import Group, Link, Motion, Row, groups_of
from closedform.mechanics.linkwise import Named
from closedform.mechanics.mobility import dependent_in_chain, dependent_joints, singular_everywhere
from closedform.mechanics.places import Places
from closedform.mechanics.skeleton import serial_skeleton, skeleton
from closedform.mechanics.twists import SHIFT, SPELLED, TURN, TURNED, differentiated
from closedform.model.derivation import Derivation

FORWARD_ALONE: ContextVar[bool] = ContextVar("FORWARD_ALONE", default=False)
"""Whether ``export`` only returns the forward map, which is enough to prove an inverse."""
TASK = [f"T{i}{j}" for i in range(1, 5) for j in range(1, 5)]
POSE = "Pose of the tool in the base frame."
GEOMETRIC = "The geometric Jacobian: rows (v; omega), v of the origin of the tool."


@dataclass(frozen=True)
class Serial:
    """A serial chain of joints: ``pose`` of the tool, and the twist of each joint at a posture.

    ``space`` and ``body`` are the 6xn Jacobians, twists ``(v; omega)`` in the base frame and in
    that of the tool; ``geometric`` has the velocity of the tool's origin and the angular velocity,
    both in base axes.
    """

    joints: tuple[sp.Symbol, ...]
    moves: tuple[sp.Matrix, ...]
    groups: tuple[Group, ...]
    """The joints by parallel axes, between the frames ``lead`` and ``last``."""
    lead: sp.Matrix
    last: sp.Matrix
    unmounted: Serial | None = None
    """The same without the first of the moves, if that is a tilted mount."""
    coupling: coupled.Coupling | None = None
    """How the joints move the axes, if some follow others."""

    @cached_property
    def _frames(self) -> Places:
        return Places(self.groups, self.lead, self.last)

    @cached_property
    def pose(self) -> sp.Matrix:
        if self.unmounted:
            return mounted.moved(self.moves[0], self.unmounted.pose)
        return self._frames.pose()

    @property
    def axes(self) -> tuple[sp.Symbol, ...]:
        """The joint of each axis; those that follow others are no joints of the arm."""
        return self.coupling.axes if self.coupling else self.joints

    def _by_joint(self, columns: Iterable[sp.Matrix]) -> sp.Matrix:
        """The twists of the joints from those of the axes."""
        twists = sp.Matrix.hstack(*columns)
        return reduce_circle(twists * self.coupling.rates) if self.coupling else twists

    def _driven(self, twists: Named) -> Named:
        """The same in the names of a program."""
        by = self.coupling
        return Named(twists.program, twists.matrix * by.rates) if by else twists

    @cached_property
    def space(self) -> sp.Matrix:
        if self.unmounted:
            return mounted.carried(self.moves[0], self.unmounted.space)
        return self._by_joint(self._frames.at_base(k, j) for k, j in self.places)

    @cached_property
    def body(self) -> sp.Matrix:
        if self.unmounted:
            return self.unmounted.body
        return self._by_joint(self._frames.at_end(k, j) for k, j in self.places)

    @cached_property
    def geometric(self) -> sp.Matrix:
        if self.unmounted:
            return mounted.turned(self.moves[0], self.unmounted.geometric)
        return self._by_joint(self._frames.at_tool(k, j) for k, j in self.places)

    @cached_property
    def middle(self) -> sp.Matrix:
        """The twists in that frame along the chain in which they are shortest."""
        return min(
            (
                self._by_joint(self._frames.seen_from(k, j, cut) for k, j in self.places)
                for cut in range(1, len(self.groups) + 1)
            ),
            key=operations,
        )

    @property
    def places(self) -> list[tuple[int, int]]:
        """The group of each axis, and its position in the group."""
        return [(k, j) for k, group in enumerate(self.groups) for j in range(len(group.rows))]

    @property
    def position(self) -> sp.Matrix:
        return self.pose[:3, 3]

    @property
    def links(self) -> list[linkwise.Link]:
        """The groups of links between the base and the tool, joints with parallel axes together."""
        return linkwise.links_of(self.groups, self.axes, self.lead, self.last)

    def require_regular(self, name: str) -> None:
        """Raise ``SingularEverywhereError`` if no posture is regular."""
        task, n = self.coordinates(), len(self.joints)
        if task is None and (n > 6 or self._rank() == n):
            return
        J = self.middle if task is None else task.J
        square = J.rows == n
        if dependent_joints(J, self.joints)[0] < n and (not square or factored_determinant(J) == 0):
            raise singular_everywhere(name, J, self.joints)

    def coordinates(self) -> Coordinates | None:
        """As many task coordinates as joints: those of x, y, z and the yaw that the joints move.

        None if the whole pose is the task, or if the choice is not evident.
        """
        n = len(self.joints)
        if n > 4:  # more than x, y, z and the yaw
            return None
        moved = [i for i in range(6) if any(e != 0 for e in self.geometric.row(i))]
        linear = [i for i in moved if i < 3]
        rows = next((r for r in (moved, linear) if len(r) == n and set(r) <= {0, 1, 2, 5}), None)
        if rows is None:
            return None
        J = self.geometric.extract(rows, list(range(n)))
        if rows != moved and dependent_joints(J, self.joints)[0] < n == self._rank():
            return None  # a wrist, or a last joint whose axis has the origin of the tool on it
        values = [self.position[i] if i < 3 else self._yaw() for i in rows]
        names = tuple(("x", "y", "z", "roll", "pitch", "yaw")[i] for i in rows)
        return Coordinates(names, tuple(rows), sp.Matrix(values), J)

    def _rank(self) -> int:
        """The number of ways in which the joints move the tool, at ordinary postures."""
        rates = self.coupling.rates if self.coupling else None
        return dependent_in_chain(self.groups, self.joints, rates)[0]

    def _yaw(self) -> sp.Expr:
        """The angle of the tool about z, for an arm whose joints turn it about z alone."""
        turns = self.geometric.row(5)
        home = self.pose[:3, :3].subs(dict.fromkeys(self.joints, 0))
        return sum(
            (w * joint for w, joint in zip(turns, self.joints, strict=True)),
            plane_angle(home[0, 0], home[1, 0]),
        )

    def export(
        self, d: Derivation, singular: Mapping[str, Any] | None = None, *, given: Any = None
    ) -> Any:
        """Record pose, Jacobians and determinant as proved steps, and export them as functions.

        ``singular`` names the factors of the determinant that depend on a joint, as they should be
        printed; by default the determinant is factored. Of seven joints one may be ``given``: the
        determinant is that of the columns of the others. Returns the forward map that an inverse
        must solve: the task coordinates in the joints where the arm has as many (see
        :meth:`coordinates`), else the pose.
        """
        q, task, links = self.joints, self.coordinates(), self.links
        if not d.task:
            d.task = list(task.names if task else TASK)
        if FORWARD_ALONE.get():
            return self.pose if task is None else task.values
        self.require_regular(d.name)
        pose = linkwise.pose(d.program(), links)
        long = by_axes(d, self.pose, self.moves, q)
        turns, apart = self.pose.atoms(sp.sin, sp.cos), self.unmounted
        shown = {"T": long.pose if long else self.pose}
        jacobians = long.jacobian if long else {"J": self.geometric}
        if apart:
            shown, jacobians = mounted.shown(d, apart.pose, apart.geometric)
        d.step(
            "Pose",
            "T is the product of the motions from link to link."
            + "  Angles about parallel axes are added." * any(f.args[0].is_Add for f in turns),
            {f"A_{i}": A for i, A in enumerate(self.moves, 1)} | shown,
            proves=(
                "T is the product of the motions, and what the printed code computes link by link."
            ),
            equal=lambda: [*self._multiplied(), (pose.explicit, self.pose)],
        )
        d.explain({f"A_{i}": "motion from link to link" for i in range(1, len(self.moves) + 1)})
        _export(d, ("pose", POSE), q, {"T": pose}, equation="T")
        drawn = serial_skeleton(d, self.groups, self.axes, self.lead, self.last)
        skeleton(d, **drawn, hand_at=self.position)
        geometric = self._driven(linkwise.geometric_jacobian(d.program(), links, self.axes))
        space = self._driven(linkwise.space_jacobian(d.program(), links, self.axes))
        body = self._driven(linkwise.body_jacobian(d.program(), links, self.axes))
        spelled = max(operations(self.space), operations(self.body)) <= SPELLED

        def equal() -> list[tuple[Any, Any]]:
            seen, J, J_s, J_b = apart or self, self.geometric, self.space, self.body
            twists = seen.geometric, seen.space, seen.body
            return [
                *differentiated(seen.pose, q, twists, spelled=spelled),
                *([(mounted.turning(self.moves[0]) * seen.geometric, J)] if apart else []),
                *(long.equal(self.pose, J) if long else ()),
                (geometric.explicit, J),
                (space.explicit, J_s),
                (body.explicit, J_b),
            ]

        d.step(
            "Jacobians",
            "The columns are the twists (v; omega) of the joints in this posture.  The twist of a "
            "revolute joint is its axis and the velocity that it gives to the origin; that of a "
            "prismatic joint is its direction.  Differentiating the pose gives the same."
            + ("" if spelled else TURNED)
            + (AXES if long else "")
            + (coupled.FOLLOWED if self.coupling else "")
            + (mounted.MOUNTED if apart else ""),
            jacobians
            | ({"J_s": self.space, "J_b": self.body} if spelled else {"J_s": SHIFT, "J_b": TURN}),
            proves=(
                "J is the derivative of the position, with the axes below it. The derivative of T "
                "with respect to each joint is its column of J_s, as a matrix, times T; it is "
                "also T times its column of J_b."
                + ("" if spelled else "  Both follow from J as stated.")
            ),
            equal=equal,
        )
        if task is None:
            self._export_pose_task(d, pose, geometric)
            self._export_pose_determinant(d, singular, given)
        else:
            self._export_coordinates(d, task, pose, geometric, singular)
        for frame, name, found, equation in (
            ("the base frame", "jacobian_space", space, "J_s"),
            ("its own frame", "jacobian_body", body, "J_b"),
        ):
            summary = f"Twist (v; omega) of the tool in {frame} per joint rate."
            _export(d, (name, summary), q, {"J": found}, equation=equation)
        return self.pose if task is None else task.values

    def _multiplied(self) -> list[tuple[sp.Matrix, sp.Matrix]]:
        """The product of the motions beside the pose; first that of all but a mount."""
        if self.unmounted is None:
            return [(sp.prod(self.moves), self.pose)]
        return [*self.unmounted._multiplied(), (self.moves[0] * self.unmounted.pose, self.pose)]

    def _export_pose_task(self, d: Derivation, pose: Named, geometric: Named) -> None:
        q = self.joints
        _export(d, ("fk", POSE), q, {"T": pose}, equation="T")
        summary = "Velocity and angular velocity of the tool, in base axes, per joint rate."
        _export(d, ("jacobian", summary), q, {"J": geometric}, GEOMETRIC, equation="J")

    def _export_pose_determinant(
        self, d: Derivation, singular: Mapping[str, sp.Expr] | None, given: sp.Symbol | None
    ) -> None:
        others = [k for k, joint in enumerate(self.joints) if joint != given]
        if len(others) != 6:
            return
        # the determinant is the same in every frame, so it is taken where the twists are shortest
        det, name, without = factored_determinant(self.middle[:, others]), "J", ""
        if given is not None:
            name = rf"J_{{\hat{{{self.joints.index(given) + 1}}}}}"
            without = f" without the column of {given}, which is given"
            d.explain({name: f"J without the column of {given}"})
        self._export_determinant(d, {rf"\det {name}": det}, (), singular, without)

    def _export_coordinates(
        self,
        d: Derivation,
        task: Coordinates,
        pose: Named,
        geometric: Named,
        singular: Mapping[str, sp.Expr] | None,
    ) -> None:
        q = self.joints
        place = pose.part([i for i in task.rows if i < 3], [3])
        values, notes = list(place.matrix), []
        if "yaw" in task.names:
            turn = task.values[-1]
            d.step(
                "Task coordinates",
                "The joints turn the tool about z alone: its yaw is the direction of its x axis.",
                {r"\psi": turn},
                proves="The x axis of the tool is (cos(psi), sin(psi)).",
                equal=[(self.pose[:2, 0], sp.Matrix([sp.cos(turn), sp.sin(turn)]))],
            )
            values.append(sp.atan2(sp.sin(turn), sp.cos(turn)))
            notes.append("The yaw is reduced to (-pi, pi].")
        shown = ", ".join(task.names)
        d.function(
            "fk",
            f"Task coordinates ({shown}).",
            {"q": q},
            {"x": values},
            program=place.program,
            notes=notes,
        )
        J = geometric.part(task.rows, range(len(q)))
        name = r"J_{\mathrm{task}}"
        summary = f"Derivative of ({shown}) with respect to the joints."
        _export(d, ("jacobian", summary), q, {"J": J}, equation=name)
        det = factored_determinant(task.J)
        check = [
            (task.values.jacobian(q), task.J),
            (task.J.det(method="berkowitz"), det),
        ]
        self._export_determinant(d, {name: task.J, rf"\det {name}": det}, check, singular)

    def _export_determinant(
        self,
        d: Derivation,
        shown: Mapping[str, Any],
        equal: Sequence[tuple[Any, Any]],
        singular: Mapping[str, sp.Expr] | None,
        without: str = "",
    ) -> None:
        q, (*others, (name, det)) = self.joints, shown.items()
        factors = joint_factors(det, q)
        if singular is not None:
            factors, d.singularities = list(singular.values()), tuple(singular)
            rest = _quotient(det, sp.prod(factors), q)
            if missing := [f for f in joint_factors(rest, q) if f.has(*q) and f not in factors]:
                raise ValueError(f"{d.name}: the determinant has the factor {missing[0]} too")
            equal, det = [*equal, (det, rest * sp.prod(factors))], rest * sp.prod(factors)
        d.step(
            "Determinant and singular set",
            "If the links have a length, the arm is singular exactly where a factor that "
            "contains a joint vanishes: the "
            f"joints{without and ', except the one that is given,'} then cannot move the tool in "
            "some direction.",
            {**dict(others), name: det},
            proves=(
                "The determinant is the stated product, and its remaining factor does not depend "
                "on the joints."
            ),
            equal=[*equal, (det, sp.cancel(det / sp.prod(factors)) * sp.prod(factors))],
        )
        d.function(
            "determinant",
            f"Determinant of the Jacobian{without}.",
            {"q": q},
            {"det": det},
            equation=name,
        )
        summary = "The factors of the determinant that depend on a joint."
        d.function("singularities", summary, {"q": q}, {"factors": factors})
        if len(d.singularities) != len(factors):
            written = (f.primitive()[1] for f in factors)
            d.singularities = tuple(f"{f} = 0".replace("**", "^") for f in written)


def _export(
    d: Derivation,
    named: tuple[str, str],
    q: Sequence[sp.Symbol],
    result: Mapping[str, Named],
    *notes: str,
    equation: str,
) -> None:
    """Export a function of the joints: its name with a summary, and its result."""
    ((output, value),) = result.items()
    d.function(
        *named,
        {"q": q},
        {output: value.matrix},
        program=value.program,
        notes=notes,
        equation=equation,
    )


@dataclass(frozen=True)
class Coordinates:
    """Task coordinates: their names, their values in the joints, and their derivative.

    ``rows`` are their places among x, y, z, roll, pitch and yaw.
    """

    names: tuple[str, ...]
    rows: tuple[int, ...]
    values: sp.Matrix
    J: sp.Matrix


def joint_factors(det: sp.Expr, joints: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """The factors of a determinant that depend on a joint, each once."""
    return [f.as_base_exp()[0] for f in sp.Mul.make_args(det) if f.has(*joints)] or [det]


def _quotient(product: sp.Expr, divisor: sp.Expr, joints: Sequence[sp.Symbol]) -> sp.Expr:
    """The quotient of expressions if it contains no angle, from their values at one posture."""
    at: dict[sp.Expr, sp.Expr] = {}
    for k, q in enumerate(joints):
        t = sp.Rational(1, k + 2)
        at |= {sp.sin(q): 2 * t / (1 + t**2), sp.cos(q): (1 - t**2) / (1 + t**2)}
    values = (sp.expand_trig(e).xreplace(at) for e in (product, divisor))
    return sp.factor(sp.cancel(next(values) / next(values)))


def from_dh(
    d: Derivation, rows: Sequence[Sequence[Any]], *, modified: bool = False, tool: Any = None
) -> Serial:
    """The chain of a Denavit-Hartenberg table with rows ``(a, alpha, d, theta)``.

    The variable of a row is the joint in it, with either sign: in ``theta`` for a revolute joint,
    in ``d`` for a prismatic one.  A row without a joint is a fixed transform, such as a base or a
    tool. ``modified`` rows are Craig's (proximal).  ``tool`` is the pose of the tool in the last
    frame.
    """
    moves, lead = [], sp.eye(4)
    links: list[Link] = []
    for i, row in enumerate(rows, 1):
        where = f"{d.name}: row {i} of the Denavit-Hartenberg table"
        a, alpha, offset, theta = entries = dh_row(d, row, where)
        moves.append(denavit_hartenberg(a, alpha, offset, theta, modified=modified))
        motion = _motion(d, entries, where)
        step = homogeneous(rotation("x", alpha), (a, 0, 0))
        if modified:
            lead = _followed(lead, links, step)
        if motion:
            links.append(Link(motion, theta, offset, sp.eye(4)))
        else:
            fixed = denavit_hartenberg(sp.S.Zero, sp.S.Zero, offset, theta)
            lead = _followed(lead, links, fixed)
        if not modified:
            lead = _followed(lead, links, step)
    if not links:
        raise RowError(f"{d.name}: no row of the Denavit-Hartenberg table contains a joint")
    last = sp.eye(4) if tool is None else rigid(d, tool, "the tool")
    rest = () if tool is None else (last,)
    turned = sp.eye(3)
    if lead[:2, 2].is_zero_matrix:  # the base is turned about the first axis, as the joint turns
        turned, lead = lead[:3, :3], homogeneous(sp.eye(3), tuple(lead[:3, 3]))
    joints = tuple(link.motion.joint for link in links)
    arm = Serial(joints, (*moves, *rest), tuple(groups_of(links, turned)), lead, last)
    return _coupled(d, arm)


def _motion(d: Derivation, entries: Sequence[sp.Expr], where: str) -> Motion | None:
    """The motion of the joint of a row; None if the row has no joint."""
    joints = {j.symbol: j.kind for j in d.joints}
    held = sorted({s for e in entries for s in e.free_symbols if s in joints}, key=str)
    if not held:
        return None
    if len(held) > 1:
        raise RowError(f"{where} must contain at most one joint, not {', '.join(map(str, held))}")
    (joint,) = held
    coupled.require_driven(d, joint, where)
    column, name = (3, "theta") if joints[joint] == "revolute" else (2, "d")
    place = entries[column]
    if not place.has(joint):
        raise RowError(
            f"{where}: the {joints[joint]} joint {joint} must stand in the column {name}"
        )
    sense = place.diff(joint)
    if sense not in (1, -1) or any(
        e.has(joint) for e in (*entries[:column], *entries[column + 1 :])
    ):
        raise RowError(
            f"{where}: the joint {joint} must stand in the column {name} alone, with either sign, "
            f"as it is or with a constant added to it, not as "
            f"{place if sense not in (1, -1) else tuple(entries)}"
        )
    return Motion(joint, joints[joint] == "prismatic", int(sense))


def _followed(lead: sp.Matrix, links: list[Link], step: sp.Matrix) -> sp.Matrix:
    """The constant motion before the first joint; ``step`` goes there, or to the last joint."""
    before = links[-1].after if links else lead
    plain = sp.eye(4) in (before, step)
    after = before * step if plain else simplest((before * step).applyfunc(sp.expand))
    if not links:
        return after
    links[-1] = links[-1]._replace(after=after)
    return lead


def from_screws(
    d: Derivation,
    axes: Sequence[tuple[sp.Expr, Sequence[Any], Sequence[Any]]],
    home: Any,
    *,
    base: Any = None,
) -> Serial:
    """The chain of axes ``(joint, direction, point)`` at home; ``home`` is the pose of the tool.

    A joint that turns may have a constant angle added to it; home is where the sum is zero.  A
    direction is a unit vector; the point of a prismatic joint does not matter.  All of them are
    seen from the frame ``base``, such as that of a tilted mount; its pose is the identity by
    default.  Raises :class:`RowError` if something is not an axis or not a pose.
    """
    if not axes:
        raise RowError(f"{d.name}: there are no axes")
    kinds = {j.symbol: j.kind for j in d.joints}
    motions: list[Motion] = []
    directions, points, turns, moves = [], [], [], []
    for i, (variable, direction, point) in enumerate(axes, 1):
        where = f"{d.name}: axis {i}"
        variable = exact(variable, where)
        joint = next((s for s in variable.free_symbols if s in kinds), variable)
        if joint not in kinds:
            raise RowError(f"{where}: {joint} is not a joint; declare it with d.joint")
        coupled.require_driven(d, joint, where)
        (offset,) = constant(d, [variable - joint], where)
        if offset != 0 and kinds[joint] != "revolute":
            raise RowError(f"{where}: {joint} slides; put {offset} into the points after it")
        w = constant(d, direction, where)
        at = constant(d, point, where)
        if len(w) != 3 or len(at) != 3:
            raise RowError(f"{where} needs a direction and a point of 3 coordinates each")
        check_unit(w, where)
        revolute = kinds[joint] == "revolute"
        twist = sp.Matrix([*at.cross(w), *w]) if revolute else sp.Matrix([*w, 0, 0, 0])
        motions.append(Motion(joint, not revolute))
        directions.append(w)
        points.append(at)
        turns.append(variable)
        moves.append(exponential(twist, variable))
    home = rigid(d, home, "the pose at home")
    frame = frame_along(directions[0])
    lead = homogeneous(frame, tuple(points[0]))
    groups: list[Group] = []
    current: list[Row] = []
    for i, (joint, slides, _) in enumerate(motions):
        sign = 1 if frame[:, 2] == directions[i] else -1
        last = i == len(motions) - 1
        step = _seen(frame, (home[:3, 3] if last else points[i + 1]) - points[i])
        turn = sp.S.Zero if slides else sp.expand(sign * turns[i])
        shift = tuple(step + sp.Matrix([0, 0, sign * joint if slides else 0]))
        current.append(Row(sign, turn, shift, slides))
        if last or directions[i + 1] not in (frame[:, 2], -frame[:, 2]):
            after = home[:3, :3] if last else frame_along(directions[i + 1])
            groups.append(Group(tuple(current), _seen(frame, after)))
            frame, current = after, []
    moved = tuple(motion.joint for motion in motions)
    arm = _coupled(d, Serial(moved, (*moves, home), tuple(groups), lead, sp.eye(4)))
    return arm if base is None else _mounted(arm, rigid(d, base, "the base"))


def _coupled(d: Derivation, arm: Serial) -> Serial:
    """The arm of axes that may follow others, in the joints that have motors."""
    coupling = coupled.coupling_of(d, arm.joints)
    if coupling is None:
        return arm
    moves, groups = tuple(map(d.couple, arm.moves)), coupled.coupled_groups(d, arm.groups)
    joints = tuple(q for q in arm.joints if q in d.actuated)
    return replace(arm, joints=joints, moves=moves, groups=groups, coupling=coupling)


def _mounted(arm: Serial, mount: sp.Matrix) -> Serial:
    """The arm, seen from the base on which its mount stands."""
    lead = reduce_circle((mount * arm.lead).applyfunc(sp.expand))
    apart = arm if mounted.is_tilted(mount) else None
    return replace(arm, moves=(mount, *arm.moves), lead=lead, unmounted=apart)


def _seen(frame: sp.Matrix, value: sp.Matrix) -> sp.Matrix:
    """Vectors in the axes of a frame, with squares of sines and cosines of parameters reduced."""
    seen = frame.T * value
    if seen.free_symbols:
        return reduce_circle(seen.applyfunc(sp.expand))
    return multiplied_out(seen)


__all__ = [
    "Coordinates",
    "Group",
    "Row",
    "RowError",
    "Serial",
    "from_dh",
    "from_screws",
    "joint_factors",
]
