"""The C code of one posture, with operations that repeat as the lanes of vectors.

A loop over lanes is what a compiler makes vectors of.  It has no jumps: a value that is hardly ever
selected is computed anyway.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

from closedform.emit.backends.c.guards import final_values
from closedform.emit.backends.c.packs import Block, Lanes, Pack, Packing
from closedform.emit.backends.c.printer import CPrinter
from closedform.emit.code import ATOM, COMPARE, LONGEST, PRODUCT, Text
from closedform.lower import Lowered
from closedform.lower.graph import Node
from closedform.lower.operators import BOOLEAN, LEAVES, OPERATORS

WORTH = 0.3
"""The fraction of the operations that packs have to spare."""
ENOUGH = 64
"""The operations that they have to spare at least, or filling the lanes takes longer."""


def packed(lowered: Lowered) -> Packing | None:
    """The packs of a program, if they are worth the trouble."""
    infinite = final_values(lowered)
    alone = frozenset(n.id for n in lowered.schedule() if n.op == "div" and n.id in infinite)
    packing = Packing(lowered, alone)
    return packing if packing.spared > max(ENOUGH, WORTH * lowered.length) else None


class LanesPrinter(CPrinter):
    """Prints the blocks of a program one after another; ``code`` has their lines.

    Inside a loop the operands of a node are those of its pack, so a method gets the node of the
    first lane and the texts of the lanes.
    """

    single = "1"

    def __init__(self, packing: Packing, reserved: Iterable[str] = ()):
        super().__init__(packing.program, reserved)
        self.packing = packing
        self.code: list[str] = []
        self._packed = {n.id for p in packing.packs for c in p.columns for n in c}
        self._users: Counter[int] = Counter(a.id for n in packing.nodes for a in n.args)
        self._users.update(n.id for n in packing.program.roots)
        # all lanes are rounded if one is
        self._deciding |= {
            p.nodes[0].id for p in packing.packs if any(n.id in self._deciding for n in p.nodes)
        }
        self._in_loop = False
        self._arrays: dict[Lanes, str] = {}
        self._gathered: dict[Lanes, str] = {}
        self._local: dict[Lanes, Text] = {}

    def run(self) -> list[list[str]]:
        for block in self.packing.blocks:
            if block.width == 1:
                for pack in block.packs:
                    self._alone(pack.nodes[0])
            else:
                self._loop(block)
        return [[self._outside(n).code for n in r.nodes] for r in self.lowered.results]

    def _outside(self, node: Node) -> Text:
        """The code of a node outside of loops."""
        if node.id not in self.text:
            assert node.op in LEAVES
            for arg in node.args:
                self._outside(arg)
            self.text[node.id] = self.render(node)
        return self.text[node.id]

    def _alone(self, node: Node) -> None:
        for arg in node.args:
            self._outside(arg)
        text = self.render(node)
        while self.lines:  # what a quotient has named
            line = self.lines.pop(0)
            self.code.append(f"const real_t {line.name} = {line.code};")
        if self.deserves_name(node, text, self._users[node.id]) or node.id in self._packed:
            text = self._named(node, text, "")
        self.text[node.id] = text

    def _named(self, node: Node, text: Text, indent: str, name: str = "") -> Text:
        if text.precedence == ATOM and text.code.isidentifier():
            return text
        wanted = self.lowered.names.get(node.id)
        name = name or (self.names.take(wanted) if wanted else self.names.fresh())
        kind = "int" if node.op in BOOLEAN else "real_t"
        self.code.append(f"{indent}const {kind} {name} = {text.code};")
        return Text(name)

    def _loop(self, block: Block) -> None:
        here = {n.id for p in block.packs for n in p.nodes}
        inside = self._uses_inside(here)
        kept = [p for p in block.packs if self._leaves(p, inside)]
        for pack in kept:
            self._arrays[pack.nodes] = self._array_of(pack)
        for boolean, kind in ((False, "real_t"), (True, "cf_word")):
            names = [
                f"{self._arrays[p.nodes]}[{block.width}]"
                for p in kept
                if (p.nodes[0].op in BOOLEAN) == boolean
            ]
            if names:
                self.code.append(f"{kind} {', '.join(names)};")
        for pack in block.packs:
            for column in pack.columns:
                self._gather(column, block.width, here)
        self.code.append(f"for (size_t k = 0; k < {block.width}; ++k) {{")
        self._in_loop, self._local = True, {}
        uses = Counter(c for p in block.packs for c in p.columns)
        for pack in block.packs:
            self._lane(pack, uses[pack.nodes], pack in kept)
        self._in_loop = False
        self.code.append("}")
        for pack in kept:
            name, boolean = self._arrays[pack.nodes], pack.nodes[0].op in BOOLEAN
            for k, node in enumerate(pack.nodes):
                self.text[node.id] = self._entry(name, str(k), boolean)

    def _uses_inside(self, here: set[int]) -> Counter[int]:
        """How often the packs of a loop use each node."""
        packs = {self.packing.pack[k] for k in here}
        return Counter(n.id for p in packs for column in p.columns for n in column)

    def _leaves(self, pack: Pack, inside: Counter[int]) -> bool:
        """Whether something outside of the loop uses the pack."""
        return any(self._users[n.id] > inside[n.id] for n in pack.nodes)

    def _array_of(self, pack: Pack) -> str:
        wanted = self.lowered.names.get(pack.nodes[0].id)
        return self.names.take(f"{wanted}_lanes") if wanted else f"{self.names.fresh()}_lanes"

    @staticmethod
    def _entry(name: str, k: str, boolean: bool) -> Text:
        return Text(f"{name}[{k}] != 0", COMPARE) if boolean else Text(f"{name}[{k}]")

    def _lane(self, pack: Pack, uses: int, kept: bool) -> None:
        node = pack.nodes[0]
        method: Callable[..., Text] = getattr(self, OPERATORS[node.op].method)
        text = method(node, *map(self._operand, pack.columns))
        boolean = node.op in BOOLEAN
        if uses > 1 or len(text.code) > LONGEST or (kept and uses) or boolean:
            text = self._named(node, text, "    ")
        if kept:
            value = f"(cf_word){text.at(PRODUCT)}" if boolean else text.code
            self.code.append(f"    {self._arrays[pack.nodes]}[k] = {value};")
        self._local[pack.nodes] = text

    def _operand(self, column: Lanes) -> Text:
        """The code of an operand inside a loop."""
        if column in self._local:
            return self._local[column]
        if len(set(column)) == 1:
            return self._outside(column[0])
        boolean = column[0].op in BOOLEAN
        place = self._in_order(column)
        if place is not None:
            return Text(place)
        return self._entry(self._arrays.get(column) or self._gathered[column], "k", boolean)

    def _in_order(self, column: Lanes) -> str | None:
        """The array of sines or cosines that has this operand at consecutive places."""
        arrays = {"sin": "sines", "cos": "cosines"}
        name = arrays.get(column[0].op)
        if name is None or any(n.op != column[0].op for n in column):
            return None
        places = [self.lowered.angles.index(n.args[0]) for n in column]
        first, width = places[0], 1 << (len(column) - 1).bit_length()
        if places != list(range(first, first + len(column))):
            return None
        if first + width > 1 << (len(self.lowered.angles) - 1).bit_length():
            return None
        return f"{name}[{first} + k]" if first else f"{name}[k]"

    def _gather(self, column: Lanes, width: int, here: set[int]) -> None:
        """Bring an operand into the order of the lanes."""
        if len(set(column)) == 1 or self._in_order(column) or column in self._gathered:
            return
        if column in self._arrays or column[0].id in here:
            return
        name = self.names.fresh()
        self._gathered[column] = name
        texts = [self._outside(n) for n in column]
        texts += [texts[-1]] * (width - len(texts))
        if column[0].op in BOOLEAN:
            values = ", ".join(f"(cf_word){t.at(ATOM)}" for t in texts)
            self.code.append(f"const cf_word {name}[{width}] = {{ {values} }};")
            return
        values = ", ".join(t.code for t in texts)
        self.code += [
            f"const real_t {name}_of[{width}] = {{ {values} }};",
            f"real_t {name}[{width}];",
            f"cf_side_by_side({width}, {name}_of, {name});",
        ]

    # Inside a loop nothing jumps

    def mul(self, node: Node, a: Text, b: Text) -> Text:
        if not self._in_loop:
            return super().mul(node, a, b)
        product = f"{a.at(PRODUCT)} * {b.at(PRODUCT + 1)}"
        return Text(f"{product} * one" if node.id in self._deciding else product, PRODUCT)

    def div(self, node: Node, a: Text, b: Text) -> Text:
        if not self._in_loop or node.args[1].op == "const":
            return super().div(node, a, b)
        divisor = f"cf_select({b.at(COMPARE + 1)} == 0, CLOSEDFORM_NAN, {b.code})"
        return Text(f"{a.at(PRODUCT)} / {divisor}", PRODUCT)

    def select(self, node: Node, condition: Text, a: Text, b: Text) -> Text:
        if self._in_loop:
            return Text(f"cf_select({condition.code}, {a.code}, {b.code})")
        return super().select(node, condition, a, b)

    def poison(self, node: Node, failed: Text) -> Text:
        """A selection also outside of loops: a jump would divide the vectors around it."""
        return Text(f"cf_poison(0, {failed.code})")

    def status(self, node: Node, invalid: Text, unreachable: Text, singular: Text) -> Text:
        single = 0 if self._in_loop else 1
        return Text(f"cf_status({single}, {invalid.code}, {unreachable.code}, {singular.code})")

    def _quotient(self, node: Node, dividend: Text, divisor: Text) -> Text:
        unused = self._unused_where.pop(node.id, ())
        if known := tuple(n for n in unused if n.id in self.text):
            self._unused_where[node.id] = known
        return super()._quotient(node, dividend, divisor)

    def _together(self, node: Node) -> bool:
        return False


__all__ = ["LanesPrinter", "packed"]
