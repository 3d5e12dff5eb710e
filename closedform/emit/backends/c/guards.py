"""Facts about the values of a program that its C code needs to avoid floating-point exceptions.

A single call neither divides by zero nor takes the square root of a negative number, even if
nothing would use the result.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from closedform.lower import Lowered
from closedform.lower.graph import Node, constant_of, reachable, strip_sign
from closedform.model.tolerances import POWERS_OF_TWO

LOGICAL = frozenset({"and", "or", "not"})
"""Operators that combine conditions."""


def unused_where(schedule: Sequence[Node], roots: Sequence[Node]) -> dict[int, tuple[Node, ...]]:
    """The quotients that are unused if one of some conditions holds that are known before."""
    place = {node.id: k for k, node in enumerate(schedule)}
    away: dict[int, frozenset[int]] = {root.id: frozenset() for root in roots}
    for node in reversed(schedule):
        for k, arg in enumerate(node.args):
            passed = away[node.id]
            if node.op == "select" and k == 2 and arg not in node.args[:2]:
                passed |= {node.args[0].id}
            away[arg.id] = away[arg.id] & passed if arg.id in away else passed
    found = {}
    for node in schedule:
        if node.op == "div" and node.args[1].op != "const":
            known = sorted(place[c] for c in away[node.id] if place[c] < place[node.id])
            if known:
                found[node.id] = tuple(schedule[k] for k in known)
    return found


def given_up_where(lowered: Lowered) -> Iterator[tuple[int, tuple[Node, ...]]]:
    """For quotients of a common case, the conditions that a factor of their divisor counts as zero.

    If one holds, the whole program is evaluated instead.  For each factor it is, among the
    conditions that are already known, the one whose value is nearest to the factor, those about
    what its limit is a multiple of, and those whose value is made of what is nearer to the factor.
    A divisor is left out if it vanishes with a bound that no condition is about.
    """
    if lowered.results[-1].name != "rare":
        return
    place = {node.id: k for k, node in enumerate(lowered.schedule())}
    conditions = list(_raised(lowered))
    parts = {c.id: {n.id for n in reachable([c.args[0]])} for c in conditions}
    needs = {c.id: {n.id for n in reachable([c]) if n.op in ("div", "atan2")} for c in conditions}
    for node in lowered.schedule():
        if node.op != "div" or node.args[1].op == "const":
            continue
        below = {n.id for n in reachable(node.args)}
        known = [c for c in conditions if needs[c.id] <= below]
        if {n.id for n in _bounds(node.args[1])} - {c.args[0].id for c in known}:
            continue
        nearest: dict[int, Node] = {}
        for factor in _factors(node.args[1]):
            near = {n.id for n in reachable([factor])}
            vanish = [c for c in known if c.args[0].id in near]
            if vanish:
                found = max(vanish, key=lambda c: place[c.args[0].id])
                limit = {n.id for n in reachable([found.args[1]])}
                nearest |= {c.id: c for c in known if c is found or c.args[0].id in limit}
                # a length may count as zero by another value that is made of the same ones
                last = {c: max((place[k] for k in near & parts[c.id]), default=-1) for c in known}
                most = max(last.values())
                if most > place[found.args[0].id]:
                    nearest |= {c.id: c for c in known if last[c] == most}
        if nearest:
            yield node.id, tuple(nearest.values())


def _raised(lowered: Lowered) -> Iterator[Node]:
    """The comparisons of which each alone sends a posture within reach to the whole program."""
    guards = [n for n in lowered.schedule() if n.op in ("status", "poison")]
    failures = [a for n in guards for a in n.args[: 2 if n.op == "status" else 1]]
    reach = _compared(failures)

    def alone(node: Node) -> Iterator[Node]:
        match node.op:
            case "le":
                yield node
            case "or":
                for part in node.args:
                    yield from alone(part)
            case "and":
                flags = [part for part in node.args if not _compared([part]) <= reach]
                if len(flags) == 1:
                    yield from alone(flags[0])

    for node in lowered.results[-1].nodes:
        yield from alone(node)


def _compared(conditions: Sequence[Node]) -> set[int]:
    """What conditions are made of."""
    parts = reachable(conditions, operands=lambda n: n.args if n.op in LOGICAL else ())
    return {n.id for n in parts if n.op not in LOGICAL}


def _factors(node: Node) -> Iterator[Node]:
    """The factors of a product, or the node itself."""
    if node.op != "mul":
        yield node
        return
    for arg in node.args:
        yield from _factors(arg)


def _bounds(node: Node) -> Iterator[Node]:
    """The factors of a node, also in roots, that are zero where a target is out of reach."""
    if node.op == "max" and any(constant_of(a) == 0 for a in node.args):
        yield node
    for arg in node.args[: {"mul": 2, "sqrt": 1, "div": 1}.get(node.op, 0)]:
        yield from _bounds(arg)


def final_values(lowered: Lowered) -> frozenset[int]:
    """The nodes whose further operations keep an infinity or a NaN unchanged."""
    schedule, roots = lowered.schedule(), {n.id for n in lowered.roots}
    users: dict[int, list[Node]] = {n.id: [] for n in schedule}
    for node in schedule:
        for arg in node.args:
            users[arg.id].append(node)
    final: set[int] = set()
    for node in reversed(schedule):
        if all(u.id in final and _keeps_infinity(u) for u in users[node.id]) and (
            users[node.id] or node.id in roots
        ):
            final.add(node.id)
    return frozenset(final)


def _keeps_infinity(node: Node) -> bool:
    """Whether an operator does not raise an exception if an operand is infinite."""
    if node.op in ("add", "sub"):
        return any(a.op == "poison" for a in node.args)
    if node.op == "mul":
        return any(a.op == "const" and a.payload != 0 for a in map(strip_sign, node.args))
    return node.op in ("neg", "select")


def not_negative(node: Node) -> bool:
    """Whether a value is never below zero for any parameters; it may be NaN."""
    match node.op:
        case "const" | "tolerance" | "abs" | "sqrt":
            return True
        case "mul":
            return node.args[0] is node.args[1] or all(map(not_negative, node.args))
        case "add":
            return all(map(not_negative, node.args))
        case "max":
            return any(map(not_negative, node.args))
        case "select":
            return all(map(not_negative, node.args[1:]))
        case "min" | "div":
            return all(map(not_negative, node.args))
    return False


def deciding_products(lowered: Lowered) -> Iterator[int]:
    """The products in sums on which a status or a condition depends.

    They are rounded before the addition, as in NumPy; a fused multiply-add could decide differently
    at a threshold.  A choice between a product and the sum does not hinder a compiler: it may add
    before it chooses.
    """
    for node in lowered.deciding():
        if node.op in ("add", "sub"):
            products = [n for a in node.args for n in _chosen(a) if n.op == "mul"]
            yield from (n.id for n in products if not any(map(_is_exact_factor, n.args)))


def _chosen(node: Node) -> Iterator[Node]:
    """What a value may be, up to its sign."""
    node = strip_sign(node)
    if node.op not in ("select", "max", "min"):
        yield node
        return
    for arg in node.args[node.op == "select" :]:
        yield from _chosen(arg)


def _is_exact_factor(node: Node) -> bool:
    """Whether a product with this factor is exact: it is a sign or a power of two."""
    if node.op == "tolerance":
        return node.payload in POWERS_OF_TWO
    value = constant_of(node)
    if value is None:
        return node.op == "sign"
    return bool(value.is_Rational and int(abs(value.p) * value.q).bit_count() == 1)
