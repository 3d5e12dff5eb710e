"""A lowered Function: inputs, the sines and cosines it needs, and a list of named values."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import cycle, islice

import sympy as sp

from closedform.lower.branch import Branch, UnboundedAngleError, expressions_of, is_guarded
from closedform.lower.build import Builder, angle_divisors
from closedform.lower.common import Earlier, common_case
from closedform.lower.degrees import NUMBERS, Degrees, degrees
from closedform.lower.edge import within_edge
from closedform.lower.graph import Graph, Node, inverse_power_of_two, reachable
from closedform.lower.operators import COUNTED, LEAVES
from closedform.lower.ranges import Ranges
from closedform.lower.roots import fewer_roots
from closedform.lower.share import share
from closedform.lower.turns import Turns
from closedform.model.cached import cached
from closedform.model.derivation import Derivation
from closedform.model.functions import (
    Array,
    Function,
)
from closedform.model.tolerances import HIGHEST_DEGREE

SAVING_OF_COMMON_CASE = 0.15
"""The fraction of the operations that a common case must save to get a separate program."""
SAVING_IN_MAPS = 0.13
"""The same in forward maps and inverses, which are called most."""
LENGTH_OF_BRANCH = 0.6
"""The largest fraction of the operations of all branches for which one branch gets a program."""


@dataclass(frozen=True)
class Result:
    """An output array with its leading branch axis, entry by entry."""

    name: str
    shape: tuple[int, ...]
    kind: str
    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class Lowered:
    """A straight-line program.

    ``angles`` are the nodes whose sine and cosine are computed, ``turned`` those that are reduced
    by whole turns, both in the order of first use; they depend only on the inputs.  ``names`` gives
    preferred names (from the derivation) to nodes.  ``common`` is the program for the case that
    nothing vanishes, if it is much shorter; its last result, ``rare``, says whether something
    does.  ``branch`` is one branch of that program, if it is short enough to be called several
    times; its last input is the signs of the branch.  ``degrees`` says how values scale with the
    size of the mechanism, if they scale with a power of it.
    """

    name: str
    inputs: tuple[Array, ...]
    parameters: tuple[str, ...]
    angles: tuple[Node, ...]
    turned: tuple[Node, ...]
    results: tuple[Result, ...]
    names: Mapping[int, str]
    common: Lowered | None = None
    branch: Lowered | None = None
    degrees: Degrees | None = None

    @property
    def roots(self) -> list[Node]:
        return [n for r in self.results for n in r.nodes]

    def schedule(self) -> tuple[Node, ...]:
        """All nodes of the body, operands before operators."""
        return self._schedule

    @cached_property
    def _schedule(self) -> tuple[Node, ...]:
        return tuple(reachable(self.roots))

    def used_inputs(self, *, below_angles: bool = True) -> frozenset[str]:
        """The inputs and parameters that are read; without ``below_angles``, only by the body."""
        nodes = self.schedule() if below_angles else reachable(self.roots, LEAVES)
        return frozenset(str(n.payload) for n in nodes if n.op == "input")

    def deciding(self) -> list[Node]:
        """All nodes that a status or a condition depends on, operands before operators."""
        deciding = [n for n in self.schedule() if n.op == "status"]
        deciding += [n for result in self.results if result.kind == "bool" for n in result.nodes]
        return list(reachable(deciding))

    def deciding_angles(self) -> frozenset[int]:
        """The angles whose sine or cosine determines a status or a condition."""
        return frozenset(n.args[0].id for n in self.deciding() if n.op in ("sin", "cos"))

    def operations(self) -> dict[str, int]:
        """The number of operators of each kind but of constants; a sincos counts once.

        A quotient by a power of two is printed as a product, and counts as one.
        """
        counts: Counter[str] = Counter()
        for node in self.schedule():
            if node.op in COUNTED and {a.op for a in node.args} - {"const", "tolerance"}:
                halved = node.op == "div" and inverse_power_of_two(node.args[1]) is not None
                counts["mul" if halved else node.op] += 1
        counts["sincos"], counts["principal"] = len(self.angles), len(self.turned)
        return {k: counts[k] for k in sorted(counts) if counts[k]}

    @property
    def is_scaled(self) -> bool:
        """Whether powers of the size of the mechanism may leave the range of a type."""
        return self.degrees is not None and 1 < self.degrees.highest <= HIGHEST_DEGREE

    @property
    def length(self) -> int:
        """The total number of operators, with those of constants."""
        counted = sum(node.op in COUNTED for node in self.schedule())
        return counted + len(self.angles) + len(self.turned)


def lower(function: Function, derivation: Derivation) -> Lowered:
    """Lower one function of a derivation."""
    function = within_edge(function, derivation)
    entries = Turns.of(function, derivation).entries()
    whole = _whole(function, derivation, entries, list(function.cases()))
    if whole.common is not None and function.branches:
        branch = _one_branch(function, derivation, entries, unscaled=whole.degrees is None)
        short = branch is not None and branch.length < LENGTH_OF_BRANCH * whole.common.length
        whole = replace(whole, branch=branch if short else None)
    return whole


lowered = cached(lower)


def results_of(function: Function) -> list[Result]:
    """The output arrays of a function, without their entries; the last is the status, if any."""
    lead = (len(list(function.cases())),) if function.branches else ()
    kind = "bool" if function.boolean else "real"
    found = [Result(a.name, (*lead, *a.shape), kind, ()) for a in function.outputs]
    return [*found, Result("status", lead, "status", ())] if function.has_status else found


def lower_branch(function: Function, derivation: Derivation, branch: int) -> Lowered:
    """Lower one branch of a function alone."""
    function = within_edge(function, derivation)
    entries = Turns.of(function, derivation).entries()
    case = list(function.cases())[branch]
    alone = replace(function, branches=None)
    return _whole(alone, derivation, entries, [case])


def _whole(
    function: Function,
    derivation: Derivation,
    entries: Sequence[tuple[sp.Expr, bool]],
    cases: Sequence[tuple[str, Mapping[sp.Symbol, int]]],
) -> Lowered:
    """The program, which says where a length overflows if it cannot be scaled."""
    for unscaled in (False, True):
        programs = _lower(function, derivation, entries, cases, unscaled=unscaled)
        saving = SAVING_IN_MAPS if function.has_status else SAVING_OF_COMMON_CASE
        whole = _with_degrees(_with_common(*programs, saving), function, derivation)
        if whole.degrees is not None or not function.has_status:
            break
    return whole


def _with_common(whole: Lowered, common: Lowered, saving: float) -> Lowered:
    """The whole program with its common case, if that saves this fraction of it."""
    if common.length > (1 - saving) * whole.length:
        return whole
    return replace(whole, common=replace(common, parameters=whole.parameters))


def _with_degrees(program: Lowered, function: Function, derivation: Derivation) -> Lowered:
    """The program with its degrees; the highest one includes the common case."""
    known = {j.name: int(j.kind == "prismatic") for j in derivation.joints}
    known |= {p.name: 0 for p in derivation.parameters if p.unit in NUMBERS}
    preferred = [p.name for p in derivation.parameters if p.name not in known]
    results = [r.nodes for p in (program, program.common) if p for r in p.results]
    slides = {j.symbol for j in derivation.joints if j.kind == "prismatic"}
    unknowns = [i.unknowns for i in derivation.inverses if i.function == function.name]
    answers = zip(program.results[0].nodes, cycle(*unknowns), strict=False) if unknowns else ()
    found = degrees(results, known, preferred, [n for n, joint in answers if joint in slides])
    if found:
        found = replace(found, results=found.results[: len(program.results)])
    return replace(program, degrees=found)


def _one_branch(
    function: Function,
    derivation: Derivation,
    entries: Sequence[tuple[sp.Expr, bool]],
    *,
    unscaled: bool,
) -> Lowered | None:
    """The common case of one branch, with the signs of the branch as inputs."""
    assert function.branches
    signs = list(function.branches.signs[0])
    one = replace(
        function,
        branches=None,
        inputs=(*function.inputs, Array("signs", (len(signs),), tuple(signs))),
    )
    try:
        return _lower(one, derivation, entries, [("", {})], signs, unscaled=unscaled)[1]
    except UnboundedAngleError:  # a sign occurs in an angle, but not as a factor
        return None


def _lower(
    function: Function,
    derivation: Derivation,
    entries: Sequence[tuple[sp.Expr, bool]],
    cases: Sequence[tuple[str, Mapping[sp.Symbol, int]]],
    signs: Sequence[sp.Symbol] = (),
    *,
    unscaled: bool,
) -> tuple[Lowered, Lowered]:
    """The whole program and its common case; ``signs`` are inputs with the values 1 or -1."""
    graph = Graph()
    parameters = [p.symbol for p in derivation.parameters]
    leaves = {s: graph.input(s.name) for s in (*function.symbols, *parameters)}
    divisors = angle_divisors([*expressions_of(function), *(e for e, _ in entries)])
    names: dict[int, str] = {}
    before: Earlier = defaultdict(set)
    rows = []
    ranges = _ranges(function, derivation, signs)
    for label, chosen in cases:
        build = Builder(graph, leaves, divisors)
        branch = Branch(function, derivation, build, names, label, signs, ranges, unscaled=unscaled)
        rows.append(branch.lowered(chosen, entries))
        for flag, conditions in branch.before.items():
            before[flag].add(conditions)
    nodes = [tuple(n for row in rows for n in row[0][k]) for k in range(len(function.outputs))]
    nodes.append(tuple(row[1] for row in rows))
    results = [replace(r, nodes=n) for r, n in zip(results_of(function), nodes, strict=False)]

    finish = partial(_finished, function, [p.name for p in parameters], graph, ranges)
    whole = finish(results=results, names=names)
    images, rare, kept = common_case(graph, [n for r in results for n in r.nodes], names, before)
    flat = iter(images)
    plain = [replace(r, nodes=tuple(islice(flat, len(r.nodes)))) for r in results]
    plain.append(Result("rare", (), "bool", (rare,)))
    return whole, finish(results=plain, names=kept)


def _finished(
    function: Function,
    parameters: Sequence[str],
    graph: Graph,
    ranges: Ranges,
    *,
    results: Sequence[Result],
    names: Mapping[int, str],
) -> Lowered:
    """The program of these results, with common parts shared."""
    flat = [n for r in results for n in r.nodes]
    # Reciprocals cost an ulp.  An inverse is judged by the image of its answers and can afford
    # them; a forward map is judged by the last digit of its values.
    renamed, named = _share_named(graph, ranges, flat, names, by_reciprocals=function.has_status)
    remaining = iter(renamed)
    used = {str(n.payload) for n in reachable(renamed) if n.op == "input"}
    return Lowered(
        name=function.name,
        inputs=function.inputs,
        parameters=tuple(name for name in parameters if name in used),
        angles=tuple(
            dict.fromkeys(n.args[0] for n in reachable(renamed) if n.op in ("sin", "cos"))
        ),
        turned=tuple(dict.fromkeys(n.args[0] for n in reachable(renamed) if n.op == "principal")),
        results=tuple(replace(r, nodes=tuple(islice(remaining, len(r.nodes)))) for r in results),
        names=named,
    )


def _share_named(
    graph: Graph,
    ranges: Ranges,
    roots: Sequence[Node],
    names: Mapping[int, str],
    *,
    by_reciprocals: bool,
) -> tuple[list[Node], dict[int, str]]:
    """Save roots and share common parts; names of the derivation stay with their nodes."""
    live = [n for n in reachable(roots) if n.id in names]
    spared = fewer_roots(graph, roots, live, ranges)
    body, images = spared[: len(roots)], dict(zip(spared[len(roots) :], live, strict=True))
    named = [n for n in reachable(body) if n in images]
    shared = share(graph, [*body, *named], by_reciprocals=by_reciprocals)
    body = shared[: len(roots)]
    alive = {n.id for n in reachable(body)}
    found = zip(shared[len(roots) :], named, strict=True)
    return body, {new.id: names[images[old].id] for new, old in found if new.id in alive}


def _ranges(function: Function, derivation: Derivation, signs: Sequence[sp.Symbol]) -> Ranges:
    """The ranges of the values; lengths count as nonnegative if negative ones are reported."""
    marked = is_guarded(function)
    lengths = [p.name for p in derivation.parameters if marked and p.nonnegative]
    return Ranges(lengths, [s.name for s in signs])
