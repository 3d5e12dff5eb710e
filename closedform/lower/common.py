"""The common case of a program: the part that remains if no flag holds.

An inverse of a long chain spends half its operations on quantities that count as zero: which value
a joint then takes, and how far rounding may have moved a target.  The common case leaves this out
but reports whether a quantity vanishes; the whole program is then evaluated instead.  The flags
themselves are evaluated in the common case.  This is correct: if no flag holds there, the flags
that a flag depends on do not hold either, so its value is that of the whole program.

A flag does not count if the target was out of reach before: the branch has failed then, whatever
follows.  This is correct as well: consider what happens first in the order of the statements, a
flag that holds or a condition that fails.  Up to there both programs have the same values.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from closedform.lower.graph import Graph, Node, hardly_ever, reachable, rebuild
from closedform.lower.operators import BOOLEAN
from closedform.lower.share import same

Earlier: TypeAlias = "dict[int, set[tuple[Node, ...]]]"
"""For a flag, in each branch that has it, the conditions of the reach that come before it."""


def common_case(
    graph: Graph, roots: Sequence[Node], names: Mapping[int, str], earlier: Earlier
) -> tuple[list[Node], Node, dict[int, str]]:
    """The roots of the common case, the condition that a quantity vanishes, and node names."""
    raised: list[Node] = []
    kept: dict[int, str] = {}
    image: dict[int, Node] = {}
    within = _within_rare_conditions(roots)

    def operands(node: Node) -> tuple[Node, ...]:
        return (node.args[0], node.args[2]) if _is_rare_choice(node) else node.args

    def assumed_false(node: Node, image: Node) -> Node:
        if not hardly_ever(node):
            return image
        raised.extend(_alternatives(image))
        return graph.node("false")

    def change(node: Node, args: tuple[Node, ...]) -> Node:
        if node.id in within:
            result = same(graph, node, args)
        elif _is_rare_choice(node):
            raised.extend(_alternatives(args[0]))
            result = args[1]
        else:
            result = same(graph, node, tuple(map(assumed_false, node.args, args)))
        if node.id in names:
            kept.setdefault(result.id, names[node.id])
        image[node.id] = result
        return result

    images = rebuild(roots, change, operands)
    return images, _before_failures(graph, raised, _images(earlier, image)), kept


def _images(earlier: Earlier, image: Mapping[int, Node]) -> Earlier:
    """The same for the images of flags and conditions."""
    found: dict[int, set[tuple[Node, ...]]] = {}
    for flag in earlier.keys() & image.keys():
        cases = {tuple(image[c.id] for c in case) for case in earlier[flag]}
        found.setdefault(image[flag].id, set()).update(cases)
    return found


def _before_failures(graph: Graph, raised: Sequence[Node], earlier: Earlier) -> Node:
    """Whether a flag is raised in a branch whose target is within reach so far."""
    groups: dict[Node, list[Node]] = {}
    for condition in dict.fromkeys(raised):
        parts = reachable([condition], operands=lambda n: n.args if n.op in BOOLEAN else ())
        cases = {case for part in parts for case in earlier.get(part.id, ())}
        order = sorted(cases or [()], key=lambda case: [c.id for c in case])
        within = graph.any([graph.every(case) for case in order])
        groups.setdefault(within, []).append(condition)
    return graph.any([graph.every([w, graph.any(flags)]) for w, flags in groups.items()])


def _is_rare_choice(node: Node) -> bool:
    return node.op == "select" and hardly_ever(node.args[0])


def _within_rare_conditions(roots: Sequence[Node]) -> set[int]:
    """The conditions that hardly ever hold, and the conditions in them."""
    rare = [n for n in reachable(roots) if hardly_ever(n)]
    values = frozenset(n.op for n in reachable(rare)) - BOOLEAN
    return {n.id for n in reachable(rare, values) if n.op in BOOLEAN}


def _alternatives(condition: Node) -> Iterator[Node]:
    if condition.op == "or":
        for part in condition.args:
            yield from _alternatives(part)
    else:
        yield condition
