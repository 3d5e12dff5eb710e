"""All that follows from the bodies of a planar linkage with slides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import sympy as sp

from closedform.lemmas.legs import cross_in_plane
from closedform.lemmas.missed import MOVED, SHARE
from closedform.loops.conditioning import JACOBIAN, conditioning
from closedform.loops.hand import in_space, square
from closedform.loops.leg_by_leg import SIGN, Choice, record_lemma
from closedform.loops.linkage import GROUND, Body
from closedform.loops.modes import NO_MODE, Exported, export
from closedform.loops.parallel import NEAR
from closedform.loops.sliding import Sliding, SlidingLinkage
from closedform.loops.sliding_inverse import inverse
from closedform.loops.sliding_solver import Block, Solver
from closedform.mechanics.assur_slides import Fold, Group, Meet, OnCircle, Swing
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, Branches, Program, branches
from closedform.model.inverse import Inverse
from closedform.model.step import Step

STILL = "hand stands still"


def sliding_linkage(
    d: Derivation,
    hand: Sequence[sp.Symbol],
    bodies: Mapping[str, Body],
    slides: Sequence[Sliding],
    at: str = "",
    *,
    modes: Choice = SIGN,
) -> None:
    """Derive and export a planar linkage in which bodies slide on each other.

    Parameters
    ----------
    d
        the derivation, with its parameters and one or two joints
    hand
        the symbols of the task: the two coordinates of a point, or the joint of a body
    bodies
        all bodies, one of which is called ``ground``; see :class:`~closedform.loops.linkage.Body`
    slides
        the pairs of bodies that slide on each other
    at
        the point that is the hand, if it is a point
    modes
        the names of the assembly modes of a group, by the sign of its determinant
    """
    m = SlidingLinkage(d, sp.Matrix(hand), bodies, slides, at)
    loop = _state(m)
    solved, assembly = _forward(m, modes, loop)
    poles = [b for b in solved.blocks if b.name and not b.matrix.det().expand().is_number]
    d.poles = tuple(b.name for b in poles)
    d.singularities = (*[STILL] * (len(m.hand) == len(d.actuated)), *d.poles)
    _draw(m, solved, assembly)
    _velocity(m, solved, assembly, loop)
    inverse(m, loop, poles)


def _state(m: SlidingLinkage) -> Step:
    rows: list[tuple[str, str, str]] = [("Group", "Bodies", "How")]
    for k, group in enumerate(m.groups, 1):
        rows.append((f"{k}", " and ".join(group.bodies), _how(m, group)))
    return m.d.step(
        "The linkage",
        "Bodies that slide on each other are not turned to each other.  The bodies are found group "
        "by group.  A pin that two bodies hold is on a circle about a known point of each, or on a "
        "line if the body slides on a known one.  Two bodies that slide on each other and are each "
        "pinned to a known point have the direction in which these points are at the distance that "
        "is across the slide.",
        {},
        rows=rows,
    )


def _how(m: SlidingLinkage, group: Group) -> str:
    if isinstance(group, Meet):
        said = [
            f"{h.body} turns about {h.near}"
            if isinstance(h, OnCircle)
            else f"{h.body} slides on {m.slides[h.slide].other(h.body)}"
            for h in group.holds
        ]
        return f"{' and '.join(said)}, and {group.pin} is on both"
    if isinstance(group, Fold) and not group.far:
        return f"it slides on {group.on} by its joint: both are one body from here on"
    if isinstance(group, Fold):
        first, second = group.bodies
        joined = f"slides on {group.on}" if group.slide is not None else f"turns about {group.pin}"
        return (
            f"{first} {joined} and {second} about {group.near} of {group.on}, and {group.far} is "
            f"on both: the three bodies are one from here on"
        )
    if isinstance(group, Swing):
        return f"they slide on each other, and turn about {' and '.join(group.near)}"
    return f"it is at {m.points[group.body][0]}, and is not turned to another body"


def share_of(m: SlidingLinkage) -> sp.Rational:
    """By what share of the size a hand may miss; the size of the inverse counts no joints."""
    return MOVED if m.moving else SHARE


def _forward(m: SlidingLinkage, choice: Choice, loop: Step) -> tuple[Solver, Branches]:
    d, f = m.d, m.d.program()
    sized = [q if q in m.cylinders.values() else sp.Abs(q) for q in m.moving]
    size = f.let("size", m.size + sp.Add(*sized))
    solved = Solver(m, f, size, share_of(m), tuple(m.hand))
    solved.start([GROUND, *m.driven])
    for k, group in enumerate(m.groups, 1):
        solved.solve(group, k)
    if m.follower in m.turning:
        outputs = [solved.angle(m.follower, m.hand[0], m.hand)]
    elif m.follower:
        places = (solved.slid(m.follower, w) for w in (solved.here, solved.meant))
        outputs = [solved.linear(m.hand[0], *places)]
    elif m.direct:
        lemma = solved.links[-1].lemma
        assert lemma is not None
        outputs = [lemma[x] for x in m.hand]
    else:
        both = zip(solved.here.at[m.hand_at], solved.meant.at[m.hand_at], strict=True)
        outputs = [solved.linear(x, *e) for x, e in zip(m.hand, both, strict=True)]
    modes = branches(*((sigma, choice) for sigma in solved.signs)) if solved.signs else SINGLE
    d.assembly_modes = modes.labels
    two = bool(solved.signs)
    d.step(
        "Forward: group by group",
        "The groups are solved in the order of the table.  "
        + "Two circles, and a line and a circle, meet twice, and two directions have the given "
        "distance, which gives two assembly modes for such a group.  "
        * two
        + "Two lines meet once.  The last body gives the task.",
        {},
        uses=[loop],
    )
    d.function(
        "fk",
        f"{m.hand[0] if m.follower else 'Position of the hand'} in all assembly modes.",
        {"q": d.actuated},
        {"p": outputs},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the bodies of a group do not meet.",
            "SINGULAR: a group is free to move, as where its pivots coincide; one posture is used.",
            NEAR,
        ),
    )
    equations = tuple(e for b in solved.blocks for e in b.equations)
    inner = tuple(x for b in solved.blocks for x in b.unknowns if x not in {*m.hand})
    d.inverses.append(
        Inverse(
            "fk",
            tuple(m.hand),
            (sp.S.Zero,) * len(equations),
            equations,
            links=tuple(solved.links),
            passive=inner,
        )
    )
    for link in solved.links:
        record_lemma(d, "fk", link)
    return solved, modes


def _draw(m: SlidingLinkage, at: Solver, modes: Branches) -> None:
    here, meant = dict(at.here.at), dict(at.meant.at)
    still = {p: m.local(GROUND, p) for p in m.points[GROUND]}
    links: dict[str, tuple[str, ...]] = {}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    closing: dict[tuple[str, str], sp.Expr] = {}
    for body, points in m.points.items():
        line = (*points, points[0]) if len(points) > 2 else points
        if len(points) > 1 and body not in m.cylinders:
            links[body] = line
        for a, b in pairwise(line):
            if {a, b} <= {*still} and body != GROUND:
                continue
            lengths[a, b] = m.length(body, a, b)
            off = at.meant.frames[body].still
            if off != 0:
                closing[a, b] = lengths[a, b] ** 2 * off
    joints = _passive(m)
    _draw_feet(m, at, _Drawing(here, meant, links, lengths=lengths, closing=closing, joints=joints))
    for body, q in m.driven.items():
        if body in m.turning:
            joints[q] = (m.pivot(body),)
            continue
        slide, point = m.slide_of(body), m.points[body][0]
        zero = m.local(body, point) + sp.Matrix(slide.offset)
        start = next((p for p, place in still.items() if place == zero), "")
        if not start:
            start = f"{point}_zero"
            here[start] = meant[start] = still[start] = zero
        joints[q] = (start, point)
        lengths[start, point] = q
    joints |= {q: m.points[body] for body, q in m.cylinders.items()}
    drawn = {p for line in (*links.values(), *joints.values()) for p in line}
    of_hand = [p for p in m.points[m.follower] if p in drawn] if m.follower else []
    hand = m.hand_at or next((p for p in of_hand if p not in still), [*of_hand, *drawn][0])
    drawn.add(hand)
    skeleton(
        m.d,
        {name: in_space(place) for name, place in here.items() if name in drawn},
        links=links,
        joints=joints,
        hand=hand,
        hand_at=in_space(meant[hand]),
        ground=[p for p in still if p in drawn],
        lengths=lengths,
        program=at.program,
        branches=modes,
        notes=(NO_MODE,) * bool(at.signs),
        at_posture=[{name: in_space(place) for name, place in meant.items() if name in drawn}],
        closing=closing,
    )


def _passive(m: SlidingLinkage) -> dict[sp.Symbol, tuple[str, ...]]:
    """The passive slides that are drawn, with a point of each body, both on a line along it."""
    found: dict[sp.Symbol, tuple[str, ...]] = {}
    for slide in m.slides:
        first, second = slide.between
        for p, q in product(m.points[first], m.points[second]):
            apart = m.local(second, q) + slide.shift(second) - m.local(first, p)
            own = slide.slide or (slide.joint if first != GROUND else None)
            if own and p != q and sp.simplify(cross_in_plane(slide.way, apart)) == 0:
                found.setdefault(own, (p, q))
    return found


@dataclass(frozen=True)
class _Drawing:
    """The points of a skeleton in both worlds, and its links, lengths and joints."""

    here: dict[str, sp.Matrix]
    meant: dict[str, sp.Matrix]
    links: dict[str, tuple[str, ...]]
    lengths: dict[tuple[str, str], sp.Expr]
    closing: dict[tuple[str, str], sp.Expr]
    joints: dict[sp.Symbol, tuple[str, ...]]


def _draw_feet(m: SlidingLinkage, at: Solver, drawn: _Drawing) -> None:
    """Join a body that no point has on the line of its driven slide to the foot on this line."""
    for k, q in m.glides.items():
        if q in drawn.joints:
            continue
        slide = m.slides[k]
        first, second = slide.between
        near, far = m.points[first][0], m.points[second][0]
        start, own = m.local(first, near) - slide.shift(second), m.local(second, far)
        place = start + slide.way * slide.way.dot(own - start)
        gap, foot = (own - place).applyfunc(sp.simplify), f"{far}_foot"
        length = sp.sqrt(sp.factor(square(gap)))
        drawn.here[foot], drawn.meant[foot] = (
            w.frames[second].at(place) for w in (at.here, at.meant)
        )
        drawn.joints[q], drawn.links[foot] = (near, foot), (far, foot)
        drawn.lengths[far, foot] = length
        drawn.closing[far, foot] = length**2 * at.meant.frames[second].still


@dataclass(frozen=True)
class Rate:
    """The rate of something for each driven joint, times the determinants of some groups."""

    times: sp.Matrix
    groups: frozenset[int] = frozenset()


class _Rates:
    """The rates of the unknowns, group by group."""

    def __init__(self, m: SlidingLinkage, at: Solver, program: Program):
        self.m, self.program, self.known = m, program, dict(at.values)
        self.q = m.d.actuated
        self.of: dict[sp.Symbol, Rate] = {}
        self.volumes: dict[int, sp.Expr] = {}
        self.pushed: list[Rate] = []
        self.last: Block | None = None

    def here(self, e: sp.Expr) -> sp.Expr:
        return e.xreplace(self.known)

    def product(self, groups: frozenset[int]) -> sp.Expr:
        return sp.Mul(*(self.volumes[k] for k in sorted(groups)))

    def rate(self, e: sp.Expr, known: Sequence[sp.Symbol]) -> Rate:
        """The rate of an expression in the joints and in unknowns whose rates are known."""
        moving = [(x, self.here(sp.diff(e, x))) for x in known if e.has(x)]
        moving = [(x, by) for x, by in moving if by != 0]
        groups = frozenset[int]().union(*(self.of[x].groups for x, _ in moving))
        own = sp.Matrix([[self.here(sp.diff(e, q)) for q in self.q]])
        total = own * self.product(groups)
        for x, by in moving:
            total += by * self.of[x].times * self.product(groups - self.of[x].groups)
        return Rate(total, groups)

    def add(self, block: Block, k: int) -> None:
        """The rates of the unknowns of a group."""
        v, known = self.program, list(self.of)
        rows = [self.rate(e, known) for e in block.equations]
        half = [sp.Rational(1, 2) if h else 1 for h in block.halved]
        rows = [Rate(-r.times * h, r.groups) for r, h in zip(rows, half, strict=True)]
        A = block.matrix.applyfunc(self.here)
        A = v.matrix(f"A_{k}", A)
        pushed = [Rate(v.matrix(f"s{i}_{k}", r.times), r.groups) for i, r in enumerate(rows, 1)]
        det = A.det()
        groups = frozenset[int]().union(*(r.groups for r in pushed))
        together = sp.Matrix.vstack(*(r.times * self.product(groups - r.groups) for r in pushed))
        solved = A.adjugate() * together
        if det.is_number:
            solved = solved / det
        else:
            self.volumes[k] = v.let(f"Delta_{k}", det)
            groups |= {k}
        solved = v.matrix(f"w_{k}", solved)
        for i, x in enumerate(block.unknowns):
            self.of[x] = Rate(solved[i, :], groups)
        if block.name:
            self.last, self.pushed, self.matrix = block, pushed, A


def _velocity(m: SlidingLinkage, at: Solver, modes: Branches, loop: Step) -> None:
    d, n = m.d, len(m.d.actuated)
    turning = m.follower in m.turning
    blocks = [b for b in at.blocks if b.name]
    task, tasks = _task(m, at)
    u = [x for b in blocks for x in b.unknowns]
    rows = [b.rows([*u, *tasks]) for b in blocks]
    driven = [-b.rows(d.actuated) for b in blocks]
    if tasks:
        rows.append(sp.Matrix(task).jacobian([*u, *tasks]))
        driven.append(-sp.Matrix(task).jacobian(list(d.actuated)))
    A, B = (sp.Matrix.vstack(*part) for part in (rows, driven))
    if not m.folded:
        A, B = (M.applyfunc(sp.expand) for M in (A, B))
    equations = [e for b in blocks for e in b.equations] + task
    halved = [h for b in blocks for h in b.halved] + [False] * len(task)
    half = sp.diag(*(sp.Rational(1, 2) if h else 1 for h in halved))
    whole = sp.Matrix(equations)
    d.step(
        "Velocity and singular sets",
        "The derivatives of the equations of all groups, those of squares halved, give A*du = B*dq "
        "for the unknowns u of the groups, of which the last are the task.  A is block triangular, "
        "because each group depends on those before it.  Its determinant is the product of those "
        "of the groups.  Where one of them vanishes, the group can move while the joints stand "
        "still (parallel).",
        {"A": A, "B": B},
        proves="A and B are the derivatives.",
        equal=[
            (half * whole.jacobian([*u, *tasks]), A),
            (-half * whole.jacobian(list(d.actuated)), B),
        ],
        uses=[loop],
    )
    v = Program(list(at.program.body), at.program.taken)
    rates = _Rates(m, at, v)
    for k, block in enumerate(blocks, 1):
        rates.add(block, k)
    hand = [rates.of[x] for x in m.hand] if m.direct else _hand(m, at, rates, turning)
    J = sp.Matrix.vstack(*(r.times / rates.product(r.groups) for r in hand))
    named_A, named_B = (M.applyfunc(rates.here) for M in (A, B))
    pole_note = "Not finite at a parallel singularity."
    order = "u are the unknowns, group by group, of which the last are the task."
    functions: list[Exported] = [
        ("jacobian_parallel", "A of A*du = B*dq.", {"A": named_A.tolist()}, (order,)),
        ("jacobian_serial", "B of A*du = B*dq.", {"B": named_B.tolist()}, (order,)),
        ("jacobian", "Derivative of the task with respect to q.", {"J": J.tolist()}, (pole_note,)),
    ]
    factors = [rates.volumes[k] for k in sorted(rates.volumes)]
    if n == len(m.hand):
        det = ("determinant", "Determinant of the Jacobian.", {"det": J.det()}, (pole_note,))
        functions.append(det)
        factors.insert(0, _still(m, rates, hand, _values(m, at, turning)))
    functions.append(
        (
            "singularities",
            "Where the hand stands still (serial), and the determinants of the groups (parallel)."
            if n == len(m.hand)
            else "The determinants of the groups (parallel).",
            {"factors": factors},
            (),
        )
    )
    if n == len(m.hand) == 2:
        groups = hand[0].groups | hand[1].groups
        across = [(r.times * rates.product(groups - r.groups)).T for r in hand]
        size = v.let("pushed", sp.Abs(sp.Matrix.hstack(*across).det()), nonnegative=True)
        functions.append(("condition_number", *conditioning(v, across, size, of=JACOBIAN)))
    export(d, v, modes, functions, {})


def _values(m: SlidingLinkage, at: Solver, turning: bool) -> list[sp.Expr]:
    """The task in the unknowns; of an angle, the coordinates of its unit vector."""
    if turning:
        return list(at.meant.frames[m.follower].vector(sp.Matrix([1, 0])))
    if m.follower:
        return [at.slid(m.follower, at.meant)]
    return list(at.meant.at[m.hand_at])


def _task(m: SlidingLinkage, at: Solver) -> tuple[list[sp.Expr], list[sp.Symbol]]:
    """Equations that are linear in the rates of the task, and its symbols; none if it is a pin."""
    if m.direct:
        return [], []
    x = m.hand[0]
    if m.follower in m.turning:
        a, b = _values(m, at, True)
        return [sp.sin(x) * a - sp.cos(x) * b], [x]
    return [s - e for s, e in zip(m.hand, _values(m, at, False), strict=True)], list(m.hand)


def _hand(m: SlidingLinkage, at: Solver, rates: _Rates, turning: bool) -> list[Rate]:
    """The rates of a task that is not the pin of the last group."""
    found = [rates.rate(e, list(rates.of)) for e in _values(m, at, turning)]
    if not turning:
        return found
    groups = found[0].groups | found[1].groups
    da, db = (r.times * rates.product(groups - r.groups) for r in found)
    x = m.hand[0]
    return [Rate(rates.here(sp.cos(x)) * db - rates.here(sp.sin(x)) * da, groups)]


def _still(
    m: SlidingLinkage, rates: _Rates, hand: Sequence[Rate], values: Sequence[sp.Expr]
) -> sp.Expr:
    """What vanishes where the hand stands still: det J times the determinant of the last group."""
    block, pushed = rates.last, rates.pushed
    if block is None:
        return sp.Matrix.vstack(*(r.times for r in hand)).det()
    if m.direct:
        return sp.Matrix.vstack(*(r.times for r in pushed)).det()
    own = list(block.unknowns)
    before = [x for x in rates.of if x not in own]
    top = [
        [*(rates.product(r.groups) * rates.matrix[i, :]), *(-r.times)] for i, r in enumerate(pushed)
    ]
    below = []
    rows = [
        (sp.Matrix([e]).jacobian(own).applyfunc(rates.here), rates.rate(e, before)) for e in values
    ]
    if len(values) > len(m.hand):  # an angle
        x = m.hand[0]
        groups = rows[0][1].groups | rows[1][1].groups
        weights = (-rates.here(sp.sin(x)), rates.here(sp.cos(x)))
        by, own_rate = sp.zeros(1, len(own)), sp.zeros(1, len(m.d.actuated))
        for weight, (part, rate) in zip(weights, rows, strict=True):
            by += weight * part
            own_rate += weight * rate.times * rates.product(groups - rate.groups)
        rows = [(by, Rate(own_rate, groups))]
    for part, rate in rows:
        below.append([*(rates.product(rate.groups) * part), *rate.times])
    M = rates.program.matrix("M", sp.Matrix([*top, *below]))
    return M.det()


__all__ = ["share_of", "sliding_linkage"]
