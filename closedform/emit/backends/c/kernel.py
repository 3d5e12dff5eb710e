"""The C code of one lowered program: a kernel over scalars, and the functions around it.

The kernel has no trigonometry: the sines and cosines of its angles are arguments.  A single call
computes them as the lanes of a vector, a batch in blocks, and the compiler inlines the kernel.
"""

from __future__ import annotations

import itertools
import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import prod

from closedform.emit.backends.c.lanes import LanesPrinter, packed
from closedform.emit.backends.c.printer import CPrinter
from closedform.emit.text import WIDTH
from closedform.lower import Lowered
from closedform.lower.graph import Node
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.names import C_LOCALS

LANES = 8


@dataclass(frozen=True)
class CArray:
    """An argument or a result of a function."""

    name: str
    type: str
    kind: str
    ndim: int
    dims: str
    size: int
    const: str

    @property
    def single(self) -> str:
        return f"{self.const}{self.type} {self.name}[{self.size}]"

    @property
    def batch(self) -> str:
        return f"{self.const}{self.type} *{self.name}, size_t {self.name}_stride"

    def plane(self, k: int) -> str:
        """The offset of coordinate k of the posture ``start`` in the array."""
        offset = {0: "", 1: f"{self.name}_stride + "}.get(k, f"{k} * {self.name}_stride + ")
        return f"{offset}start"


@dataclass(frozen=True)
class CProgram:
    """The plain strings of one program: its kernel and the parts of the functions that call it."""

    full: str
    unused_single: tuple[str, ...]
    unused_batch: tuple[str, ...]
    outputs: tuple[CArray, ...]
    narrowed: tuple[CArray, ...]
    single: str
    batch: str
    kernel: str
    kernel_lines: tuple[str, ...]
    in_lanes: str
    lanes_lines: tuple[str, ...]
    kernel_call_single: str
    kernel_call_batch: str
    copies_params: bool
    needs_one: bool
    lanes: tuple[str, ...]
    steady_angles: tuple[str, ...]
    angle_blocks: tuple[str, ...]
    loads: tuple[str, ...]
    stores: tuple[str, ...]
    narrow: tuple[str, ...]


def c_array(name: str, shape: Sequence[int], kind: str, const: str = "") -> CArray:
    kinds = {"real": "CF_REAL", "status": "CF_STATUS", "bool": "CF_BOOL"}
    dims = "{ " + (", ".join(map(str, shape)) or "0") + " }"
    ctype = "real_t" if kind == "real" else "uint8_t"
    return CArray(
        name=name,
        type=ctype,
        kind=kinds[kind],
        ndim=len(shape),
        dims=dims,
        size=prod(shape),
        const=const,
    )


def folded(arguments: Sequence[str]) -> str:
    """An argument list, folded if a line with the name of the function would be too long."""
    whole = ", ".join(a.replace(" ", "\0") for a in arguments)  # no break within an argument
    lines = textwrap.wrap(whole, WIDTH - 44, break_long_words=False)
    return "\n    ".join(lines).replace("\0", " ") or "void"


def _declared(line: str) -> str:
    """The name that ``const real_t name = ...`` declares."""
    return line.split(" = ", 1)[0].rsplit(" ", 1)[1]


def _occurs(name: str, lines: Sequence[str]) -> bool:
    """Whether a variable occurs; a field of a structure is a different name."""
    return any(re.search(rf"(?<!->)\b{name}\b", line) for line in lines)


