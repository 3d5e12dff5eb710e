"""Operations that a program repeats with other operands, packed as the lanes of vectors.

The legs of a loop are solved alike, and so are the branches of an inverse.  A compiler does not
find this in straight-line code.  A pack is a tuple of nodes with one operator, a lane each; packs
are found from the results downwards, first those of nodes with the same structure.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

from closedform.emit.backends.c.guards import given_up_where
from closedform.lower import Lowered
from closedform.lower.graph import Graph, Node, reachable
from closedform.lower.operators import LEAVES

Lanes = tuple[Node, ...]
LEAST, MOST = 3, 4
"""Fewer nodes are not worth a pack, and more do not fit into the vectors of most processors."""
ANGLES = 8
"""As many angles are computed together: a processor with wider vectors takes half the time."""
COMMUTATIVE = frozenset({"add", "mul", "and", "or", "eq"})


@dataclass(frozen=True, eq=False)
class Pack:
    """Nodes with one operator; ``columns`` has the nodes of each operand, lane by lane."""

    nodes: Lanes
    columns: tuple[Lanes, ...]

    @cached_property
    def width(self) -> int:
        """The number of lanes with the padding: 2, 4 or 8."""
        return 1 << (len(self.nodes) - 1).bit_length()

    @cached_property
    def operands(self) -> tuple[tuple[int, ...], ...]:
        """The columns as the numbers of their nodes."""
        return tuple(tuple(n.id for n in column) for column in self.columns)


@dataclass(frozen=True)
class Block:
    """Packs of one ``width`` that one loop over lanes evaluates; single nodes if it is 1."""

    width: int
    packs: tuple[Pack, ...]


class Packing:
    """The program with its packs; ``blocks`` has them in the order of evaluation."""

    def __init__(self, lowered: Lowered, alone: frozenset[int] = frozenset()):
        """Nodes in ``alone`` are never packed."""
        self.program, renamed = _by_legs(lowered)
        self.nodes = self.program.schedule()
        self.alone = {renamed[k] for k in alone if k in renamed}
        self.keys = _keys(self.program)
        self.shape = _keys(self.program, {"sub": "add"})
        self.heights: dict[int, int] = {}
        for node in self.nodes:
            below = (self.heights[a.id] for a in node.args)
            self.heights[node.id] = 1 + max(below, default=0)
        self.pack: dict[int, Pack] = {}
        # a quotient comes after the conditions under which nothing uses it
        given_up = given_up_where(self.program)
        self.before = {k: tuple(c.id for c in conditions) for k, conditions in given_up}
        self._pack_all()
        self.blocks = self._scheduled()

    @property
    def packs(self) -> list[Pack]:
        return list(dict.fromkeys(self.pack.values()))

    @property
    def spared(self) -> int:
        """How many operations the packs spare, less what it costs to fill their lanes."""
        filled = {c for p in self.packs for c in p.columns if self.gathered(p, c)}
        return sum(len(p.nodes) - 1 for p in self.packs) - sum(map(len, filled))

    def gathered(self, pack: Pack, column: Lanes) -> bool:
        """Whether the nodes of an operand have to be brought into the order of the lanes."""
        if len(set(column)) == 1 or all(n.op in ("sin", "cos") for n in column):
            return False
        found = self.pack.get(column[0].id)
        return found is None or found.nodes != column

    def _pack_all(self) -> None:
        for result in self.program.results:
            angles = [n for n in dict.fromkeys(result.nodes) if _is_angle(n)]
            self._expand_all(angles, ANGLES)
        groups = defaultdict(list)
        for node in self.nodes:
            if self._is_packable(node):
                groups[self.keys[node.id]].append(node)
        for node in reversed(self.nodes):
            group = groups.pop(self.keys[node.id], [])
            if len(group) >= LEAST:
                self._expand_all(self._in_order(group))
        arctangents = [n for n in self.nodes if n.op == "atan2" and n.id not in self.pack]
        for height in sorted({self.heights[n.id] for n in arctangents}):
            level = [n for n in arctangents if self.heights[n.id] == height]
            self._expand_all(level, ANGLES, least=2)
        for result in self.program.results:
            self._expand_all(list(dict.fromkeys(result.nodes)))

    def _expand_all(self, nodes: Sequence[Node], most: int = MOST, least: int = LEAST) -> None:
        for k in range(0, len(nodes), most):
            self._expand(tuple(nodes[k : k + most]), most, least)

    def _is_packable(self, node: Node) -> bool:
        return node.op not in LEAVES and node.id not in self.alone and node.id not in self.pack

    def _in_order(self, group: Sequence[Node]) -> Lanes:
        """The nodes in the order of lanes that an operand has, or that its leaves have."""
        for arguments in zip(*(n.args for n in group), strict=False):
            found = self.pack.get(arguments[0].id)
            if found and set(found.nodes) == set(arguments):
                lane = {n.id: k for k, n in enumerate(found.nodes)}
                pairs = sorted(zip(arguments, group, strict=True), key=lambda p: lane[p[0].id])
                return tuple(node for _, node in pairs)
        common = set.intersection(*(set(n.args) for n in group))

        def own(node: Node) -> list[str]:
            below = reachable([a for a in node.args if a not in common])
            return sorted(str(n.payload) for n in below if n.op == "input")

        return tuple(sorted(group, key=own))

    def _expand(self, nodes: Lanes, most: int = MOST, least: int = LEAST) -> None:
        """Pack these nodes, if that is possible, and then their operands."""
        first = nodes[0]
        alike = all(
            n.op == first.op
            and n.payload == first.payload
            and len(n.args) == len(first.args)
            and self.heights[n.id] == self.heights[first.id]
            for n in nodes
        )
        if not (alike and least <= len(nodes) <= most and all(map(self._is_packable, nodes))):
            return
        rows = [self._aligned(first, n) for n in nodes]
        pack = Pack(nodes, tuple(zip(*rows, strict=True)))
        self.pack.update((n.id, pack) for n in nodes)
        for column in pack.columns:
            self._expand(tuple(dict.fromkeys(column)), MOST if first.op == "atan2" else most)

    def _aligned(self, first: Node, node: Node) -> Lanes:
        """The operands of a node in the order in which those of the first lane are."""

        def likeness(a: Node, b: Node) -> int:
            if a is b:
                return 3
            return (
                2
                if self.keys[a.id] == self.keys[b.id]
                else int(self.shape[a.id] == self.shape[b.id])
            )

        if node.op not in COMMUTATIVE:
            return node.args
        orders = (node.args, node.args[::-1])
        return max(orders, key=lambda o: sum(map(likeness, first.args, o)))

    def _scheduled(self) -> list[Block]:
        """The blocks of the program; packs that depend on each other are dissolved."""
        while True:
            blocks, stuck = self._attempt()
            if not stuck:
                return blocks
            least = min(stuck, key=lambda p: (len(p.nodes), p.nodes[0].id))
            for node in least.nodes:
                del self.pack[node.id]

    def _attempt(self) -> tuple[list[Block], list[Pack]]:
        blocks: list[Block] = []
        done = {n.id for n in self.nodes if n.op in LEAVES}
        packs = dict.fromkeys(
            self.pack.get(n.id) or Pack((n,), tuple((a,) for a in n.args))
            for n in self.nodes
            if n.op not in LEAVES
        )
        left = {width: [p for p in packs if p.width == width] for width in (1, 2, MOST, ANGLES)}
        while any(left.values()):
            ways = (self._ready(wide, done) for width, wide in left.items() if width > 1)
            ready = self._ready(left[1], done) or max(ways, key=len)
            if not ready:
                return [], [p for width, wide in left.items() if width > 1 for p in wide]
            width, kept = ready[0].width, set(ready)
            blocks.append(Block(width, tuple(ready)))
            done |= {n.id for p in ready for n in p.nodes}
            left[width] = [p for p in left[width] if p not in kept]
        return blocks, []

    def _ready(self, left: Sequence[Pack], done: set[int]) -> list[Pack]:
        """The packs, all of one width, that can be evaluated together after what is done."""
        found: list[Pack] = []
        here: set[int] = set()

        def known(column: tuple[int, ...]) -> bool:
            if done.issuperset(column):
                return True
            return here.issuperset(column) and (
                len(column) == 1 or column == self._lanes_of(self.pack[column[0]].nodes)
            )

        for pack in left:  # operands come before operators
            earlier = self.before.get(pack.nodes[0].id, ()) if pack.width == 1 else ()
            if all(map(known, pack.operands)) and all(c in done or c in here for c in earlier):
                found.append(pack)
                here.update(n.id for n in pack.nodes)
        return found

    @staticmethod
    def _lanes_of(nodes: Lanes) -> tuple[int, ...]:
        return tuple(n.id for n in nodes)


def _is_angle(node: Node) -> bool:
    """Whether a result is an arctangent, brought into range or not."""
    while node.op in ("neg", "wrap", "wrap_cut") or (
        node.op == "add" and node.args[1].op == "poison"
    ):
        node = node.args[0]
    return node.op == "atan2"


def _keys(program: Lowered, same: Mapping[str, str] = MappingProxyType({})) -> dict[int, int]:
    """A number for the structure of each node, where some operators count as the ``same``.

    Entries of one input array are alike, and so are all sines and all cosines.
    """
    array = {str(e): a.name for a in program.inputs for e in a.entries}
    numbers: dict[object, int] = {}
    keys: dict[int, int] = {}
    for node in program.schedule():
        below = [keys[a.id] for a in node.args]
        op = same.get(node.op, node.op)
        if op in COMMUTATIVE:
            below.sort()
        payload = node.payload
        if node.op == "input":
            payload = array.get(str(payload), payload)
        key = (op, payload, () if node.op in ("sin", "cos") else tuple(below))
        keys[node.id] = numbers.setdefault(key, len(numbers))
    return keys


def _by_legs(lowered: Lowered) -> tuple[Lowered, Mapping[int, int]]:
    """The program with the conditions of each leg joined first, and the new numbers of nodes.

    A condition on three legs is a chain of comparisons.  Those with the same structure are in the
    order of the legs; the chain of a leg takes one of each.
    """
    keys, uses = _keys(lowered), Counter(a.id for n in lowered.schedule() for a in n.args)
    graph = Graph()
    image: dict[int, Node] = {}

    def joined(node: Node) -> Node:
        combine = graph.every if node.op == "and" else graph.any
        groups = defaultdict(list)
        for condition in _chain(node, uses):
            groups[keys[condition.id]].append(image[condition.id])
        single = [c for group in groups.values() if len(group) < LEAST for c in group]
        legs: defaultdict[int, list[list[Node]]] = defaultdict(list)
        for group in groups.values():
            if len(group) >= LEAST:
                legs[len(group)].append(group)
        each = [combine(leg) for alike in legs.values() for leg in zip(*alike, strict=True)]
        return combine([*single, *each])

    for node in lowered.schedule():
        if node.op in ("and", "or"):
            image[node.id] = joined(node)
        else:
            below = (image[a.id] for a in node.args)
            image[node.id] = graph.node(node.op, *below, payload=node.payload)
    results = [replace(r, nodes=tuple(image[n.id] for n in r.nodes)) for r in lowered.results]
    program = replace(
        lowered,
        angles=tuple(image[n.id] for n in lowered.angles),
        turned=tuple(image[n.id] for n in lowered.turned),
        results=tuple(results),
        names={image[k].id: name for k, name in lowered.names.items() if k in image},
    )
    return program, {k: node.id for k, node in image.items()}


def _chain(node: Node, uses: Mapping[int, int]) -> Iterator[Node]:
    """The conditions that a chain of one operator joins, but not what is used elsewhere."""
    for arg in node.args:
        if arg.op == node.op and uses[arg.id] == 1:
            yield from _chain(arg, uses)
        else:
            yield arg


__all__ = ["Block", "Pack", "Packing"]
