"""Chains for up to three joints that carry a point, of which some slide.

A slide leaves what is normal to it to the joints that turn; once they are solved, it is linear.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from closedform.scaffold.chains.chainlinks import Single, parallel, plain
from closedform.scaffold.chains.maker import SIDE, Maker, Solved, Z, point, simple, times, turning
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.source import source

REACH = "{+1: 'front', -1: 'back'}"


class Slides:
    """Writes the lines for joints that carry the point ``p`` and of which some slide."""

    def __init__(
        self,
        maker: Maker,
        joints: Sequence[Single],
        angle: Callable[[Single], str],
        by_axis: Callable[[Single, sp.Matrix, sp.Expr], str] = lambda *_: "",
    ):
        """``by_axis`` solves a joint by the last axis of the arm too, and returns its pair."""
        self.maker, self.angle, self.by_axis = maker, angle, by_axis
        self.sense = {j.number: j.sense for j in joints}
        self.joints = [plain(j) for j in joints]

    def solved(self) -> Solved:
        kinds = "".join("P" if j.slides else "R" for j in self.joints)
        found = getattr(self, f"_{kinds.lower()}", None)
        if found is None:
            raise NoChainError(
                f"the joints that carry its tool or wrist are {kinds} (R turns, P slides)",
                "Up to three joints may carry it.",
            )
        solved: Solved = found(*self.joints)
        return solved

    # One and two joints

    def _p(self, one: Single) -> Solved:
        c = one.shift
        self._slide(one, point("p")[2] - c[2])
        rest = f"p - {source(c)} - {one.joint}_*{source(self.sense[one.number] * Z)}"
        return Solved("a slide", [("", one.end)], rest)

    def _rp(self, one: Single, two: Single) -> Solved:
        c, b = one.shift + one.end * two.shift, simple(one.end * Z)
        if b[:2, 0].is_zero_matrix:
            self._slide(two, (point("p")[2] - c[2]) * b[2])
            pair = self._rotate(one, source(c[:2, 0]), "p")
        else:
            m = Z.cross(b)
            pair = self._turn(one, m, "p", m.dot(c))
            self._vector("q", f"turned({pair}).T * p")
            self._slide(two, b.dot(point("q") - c))
        reach = f"{two.joint}_*{source(self.sense[two.number] * b)}"
        rest = f"turned({pair}).T * p - {source(c)} - {reach}"
        return Solved("a turret and a slide", [(pair, one.end), ("", two.end)], rest)

    def _pr(self, one: Single, two: Single) -> Solved:
        a, u = simple(one.end.T * Z), two.shift
        self._vector("q", times(one.end.T, f"(p - {source(one.shift)})"))
        q = point("q")
        if a[2] != 0:
            self._slide(one, (q[2] - u[2]) / a[2])
            self._less_slid(one, a)
            pair = self._rotate(two, source(u[:2, 0]), "q")
        else:
            m = Z.cross(a)
            pair = self._turned_by(two, u, m, m.dot(q))
            self._vector("to_end", f"turned({pair}) * {source(u)}")
            self._slide(one, a.dot(q - point("to_end")))
            self._less_slid(one, a)
        rest = f"turned({pair}).T * q - {source(u)}"
        return Solved("a slide and a turret", [("", one.end), (pair, two.end)], rest)

    # Three joints

    def _ppp(self, one: Single, two: Single, three: Single) -> Solved:
        G = simple(one.end * two.end)
        self.linear("p", one.shift + one.end * two.shift + G * three.shift, (
            (one, Z), (two, one.end * Z), (three, G * Z),
        ))  # fmt: skip
        return Solved("gantry", [("", j.end) for j in self.joints])

    def _rpp(self, one: Single, two: Single, three: Single) -> Solved:
        a, b = simple(one.end * Z), simple(one.end * two.end * Z)
        c = one.shift + one.end * (two.shift + two.end * three.shift)
        n = simple(a.cross(b))
        self._require_turning(n, one, "its two slides are normal to its first axis")
        pair = self._turn(one, n, "p", n.dot(c))
        self._vector("q", f"turned({pair}).T * p")
        self.linear("q", c, ((two, a), (three, b)))
        return Solved("a turret and two slides", [(pair, one.end), ("", two.end), ("", three.end)])

    def _ppr(self, one: Single, two: Single, three: Single) -> Solved:
        a, b, G = Z, simple(one.end * Z), simple(one.end * two.end)
        c, n = one.shift + one.end * two.shift, simple(Z.cross(b))
        g = simple(G.T * n)
        self._require_turning(g, three, "axis 3 is normal to its two slides")
        value = n.dot(point("p") - c)
        pair = self._turned_by(three, three.shift, g, value)
        link = times(G, f"(turned({pair}) * {source(three.shift)})")
        self._vector("q", f"p - {link}")
        self.linear("q", c, ((one, a), (two, b)))
        return Solved("two slides and a turn", [("", one.end), ("", two.end), (pair, three.end)])

    def _prp(self, one: Single, two: Single, three: Single) -> Solved:
        a, b = simple(one.end.T * Z), simple(two.end * Z)
        t = two.shift + two.end * three.shift
        self._vector("q", times(one.end.T, f"(p - {source(one.shift)})"))
        q = point("q")
        if b[2] == 0 and a[2] != 0:
            self._slide(one, (q[2] - t[2]) / a[2])
            self._less_slid(one, a)
            m = Z.cross(b)
            pair = self._turn(two, m, "q", m.dot(t))
            self._vector("q", f"turned({pair}).T * q", "q3")
            self._slide(three, b.dot(point("q") - t))
        elif a[2] == 0 and b[2] != 0:
            self._slide(three, (q[2] - t[2]) / b[2])
            reach = f"{three.joint}_*{source(self.sense[three.number] * b)}"
            self._vector("to_end", f"{source(t)} + {reach}")
            m = Z.cross(a)
            pair = self._turned_by(two, point("to_end"), m, m.dot(q))
            self._vector("q", f"q - turned({pair}) * to_end", "q2")
            self._slide(one, a.dot(point("q")))
        else:
            raise NoChainError(
                "its slides are oblique to the axis between them, or both along it or normal to it",
                "One of them must be normal to that axis, and the other must not be.",
            )
        turned = [("", one.end), (pair, two.end), ("", three.end)]
        return Solved("a slide, a turn and a slide", turned)

    def _rrp(self, one: Single, two: Single, three: Single) -> Solved:
        t, b = two.shift + two.end * three.shift, simple(two.end * Z)
        if parallel(one) and b[:2, 0].is_zero_matrix and one.end == sp.eye(3):
            value = (point("p")[2] - one.shift[2] - t[2]) * b[2]
            turned = self._level(one, two, t)
            self._slide(three, value)
            return Solved("two links and a slide along their axes", [*turned, ("", three.end)])
        if not parallel(one) and b[2] == 0:
            g = simple(one.end * Z)
            first = self._turn(one, g, "p", t[2] + g.dot(one.shift))
            self._vector("q", times(one.end.T, f"(turned({first}).T * p - {source(one.shift)})"))
            m = Z.cross(b)
            second = self._turn(two, m, "q", m.dot(t))
            self._vector("q", f"turned({second}).T * q", "q2")
            self._slide(three, b.dot(point("q") - t))
        elif not parallel(one) and one.shift.is_zero_matrix:
            e = sp.simplify(b.dot(t))
            h = sp.sqrt(sp.simplify(t.dot(t) - e**2))
            self.maker.add("p_norm = ik.let('p_norm', sqrt(p.dot(p)))")
            self._root(three, e, "p_norm", source(h))
            reach = f"{three.joint}_*{source(self.sense[three.number] * b)}"
            self._vector("to_end", f"{source(t)} + {reach}")
            v, g = point("to_end"), simple(one.end.T * Z)
            second = self._turned_by(two, v, g, point("p")[2])
            self._vector("both_links", times(one.end, f"(turned({second}) * to_end)"))
            because = f"{{{three.joint}: 1, {self.angle(two)}: -(both_links[2] + p[2])}}"
            first = self._rotate(one, "both_links", "p", because)
        else:
            raise NoChainError(
                f"its slide is not normal to axis {two.number}, nor do axes {one.number} and "
                f"{two.number} meet",
                "A turret with a slide needs one of the two; otherwise an equation of degree 4 "
                "remains, which no known chain solves.",
                degree=4,
            )
        turned = [(first, one.end), (second, two.end), ("", three.end)]
        return Solved("a turret, a joint and a slide", turned)

    def _rpr(self, one: Single, two: Single, three: Single) -> Solved:
        a, G = simple(one.end * Z), simple(one.end * two.end)
        g, c = simple(G * Z), one.shift + one.end * two.shift
        if sp.eye(3) == G and a[:2, 0].is_zero_matrix:
            value = (point("p")[2] - c[2] - three.shift[2]) * a[2]
            (first, _), (second, _) = self._level(replace(one, shift=c), three, three.shift)
            self._slide(two, value)
        elif sp.simplify(a.dot(g)) == 0 and not g[:2, 0].is_zero_matrix:
            first = self._turn(one, g, "p", g.dot(c) + three.shift[2])
            self._vector("q", times(G.T, f"(turned({first}).T * p - {source(c)})"))
            along = simple(G.T * a)
            m = Z.cross(along)
            second = self._turned_by(three, three.shift, m, m.dot(point("q")))
            self._vector("q", f"q - turned({second}) * {source(three.shift)}", "q2")
            self._slide(two, along.dot(point("q")))
        elif sp.simplify(a[2]) == 0 and not g[:2, 0].is_zero_matrix:
            first, second = self._slide_from_turret(one, two, replace(three, end=G), c)
        else:
            raise NoChainError(
                f"its slide is not normal to axis {one.number} or {three.number}, or they are "
                f"parallel",
                "A turret, a slide and a joint need a right angle there.",
                degree=4,
            )
        turned = [(first, one.end), ("", two.end), (second, three.end)]
        return Solved("a turret, a slide and a joint", turned)

    def _slide_from_turret(
        self, one: Single, two: Single, three: Single, c: sp.Matrix
    ) -> tuple[str, str]:
        """A slide normal to the first axis: the height of the point gives the third joint.

        What is normal to the slide gives the first.  The third joint is in the frame ``end`` of
        the first one, at ``c`` where the slide is 0.
        """
        G, p, m = three.end, point("p"), Z.cross(simple(one.end * Z))
        carried = f"{source(c)} + {times(G, f'(turned({{}}) * {source(three.shift)})')}"
        across = f"{source(m)}.dot({carried.format('pair')})"
        self.maker.add(
            f"seen_across = CoordinateWithin(lambda pair: {across}, sqrt(p[0]**2 + p[1]**2))"
        )
        height = p[2] - c[2]
        third = self._turned_by(three, three.shift, simple(G.T * Z), height, "seen_across")
        self._vector("to_end", carried.format(third))
        first = self._turn(one, m, "p", m.dot(point("to_end")))
        self._vector("q", f"turned({first}).T * p - to_end")
        self._slide(two, simple(one.end * Z).dot(point("q")))
        return first, third

    def _prr(self, one: Single, two: Single, three: Single) -> Solved:
        a = simple(one.end.T * Z)
        self._vector("p", times(one.end.T, f"(p - {source(one.shift)})"), "p1")
        p, u = point("p"), three.shift
        if two.end == sp.eye(3) and a[2] != 0:
            self._slide(one, (p[2] - two.shift[2] - u[2]) / a[2])
            self._vector("p", f"p - {one.joint}_*{source(self.sense[one.number] * a)}", "p2")
            turned = self._level(two, three, u)
            return Solved("a slide and two links", [("", one.end), *turned])
        if not parallel(two) and a[2] == 0 and not two.shift.is_zero_matrix:
            return self._slide_across(one, two, three, a)
        self.maker.require(
            not parallel(two) and two.shift.is_zero_matrix,
            f"the slide is not normal to axis {two.number}, and axes {two.number} and "
            f"{three.number} are not parallel and do not meet",
            "After a slide that is not normal to the next axis, two axes have to be parallel, or "
            "meet.",
        )
        size = sp.sqrt(sp.simplify(u.dot(u)))
        across = sp.sqrt(p.cross(a).dot(p.cross(a)))
        self._root(one, -a.dot(p), source(size), source(across))
        self._vector("q", f"p - {one.joint}_*{source(self.sense[one.number] * a)}")
        q, g = point("q"), simple(two.end.T * Z)
        third = self._turned_by(three, u, g, q[2])
        self._vector("to_end", times(two.end, f"(turned({third}) * {source(u)})"))
        because = f"{{{one.joint}: -1, {self.angle(three)}: -(to_end[2] + q[2])}}"
        second = self._rotate(two, "to_end", "q", because)
        turned = [("", one.end), (second, two.end), (third, three.end)]
        return Solved("a slide and two joints", turned)

    def _slide_across(self, one: Single, two: Single, three: Single, a: sp.Matrix) -> Solved:
        """A slide normal to the second axis: how far the point is along it gives the third joint.

        What is normal to both gives the second.
        """
        p, m, g = point("p"), Z.cross(a), simple(two.end.T * Z)
        carried = (
            f"{source(two.shift)} + {times(two.end, f'(turned({{}}) * {source(three.shift)})')}"
        )
        self._far_enough(carried.format("pair"), m.dot(p), (two.shift, three.shift))
        third = self._turned_by(three, three.shift, g, p[2] - two.shift[2], "links")
        self._vector("to_end", carried.format(third))
        second = self._turned_by(two, point("to_end"), m, m.dot(p))
        self._vector("q", f"p - turned({second}) * to_end")
        self._slide(one, a.dot(point("q")))
        turned = [("", one.end), (second, two.end), (third, three.end)]
        return Solved("a slide across a turret and a joint", turned)

    # What they have in common

    def _far_enough(self, vector: str, least: Any, parts: Sequence[sp.Matrix]) -> None:
        """Name the goal that a vector, the sum of others, is so far from the z axis."""
        farthest = sum((sp.sqrt(sp.simplify(v.dot(v))) for v in parts), sp.S.Zero)
        self.maker.add(f"far = ik.let('far', {source(sp.Abs(least) + farthest)})")
        lengths = f"{source(sp.Abs(least) + sp.Symbol('far'))}, far"
        self.maker.add(f"links = Links(lambda pair: {vector}, {lengths})")

    def _level(self, one: Single, two: Single, t: sp.Matrix) -> list[tuple[str, sp.Matrix]]:
        """Two links in the plane that is normal to their axes."""
        maker, v = self.maker, t[:2, 0]
        maker.two_links([one.turn, two.turn], [one.shift[:2, 0], v], "p[0]", "p[1]")
        both = f"({maker.pairs[0]} + {maker.less(maker.pairs[1], v)})"
        return [("", sp.eye(3)), (both, two.end)]

    def _vector(self, name: str, value: str, label: str = "") -> None:
        self.maker.add(f"{name} = ik.vector('{label or name}', {value})")

    def _slide(self, joint: Single, value: Any) -> None:
        value = sp.simplify(self.sense[joint.number] * value)
        self.maker.add(f"{joint.joint}_ = ik.let('{joint.joint}_', {source(value)})")
        self.maker.solve("slide", f"{joint.joint}, {joint.joint}_")

    def _less_slid(self, joint: Single, a: sp.Matrix, label: str = "q2") -> None:
        """Take away from the point ``q`` what a slide along ``a`` does."""
        along = source(self.sense[joint.number] * a)
        self._vector("q", f"q - {joint.joint}_*{along}", label)

    def _root(self, joint: Single, e: Any, r: str, h: str) -> None:
        e = sp.simplify(self.sense[joint.number] * e)
        arguments = f"{joint.joint}, {source(e)}, ({r}, {h}), {REACH}"
        self.maker.solve("root", arguments, f"{joint.joint}_", 2)

    def linear(self, q: str, c: sp.Matrix, slides: Sequence[tuple[Single, sp.Matrix]]) -> None:
        """Solve slides along given directions for what the point ``q`` leaves after ``c``."""
        A = sp.Matrix.hstack(*(direction for _, direction in slides))
        square = simple(A.T * A)
        self.maker.require(
            sp.simplify(square.det()) != 0,
            "the directions of its slides depend on each other",
            "Slides need independent directions.",
        )
        values = simple(square.inv() * A.T) * (point(q) - c)
        for (joint, _), value in zip(slides, values, strict=True):
            self._slide(joint, value)

    def _turn(self, joint: Single, n: sp.Matrix, p: str, c: Any) -> str:
        """Solve a joint that turns the direction ``n`` until the point is at ``c`` along it."""
        at = point(p)
        value = sp.simplify(c) - n[2] * at[2]
        pair = self.by_axis(joint, n, value) if p == "p" else ""
        return pair or self._equation(joint, (*turning(n, at), value))

    def _turned_by(self, joint: Single, v: Any, n: sp.Matrix, c: Any, toward: str = "") -> str:
        """Solve a joint that turns the vector ``v`` until it reaches ``c`` along ``n``."""
        a, b = (sp.simplify(e) for e in turning(v, n))
        self.maker.require(
            (a, b) != (0, 0),
            f"joint {joint.number} does not move the point across its slides",
            "A link beside its axis is needed there.",
        )
        return self._equation(joint, (a, b, c - sp.simplify(n[2] * v[2])), toward)

    def _equation(self, joint: Single, sides: tuple[Any, Any, Any], toward: str = "") -> str:
        pair = f"pair{joint.number}"
        shown = ", ".join(source(e) for e in sides)
        more = f", toward={toward}" if toward else ""
        self.maker.solve("turn", f"{self.angle(joint)}, ({shown}), {SIDE}{more}", pair, 2)
        self.maker.levers.append(f"{pair}.lever/ik.size")
        self.maker.solved_as[joint.number] = (self.angle(joint), pair, sp.S.Zero)
        return pair

    def _rotate(self, joint: Single, w: str, v: str, because: str = "") -> str:
        pair = f"pair{joint.number}"
        more = f", because={because}" if because else ""
        self.maker.solve("rotate", f"{self.angle(joint)}, {w}, {v}{more}", pair)
        self.maker.levers.append(f"sqrt({v}[0]**2 + {v}[1]**2)/ik.size")
        self.maker.solved_as[joint.number] = (self.angle(joint), pair, sp.S.Zero)
        return pair

    def _require_turning(self, n: sp.Matrix, joint: Single, found: str) -> None:
        self.maker.require(
            not n[:2, 0].is_zero_matrix,
            found,
            f"Joint {joint.number} must move the point across its slides.",
        )


__all__ = ["REACH", "Slides"]