def _lanes(n: int) -> int:
    """The number of lanes for ``n`` numbers, padded to whole vectors: 2, 4 or a multiple of 8."""
    return 1 << (n - 1).bit_length() if n <= LANES else -(-n // LANES) * LANES


class Emission:
    """Collects the strings of one program."""

    def __init__(
        self,
        derivation: Derivation,
        function: Function,
        program: Lowered,
        full: str,
        *,
        branch: bool = False,
    ):
        self.derivation, self.function, self.program = derivation, function, program
        self.full = full
        self.inputs = tuple(c_array(a.name, a.shape, "real", "const ") for a in program.inputs)
        self.outputs = tuple(c_array(r.name, r.shape, r.kind) for r in program.results)
        self.places = {
            str(entry): (argument, k)
            for argument, a in zip(self.inputs, program.inputs, strict=True)
            for k, entry in enumerate(a.entries)
        }
        names = [a.name for a in (*self.inputs, *self.outputs)]
        own = {f"{derivation.name}_params", f"{derivation.name.upper()}_DEFAULTS"}
        reserved = {*C_LOCALS, *names, *own}
        self.printer = CPrinter(program, reserved, branch=branch)
        self.values = self.printer.run()
        read = program.used_inputs(below_angles=False)
        self.parameters = [p for p in program.parameters if p in read]
        self.raw = [
            argument
            for argument, a in zip(self.inputs, program.inputs, strict=True)
            if any(str(e) in read for e in a.entries)
        ]
        self.entries = [e for e in self.places if e in read]
        self.kernel_lines = self._kernel_lines()
        self.distinguishes_single = _occurs("single", self.kernel_lines)
        self.takes_one = _occurs("one", self.kernel_lines)
        self.deciding_angles = program.deciding_angles()
        arrays = ("sines", "cosines", "principals")
        self.trig = [name for name in arrays if _occurs(name, self.kernel_lines)]
        packing = None if branch else packed(program)
        self.lanes_lines = self._lanes_lines(LanesPrinter(packing, reserved)) if packing else []

    def emit(self) -> CProgram:
        arrays = (*self.inputs, *self.outputs)
        params = f"const {self.derivation.name}_params *params"
        narrowed = tuple(o for o in self.outputs if o.kind != "CF_REAL")
        shared = ["params"] * bool(self.parameters)
        single, trig = ["const int single"] * self.distinguishes_single, self.trig
        single += ["const real_t one"] * self.takes_one
        names = [o.name for o in self.outputs]
        taken = (
            [params] * bool(self.parameters)
            + [a.single for a in self.raw]
            + [f"const real_t *{name}" for name in trig]
            + [f"real_t {o.name}[{o.size}]" for o in self.outputs]
        )
        one = ["one"] * _occurs("one", self.lanes_lines)
        return CProgram(
            full=self.full,
            unused_single=tuple(
                name
                for name in ["params"] + [a.name for a in self.inputs]
                if not _occurs(name, [*shared, *(a.name for a in self.raw), *self._lanes()])
            ),
            unused_batch=tuple(
                name
                for name in ["params"]
                + [n for a in self.inputs for n in (a.name, f"{a.name}_stride")]
                + [f"{a.name}_stride" for a in self.outputs]
                if not _occurs(
                    name,
                    [
                        *shared,
                        *self._steady_angles(),
                        *self._angle_blocks(),
                        *self._loads(),
                        *self._stores(),
                        *self._narrow(),
                    ],
                )
            ),
            outputs=self.outputs,
            narrowed=narrowed,
            single=folded([params, *(a.single for a in arrays)]),
            batch=folded(["size_t n", params, *(a.batch for a in arrays)]),
            kernel=folded([*single, *taken]),
            kernel_lines=tuple(self.kernel_lines),
            in_lanes=folded([*(f"const real_t {name}" for name in one), *taken]),
            lanes_lines=tuple(self.lanes_lines),
            kernel_call_single=self.call(
                one if self.lanes_lines else self.leading("1"),
                "params",
                [a.name for a in self.raw],
                trig,
                [f"{o.name}_real" if o in narrowed else o.name for o in self.outputs],
            ),
            kernel_call_batch=self.call(
                self.leading("0"),
                "&local",
                [f"{name}_i" for name in (*(a.name for a in self.raw), *trig, *names)],
            ),
            copies_params=bool(self.parameters),
            needs_one=self.takes_one or bool(self.deciding_angles),
            lanes=tuple(self._lanes()),
            steady_angles=tuple(self._steady_angles()),
            angle_blocks=tuple(self._angle_blocks()),
            loads=tuple(self._loads()),
            stores=tuple(self._stores()),
            narrow=tuple(self._narrow()),
        )

    def leading(self, single: str) -> list[str]:
        return [single] * self.distinguishes_single + ["one"] * self.takes_one

    def call(self, leading: Sequence[str], params: str, *arrays: Sequence[str]) -> str:
        """The arguments of a call of the kernel; the parameters only if it takes them."""
        shared = [params] * bool(self.parameters)
        return ", ".join([*leading, *shared, *(name for names in arrays for name in names)])

    def _inputs_of(self, printer: CPrinter) -> list[str]:
        """The lines that read what the kernel gets, into the names of a printer."""
        lines = [f"const real_t {printer.inputs[p]} = params->{p};" for p in self.parameters]
        for entry in self.entries:
            argument, k = self.places[entry]
            lines.append(f"const real_t {printer.inputs[entry]} = {argument.name}[{k}];")
        program = printer.lowered
        needed = {(n.op, n.args[0].id) for n in program.schedule() if n.op in ("sin", "cos")}
        for k, (angle, sine, cosine) in enumerate(printer.trig):
            for op, name, array in (("sin", sine, "sines"), ("cos", cosine, "cosines")):
                if (op, angle.id) in needed:
                    lines.append(f"const real_t {name} = {array}[{k}];")
        for k, (_, name) in enumerate(printer.turned):
            lines.append(f"const real_t {name} = principals[{k}];")
        return lines

    def _outputs_of(self, values: Sequence[Sequence[str]]) -> Iterator[str]:
        for result, entries in zip(self.program.results, values, strict=True):
            for k, value in enumerate(entries):
                if result.kind == "bool":
                    value = f"({value}) ? CLOSEDFORM_C(1.0) : CLOSEDFORM_C(0.0)"
                yield f"{result.name}[{k}] = {value};"

    def _lanes_lines(self, printer: LanesPrinter) -> list[str]:
        """The kernel of one posture, if operations repeat; it reads only what it uses."""
        values = printer.run()
        lines = [*printer.code, *self._outputs_of(values)]
        read = (line for line in self._inputs_of(printer) if _occurs(_declared(line), lines))
        return [*read, *lines]

    def _kernel_lines(self) -> list[str]:
        lines = self._inputs_of(self.printer)
        for k, line in enumerate(self.printer.lines):
            if k == self.printer.head:
                lines += self._arctangents()
            ctype = "int" if line.boolean else "real_t"
            lines.append(f"const {ctype} {line.name} = {line.code};")
        if self.printer.head == len(self.printer.lines):
            lines += self._arctangents()
        return [*lines, *self._outputs_of(self.values)]

    def _arctangents(self) -> list[str]:
        """All arctangents together: one vector for a single posture, one by one in a batch."""
        pairs = self.printer.arctangents
        if not pairs:
            return []
        n = _lanes(len(pairs))
        one_by_one = [
            f"    angles[{k}] = cf_atan2(opposite[{k}], adjacent[{k}]);" for k in range(len(pairs))
        ]
        return [
            _filled("opposite", n, [y for y, _ in pairs]),
            _filled("adjacent", n, [x for _, x in pairs]),
            f"real_t angles[{n}];",
            "if (single) {",
            f"    cf_atan2_lanes({n}, opposite, adjacent, angles);",
            "} else {",
            *one_by_one,
            "}",
        ]

    def _angle(self, node: Node) -> tuple[str, CArray | None, int, int]:
        """The input of an angle, its index in an array and its divisor."""
        divisor = 1
        if node.op == "div":
            node, divisor = node.args[0], int(str(node.args[1].payload))
        name = str(node.payload)
        argument, k = self.places.get(name, (None, 0))
        return name, argument, k, divisor

    def _lanes(self) -> list[str]:
        """The sines, cosines and principal values of one posture."""
        angles, turned = self.program.angles, self.program.turned
        if not angles:
            n, listed = len(turned), ", ".join(map(self._place, turned))
            return [
                f"real_t principals[{n}];",
                f"const real_t wide[{n}] = {{ {listed} }};",
                f"cf_principal_block({n}, wide, principals);",
            ] * bool(turned)
        lanes = list(dict.fromkeys([*angles, *turned]))
        n = _lanes(len(lanes))
        rounded, one = ("_rounded", ", one") if self.deciding_angles else ("", "")
        taken = [_filled("lanes", n, [self._place(node) for node in lanes])]
        if not turned:
            return [
                f"real_t sines[{n}], cosines[{n}];",
                *taken,
                f"cf_sincos_lanes{rounded}({n}{one}, lanes, sines, cosines);",
            ]
        kept = ", ".join(f"turned[{lanes.index(node)}]" for node in turned)
        return [
            f"real_t sines[{n}], cosines[{n}], turned[{n}];",
            *taken,
            f"cf_turned_lanes{rounded}({n}{one}, lanes, sines, cosines, turned);",
            f"const real_t principals[{len(turned)}] = {{ {kept} }};",
        ]

    def _place(self, angle: Node) -> str:
        name, argument, k, divisor = self._angle(angle)
        text = f"{argument.name}[{k}]" if argument else f"params->{name}"
        return text if divisor == 1 else f"{text} / CLOSEDFORM_C({divisor}.0)"

    def _is_steady(self, angle: Node) -> bool:
        """Whether all postures of a batch have this angle, which comes from a parameter."""
        return self._angle(angle)[1] is None

    def _steady_angles(self) -> list[str]:
        """The sines and cosines that all postures of a batch share."""
        steady = [node for node in self.program.angles if self._is_steady(node)]
        if not steady:
            return []
        n = len(steady)
        deciding = any(node.id in self.deciding_angles for node in steady)
        rounded, one = ("_rounded", ", one") if deciding else ("", "")
        listed = ", ".join(map(self._place, steady))
        return [
            f"real_t steady_sines[{n}], steady_cosines[{n}];",
            f"const real_t steady[{n}] = {{ {listed} }};",
            f"cf_sincos_block{rounded}({n}{one}, steady, steady_sines, steady_cosines);",
        ]

    def _angle_blocks(self) -> list[str]:
        """The sines, cosines and principal values of a block of postures."""
        lines = []
        moving = [node for node in self.program.angles if not self._is_steady(node)]
        if moving:
            size = f"[{len(moving)}][CLOSEDFORM_BLOCK]"
            lines.append(f"real_t sines{size}, cosines{size};")
        for j, node in enumerate(moving):
            source, more = self._plane(node, f"angle_{j}")
            rounded, one = ("_rounded", ", one") if node.id in self.deciding_angles else ("", "")
            block = f"cf_sincos_block{rounded}(length{one}, {source}, sines[{j}], cosines[{j}]);"
            lines += [*more, block]
        if self.program.turned:
            lines.append(f"real_t principals[{len(self.program.turned)}][CLOSEDFORM_BLOCK];")
        for j, node in enumerate(self.program.turned):
            source, more = self._plane(node, f"wide_{j}")
            lines += [*more, f"cf_principal_block(length, {source}, principals[{j}]);"]
        return lines

    def _plane(self, angle: Node, name: str) -> tuple[str, list[str]]:
        """The array with the values of an angle for a block, and the lines that fill it."""
        symbol, argument, k, divisor = self._angle(angle)
        if argument and divisor == 1:
            return f"{argument.name} + {argument.plane(k)}", []
        place = f"{argument.name}[{argument.plane(k)} + i]" if argument else f"params->{symbol}"
        part = "" if divisor == 1 else f" / CLOSEDFORM_C({divisor}.0)"
        return name, [
            f"real_t {name}[CLOSEDFORM_BLOCK];",
            "for (size_t i = 0; i < length; ++i)",
            f"    {name}[i] = {place}{part};",
        ]

    def _shares(self, array: str) -> Iterator[str]:
        """What one posture takes from the blocks, and from what all of them share."""
        if array == "principals":
            yield from (f"principals[{k}][i]" for k in range(len(self.program.turned)))
            return
        moving, steady = itertools.count(), itertools.count()
        for node in self.program.angles:
            if self._is_steady(node):
                yield f"steady_{array}[{next(steady)}]"
            else:
                yield f"{array}[{next(moving)}][i]"

    def _stores(self) -> list[str]:
        return [
            f"{o.name}[{o.plane(k)} + i] = {o.name}_i[{k}];"
            if o.kind == "CF_REAL"
            else f"{o.name}_real[{k}][i] = {o.name}_i[{k}];"
            for o in self.outputs
            for k in range(o.size)
        ]

    def _narrow(self) -> list[str]:
        return [
            f"{o.name}[{o.plane(k)} + i] = ({o.type}){o.name}_real[{k}][i];"
            for o in self.outputs
            if o.kind != "CF_REAL"
            for k in range(o.size)
        ]

    def _loads(self) -> list[str]:
        lines = list(_loads(self.raw))
        for array in self.trig:
            listed = ", ".join(self._shares(array))
            n = len(self.program.turned if array == "principals" else self.program.angles)
            lines.append(f"const real_t {array}_i[{n}] = {{ {listed} }};")
        lines += [f"real_t {o.name}_i[{o.size}];" for o in self.outputs]
        return lines


def _filled(name: str, n: int, values: Sequence[str]) -> str:
    """An array for a vector operation; compilers make vectors of zeros in memory, which waits."""
    lanes = [*values, *[values[-1]] * (n - len(values))]
    return f"const real_t {name}[{n}] = {{ {', '.join(lanes)} }};"


def _loads(arrays: Iterable[CArray]) -> Iterator[str]:
    """The coordinates of posture ``start + i``."""
    for a in arrays:
        listed = ", ".join(f"{a.name}[{a.plane(k)} + i]" for k in range(a.size))
        yield f"const real_t {a.name}_i[{a.size}] = {{ {listed} }};"
