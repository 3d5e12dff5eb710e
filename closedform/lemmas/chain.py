"""An inverse as a chain of lemmas, each applied to what the earlier ones have left.

A :class:`Chain` is built as one would explain the inverse: *solve the first joint from this
equation, turn the target into its frame, solve the next*.  Each lemma returns its joint as a
sine-cosine pair.  The chain knows what every name stands for at a posture, so that the proof is the
same for every robot (see :mod:`closedform.proof.glue`):

- each lemma, for the coefficients it is applied to as free symbols, is sound and gives all
  solutions of its equations;
- these equations follow from the forward map, so no posture is lost;
- together they determine the target from the joints, so no answer is wrong.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.algebra.expressions import linear_root
from closedform.algebra.shapes import ShapeError
from closedform.algebra.solutions import rotation_parametrisation
from closedform.lemmas.applied import Applied
from closedform.lemmas.corrected import Corrected, Correction
from closedform.lemmas.given import given_slide, given_turn
from closedform.lemmas.pairs import direction
from closedform.mechanics.frames import pose_symbols, require_pose
from closedform.mechanics.lengths import reach_in_numbers
from closedform.model.derivation import Derivation, Solved
from closedform.model.expressions import substitute
from closedform.model.functions import (
    SINGLE,
    Bound,
    Let,
    Match,
    Statement,
    Vanishes,
    branches,
    choose,
    real,
)
from closedform.model.inverse import Degenerate, Inverse, Link, Rank, Relation
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair

Choice = Mapping[int, str]

AMPLIFIED = (
    "OK answers hold to 1e-12 of the size of the arm, the sum of its lengths, or to 3.5e-14 of it "
    "times the size over the distance of the skew axes, if that is more."
)


@dataclass
class Chain:
    """An inverse as a chain of lemmas; each solves for a joint or for several.

    Apply lemmas by :meth:`solve`, in the order in which you would solve by hand, and export the
    inverse by :meth:`finish`.  Tolerances are relative to the ``size`` of the arm, unless you set
    another one before the first lemma: the sum of its lengths, or its reach if they are numbers.

    Parameters
    ----------
    d
        the derivation
    forward
        the 4x4 pose of the tool, or the task coordinates, as functions of the joints
    angles
        the task coordinates that are angles; they are compared up to full turns
    name
        the name of the exported function
    """

    d: Derivation
    forward: Any
    angles: Sequence[str] = ()
    name: str = "ik"

    def __post_init__(self) -> None:
        self.joints = self.d.actuated
        self.program = self.d.program()
        self.links: list[Link] = []
        self.choices: list[tuple[sp.Symbol, Choice]] = []
        self.values: dict[sp.Symbol, sp.Expr] = {}
        self.meaning: dict[sp.Symbol, sp.Expr] = {}
        self.defined: dict[sp.Symbol, sp.Expr] = {}
        self.lengths: dict[sp.Symbol, sp.Expr] = {}
        self.notes: list[str] = []
        self.degenerate: list[Degenerate] = []
        self.units: list[tuple[sp.Expr, sp.Expr, tuple[sp.Expr, ...]]] = []
        self.halves: dict[sp.Symbol, tuple[Pair, sp.Expr]] = {}
        self.directions: dict[sp.Expr, Pair] = {}
        self.extra_coordinates: list[sp.Symbol] = []
        self.condition: sp.Expr = sp.S.Zero
        self.rounding: sp.Expr = sp.S.Zero
        """What a rounding error of the target becomes in a length that is compared with it."""
        self.tangent: list[sp.Basic] = []
        """Flags that a goal has chosen a turn, because both of its solutions nearly meet."""
        self.corrected: Corrected | None = None
        self.weights: dict[sp.Symbol, sp.Expr] = {}
        self.coefficients: set[sp.Symbol] = set()
        """Names of the coefficients of lemmas, which are proved for all values of them."""
        self.is_pose = isinstance(self.forward, sp.MatrixBase) and self.forward.shape == (4, 4)
        self._size: sp.Expr | None = None
        if self.is_pose:
            self.T = pose_symbols()
            self.R, self.p = self.T[:3, :3], self.T[:3, 3]
            require_pose(self.program, self.T)
            self.targets: tuple[sp.Symbol, ...] = tuple(self.T)
            self.images: tuple[sp.Expr, ...] = tuple(self.forward)
            self.inputs: dict[str, Any] = {"T": self.T}
        else:
            self.x = tuple(real(f"x_{name}") for name in self.d.task)
            self.targets, self.images = self.x, tuple(self.forward)
            self.inputs = {"x": self.x}

    @property
    def size(self) -> sp.Expr:
        """The size of the arm, named in the program."""
        if self._size is None:
            self.size = self.sum_of_lengths()
        return self._size

    @size.setter
    def size(self, value: sp.Expr) -> None:
        self._size = self.let("size", value)

    def sum_of_lengths(self) -> sp.Expr:
        """The size of the arm: its parameters that are lengths, and its reach in numbers."""
        lengths = [p for p in self.d.parameters if p.nonnegative or p.unit != "rad"]
        sized = [p.symbol if p.nonnegative else sp.Abs(p.symbol) for p in lengths]
        places = self.forward[:3, 3] if self.is_pose else self.forward
        return sp.Add(*sized) + reach_in_numbers(places)

    def given(self, joint: sp.Symbol) -> Any:
        """Take a joint as an input of the inverse, besides the pose.

        Returns its pair, or its value if it slides.
        """
        slides = any(j.symbol == joint and j.kind == "prismatic" for j in self.d.joints)
        symbol = (self._given if slides else self.given_angle)(joint.name, joint)

        def given(chain: Chain) -> Applied:
            return (
                given_slide(joint, symbol) if slides else given_turn(chain.program, joint, symbol)
            )

        return self.solve(given)

    def given_angle(self, name: str, image: sp.Expr, weight: sp.Expr = sp.S.One) -> sp.Symbol:
        """Take an angle of the posture as an input of the inverse, besides the pose.

        ``image`` is the angle as a function of the joints.  It may be undefined at some postures.
        ``weight`` vanishes there, and the error that is allowed in the angle is divided by it.
        """
        symbol = self._given(name, image)
        self.angles = (*self.angles, name)
        if weight != 1:
            self.weights[symbol] = weight
        return symbol

    def _given(self, name: str, image: sp.Expr) -> sp.Symbol:
        if not self.is_pose:
            raise ShapeError(
                f"{self.d.name}: a joint or an angle can only be given in addition to a pose"
            )
        symbol = real(f"x_{name}")
        self.inputs[name] = symbol
        self.targets, self.images = (*self.targets, symbol), (*self.images, image)
        return symbol

    def reached(self, rest: sp.Matrix | None = None) -> None:
        """Compare the pose of the joints with the target, for arms that do not reach every pose.

        With fewer than six joints the lemmas use only a part of the target.  Rounding errors in the
        rest are corrected; the status is UNREACHABLE if the rest does not match.  If a lemma has
        used the whole rotation, ``rest`` is what remains of the position after all joints, and it
        must be zero.
        """
        meaning, place = "the pose is one of the arm's", self.forward
        slides = {j.symbol: self.values[j.symbol] for j in self.d.joints if j.kind == "prismatic"}
        size, rounding = self.size or sp.S.One, sp.S.Zero
        if slides:  # which have no limits, so that a target may be large beside the size
            rounding = self.let("rounded", 4 * (size + sp.Add(*map(sp.Abs, self.p))))
        if rest is not None:
            for entry in rest:
                self.program.match(entry, size, meaning, rounding=rounding)
            return
        functions = sorted(place.atoms(sp.sin, sp.cos), key=str)
        pairs = {f.args[0]: self._solved_pair(f.args[0]) for f in functions}
        place, target = place[:3, :], self.T[:3, :]
        scales = [size if j == 3 else sp.S.One for _ in range(3) for j in range(4)]
        self.corrected = Correction(
            self.program, self.joints, tuple(target), tuple(place), scales,
            pairs=pairs, slides=slides, size=size,
        ).applied()  # fmt: skip
        for entry, scale in zip(self.corrected.missed, scales, strict=True):
            more = rounding if scale == size else sp.S.Zero
            self.program.match(entry, scale, meaning, rounding=more)

    def _solved_pair(self, total: sp.Expr) -> Pair:
        """The pair of a sum of solved joints."""
        for symbol, value in self.defined.items():
            if symbol in self.values and not (rest := sp.expand(total - value)).has(*self.joints):
                total = symbol + rest
        total = self.by_angles(total)
        fixed = {a: Pair(sp.sin(a), sp.cos(a)) for a in total.atoms(sp.atan2, sp.atan)}
        pair = self.pair_of(total, fixed)
        if pair is None:
            raise ShapeError(
                f"{self.d.name}: no lemma has solved for the joints in {total} yet; "
                f"solve for them first"
            )
        return pair

    def target(self, name: str) -> sp.Symbol:
        """The target value of a task coordinate."""
        return self.x[self.d.task.index(name)]

    # Names

    def let(self, name: str, value: Any) -> sp.Expr:
        """Name a coefficient; a symbol or a number keeps its own name."""
        value = sp.sympify(value, strict=True)
        if value.is_Symbol or value.is_number:
            return value
        return self.program.let(name, value)

    def named(self, name: str, value: Any, **assumptions: bool) -> sp.Symbol:
        """A name for a coefficient of a lemma."""
        symbol = self.program.let(name, value, **assumptions)
        self.coefficients.add(symbol)
        return symbol

    def coefficient(self, name: str, value: sp.Expr, **assumptions: bool) -> sp.Expr:
        """A symbol, its negative or a rational number as it is; anything else under a name."""
        if value.is_Symbol or (-value).is_Symbol or value.is_Rational:
            return value
        return self.named(name, value, **assumptions)

    def vector(self, name: str, value: sp.Matrix) -> sp.Matrix:
        return sp.Matrix([self.let(f"{name}_{i}", v) for i, v in zip("xyz", value, strict=False)])

    def matrix(self, name: str, value: sp.Matrix) -> sp.Matrix:
        return sp.Matrix(*value.shape, lambda i, j: self.let(f"{name}_{i + 1}{j + 1}", value[i, j]))

    def direction(self, name: str, x: sp.Expr, y: sp.Expr) -> Pair:
        """The pair of ``atan2(y, x)`` for a vector of parameters; the pair of 0 if both vanish."""
        p = self.program
        length = p.let(f"size_{name}", sp.sqrt(x**2 + y**2), nonnegative=True)
        nothing = p.vanishes(f"no_{name}", length, 0, "the vector is zero")
        named = direction(y, x, length, nothing).known_as(p, f"_{name}")
        self.meaning |= {named.s: y / sp.sqrt(x**2 + y**2), named.c: x / sp.sqrt(x**2 + y**2)}
        self.directions[sp.atan2(y, x)] = named
        return named

    def coordinate(self, name: str, value: sp.Expr) -> sp.Symbol:
        """A name for a quantity that the target determines, such as the square of a distance.

        It counts as another coordinate of the target.  The equations that are linear in all
        coordinates determine it from the joints, so it need not be linear in the others.
        """
        symbol = self.program.let(name, value)
        self.extra_coordinates.append(symbol)
        return symbol

    def amplified_over(self, length: sp.Expr | int) -> sp.Expr:
        """Declare that rounding errors of the size of the arm are divided by a ``length``, a lever.

        Returns the error that is allowed in an answer, on the scale of the tolerances: half the
        size of the arm or more.  If a length of parameters vanishes, the status is INVALID.
        """
        length = sp.sympify(length, strict=True)
        self.condition = 5 * self.sum_of_lengths() / (2 * length)
        self.rounding = self.condition * self.sum_of_lengths() / 4
        if length.free_symbols:
            meaning = "the distance between skew axes is not zero"
            none = self.program.vanishes("no_distance", length, self.size, meaning)
            self.program.require([choose(none, 1, 0)], sp.S.One, meaning)
        return self.let("play", self.size * sp.Max(1, self.size / (16 * length)) / 2)

    def angle(self, name: str, value: sp.Expr) -> sp.Symbol:
        """An auxiliary angle: a sum of joints with integer coefficients, and a constant."""
        symbol = real(name)
        self.defined[symbol] = value
        return symbol

    def length(self, name: str, value: sp.Expr) -> sp.Symbol:
        """An auxiliary length, with its value at a posture."""
        symbol = real(name)
        self.lengths[symbol] = value
        return symbol

    def sign(self, name: str, choice: Choice) -> sp.Symbol:
        """A branch sign and the names of its two values."""
        symbol = real(f"sigma_{name}")
        self.choices.append((symbol, choice))
        return symbol

    # Lemmas

    def solve(self, lemma: Any, *arguments: Any, **options: Any) -> Any:
        """Apply a lemma, such as those of :mod:`closedform.lemmas.links`; returns its result."""
        start = len(self.program.body)
        applied: Applied = lemma(
            self, *map(_exact, arguments), **{key: _exact(value) for key, value in options.items()}
        )
        body: tuple[Statement, ...] = tuple(
            s
            for s in self.program.body[start:]
            if not (isinstance(s, Let) and s.symbol in self.coefficients)
        )
        for unknown in applied.lemma.solution:
            self._check_unknown(unknown, applied.lemma)
        self._check_coefficients(applied.lemma)
        self.links.append(
            Link(
                unknowns=tuple(applied.lemma.solution),
                equations=applied.lemma.equations,
                given=dict(applied.given),
                lemma=replace(applied.lemma, kind=lemma.__name__),
                body=body,
                means=dict(applied.means),
                degenerate=applied.degenerate,
                relations=tuple(map(self._written_out, applied.relations)),
            )
        )
        self.meaning |= applied.means
        self.halves |= applied.halves
        solved = {u: substitute(v, self.values) for u, v in applied.lemma.solution.items()}
        self.values |= solved
        self.notes += [f"SINGULAR: {case.meaning}" for case in applied.degenerate if case.free]
        return applied.result

    def _written_out(self, relation: Relation) -> Relation:
        """A relation in which the names that the program does not keep are replaced."""
        made = {s.symbol: s.value for s in self.program.body if isinstance(s, (Let, Bound))}
        made |= self.meaning
        known: dict[sp.Basic, sp.Basic] = {}

        def written(e: sp.Expr) -> sp.Expr:
            for s in e.free_symbols & made.keys() - known.keys():
                known[s] = written(made[s])
            return substitute(e, known)

        terms = tuple((u, tuple(map(written, factors))) for u, factors in relation.terms)
        return replace(relation, value=written(relation.value), terms=terms) if terms else relation

    def _check_unknown(self, unknown: sp.Symbol, lemma: Lemma) -> None:
        if unknown not in {*self.joints, *self.defined, *self.lengths}:
            raise ShapeError(
                f"{self.d.name}: the lemma {lemma.name!r} solves for {unknown}, which is neither "
                f"a joint nor an auxiliary angle or length of the chain; make it with d.joint, "
                f"ik.angle or ik.length"
            )
        if unknown in self.values:
            raise ShapeError(
                f"{self.d.name}: the lemma {lemma.name!r} solves for {unknown}, which an earlier "
                f"lemma has solved"
            )

    def _check_coefficients(self, lemma: Lemma) -> None:
        made = {s.symbol: s.value for s in self.program.body if isinstance(s, Let)}
        made |= self.meaning
        held: set[sp.Basic] = set()
        pending = {s for e in lemma.equations for s in e.free_symbols}
        while pending:
            symbol = pending.pop()
            held.add(symbol)
            pending |= made[symbol].free_symbols - held if symbol in made else set()
        solvable = {*self.joints, *self.defined, *self.lengths}
        early = sorted((held & solvable) - {*lemma.solution, *self.values}, key=str)
        if early:
            unknowns = ", ".join(map(str, lemma.solution))
            raise ShapeError(
                f"{self.d.name}: the lemma {lemma.name!r} for {unknowns} cannot be applied here: "
                f"its coefficients contain {early[0]}, which no lemma has solved yet; solve for "
                f"{early[0]} first, or use an equation without it"
            )

    def pair_of(self, total: sp.Expr, known: Mapping[sp.Expr, Pair] | None = None) -> Pair | None:
        """The sine and the cosine of a sum of angles that have pairs, of the target or solved.

        An angle that is read from them needs no reduction, whereas a sum of angles may need several
        turns. None if an angle has no pair or occurs more than once.  Pairs in ``known`` take
        precedence.
        """
        known = {**self.directions, **(known or {})}
        pairs: dict[sp.Basic, dict[type, sp.Expr]] = {}
        for name, meaning in self.meaning.items():
            if isinstance(meaning, sp.sin | sp.cos):
                pairs.setdefault(meaning.args[0], {})[type(meaning)] = name
        result = Pair(sp.S.Zero, sp.S.One)
        given = {*self.targets, *(p.symbol for p in self.d.parameters)}
        for term, factor in sp.expand(total).as_coefficients_dict().items():
            made = pairs.get(term, {})
            s, c = made.get(sp.sin), made.get(sp.cos)
            if term in known:
                s, c = known[term].s, known[term].c
            if not term.free_symbols:
                s, c, factor = sp.sin(factor * term), sp.cos(factor * term), sp.S.One
            elif term in given:
                s, c = sp.sin(term), sp.cos(term)
            if s is None or c is None or abs(factor) != 1:
                return None
            result += Pair(factor * s, c)
        return result

    def by_angles(self, total: sp.Expr, *, solved: bool = False) -> sp.Expr:
        """A sum in which auxiliary angles replace their joints, also those that are ``solved``."""
        found: dict[sp.Symbol, sp.Expr] = {}
        known = [(symbol, value) for symbol, value in self.defined.items() if symbol in self.values]
        for symbol, value in [*known, *known]:  # twice: some contain joints that others give
            held = [j for j in self.joints if value.has(j)]
            alone = solved and len(held) == 1
            left = [j for j in held if j not in found and (alone or j not in self.values)]
            if len(left) == 1:
                sense, rest = value.diff(left[0]), value.xreplace({left[0]: sp.S.Zero})
                if abs(sense) == 1:
                    found[left[0]] = sense * (symbol - rest.xreplace(found))
        return sp.expand(total.xreplace(found))

    # The end

    def _solve_sums(self) -> None:
        """Solve for joints in auxiliary angles whose other terms are known."""
        progress = True
        while progress:
            progress = False
            for symbol, value in self.defined.items():
                left = [j for j in self.joints if value.has(j) and j not in self.values]
                if symbol in self.values and len(left) == 1:
                    (joint,) = left
                    self.values[joint] = self._angle_of(linear_root(value - symbol, joint))
                    progress = True

    def _angle_of(self, total: sp.Expr) -> sp.Expr:
        """A sum of solved angles, with half turns that some of them have in some branches."""
        whole = [s for s, (_, flip) in self.halves.items() if flip == 0]
        if any(total in (s, -s) for s in whole):
            return substitute(total, self.values)
        half = [self.halves[s] for s in total.free_symbols if s in self.halves]
        pair = self.pair_of(total, {s: found for s, (found, _) in self.halves.items()})
        if pair is None:
            return self._less_offset(total)
        return pair.angle + sp.Add(*(flip for _, flip in half))

    def _less_offset(self, total: sp.Expr) -> sp.Expr:
        """A sum of solved angles; what is constant in it, other than right angles, turns one."""
        parameters = {p.symbol for p in self.d.parameters}
        if total.free_symbols & parameters:
            total = self.by_angles(total, solved=True)  # in which the same offset cancels
        constant = [t for t in total.as_ordered_terms() if t.free_symbols <= parameters]
        constant = [t for t in constant if not (2 * t / sp.pi).is_Integer]
        offset = sp.Add(*constant)
        for e in sorted(offset.atoms(sp.atan2) - self.directions.keys(), key=str):
            if len(constant) > 1 and e.free_symbols:  # a sum of several may be any angle
                self.direction(f"offset{len(self.directions)}", e.args[1], e.args[0])
        for angle in (total - offset).as_ordered_terms() if offset != 0 else ():
            if pair := self.pair_of(angle + offset, {}):
                return pair.angle + substitute(total - offset - angle, self.values)
        return substitute(total, self.values)

    def _answers(self) -> list[sp.Expr]:
        """The values of the joints, corrected where the lemmas miss a part of the target."""
        values = [self.values[j] for j in self.joints]
        if self.corrected is None:
            return values
        loose, moved = self.corrected.loose, self.corrected.moved
        return [
            choose(loose, value + moved[j], value)
            for j, value in zip(self.joints, values, strict=True)
        ]

    def _leave_out_unused(self) -> None:
        """Remove names that a lemma returned and nothing uses."""
        needed = {s for answer in self._answers() for s in answer.free_symbols}
        needed |= {s for link in self.links for e in link.equations for s in e.free_symbols}
        needed |= {s for pair in self.units for e in pair[:2] for s in e.free_symbols}
        matches = [s.value for s in self.program.body if isinstance(s, Match)]
        needed |= {s for e in matches for s in e.free_symbols}
        kept: list[Statement] = []
        for statement in reversed(self.program.body):
            if not isinstance(statement, Let) or statement.symbol in needed:
                held = ("value", "scale", "rounding")
                values = [getattr(statement, name, None) for name in held]
                values += getattr(statement, "values", ())
                needed |= {s for e in values if e is not None for s in e.free_symbols}
                kept.insert(0, statement)
        self.program.body[:] = kept
        left = set(kept)
        self.links[:] = [
            replace(
                link,
                body=tuple(s for s in link.body if s in left),
                means={s: e for s, e in link.means.items() if s in needed or s.is_number},
            )
            for link in self.links
        ]

    def continuum(self, free: sp.Symbol, locus: Mapping[sp.Symbol, Any], relation: str) -> None:
        """State where a joint is free: values of the target and the parameters, and a relation.

        The values may contain joints that were solved before.  The relation between the other
        joints is LaTeX.
        """
        flags = [s.symbol for s in self.program.body if isinstance(s, Vanishes) and free in s.free]
        if not flags:
            raise ShapeError(f"{self.d.name}: no lemma of the chain leaves {free} free anywhere")
        exact = {s: sp.sympify(e, strict=True) for s, e in locus.items()}
        self.degenerate.append(Degenerate((flags[0],), exact, free, relation=relation))

    def finish(
        self,
        summary: str,
        *,
        source: str = "",
        notes: Sequence[str] = (),
        singular: Sequence[str] | None = None,
    ) -> Inverse:
        """Export the inverse.

        ``singular`` says which joint is free and where, instead of the sentences of the lemmas.
        """
        d = self.d
        self._solve_sums()
        missing = [j for j in self.joints if j not in self.values]
        if missing:
            raise ShapeError(
                f"{d.name}: no lemma solves for {missing[0]}; ik.finish needs every joint, solved "
                f"for itself or left over in an auxiliary angle"
            )
        self._leave_out_unused()
        choices = branches(*self.choices) if self.choices else SINGLE
        if self.name == "ik":
            d.branches = choices.labels
        said = self.notes if singular is None else [f"SINGULAR: {text}" for text in singular]
        if self.condition != 0:
            said = [*said, AMPLIFIED]
        d.function(
            self.name,
            summary,
            self.inputs,
            {"q": self._answers()},
            program=self.program,
            branches=choices,
            result="Solutions",
            source=source,
            notes=(*dict.fromkeys([*notes, *said]),),
        )
        for link in self.links:
            assert link.lemma is not None
            unknown = link.unknowns[0]
            shown = [e for e in link.equations if e.has(unknown)]
            d.solved.append(
                Solved(self.name, unknown, link.lemma, shown[0] if shown else sp.S.Zero)
            )
        inverse = Inverse(
            self.name,
            self.joints,
            self.targets,
            self.images,
            tuple(self.degenerate),
            parametrisation=self._rotations() if self.is_pose else (),
            angles=tuple(real(f"x_{n}") for n in self.angles),
            links=tuple(self.links),
            weights=self.weights,
            condition=self.condition,
            glue=Rank(
                {**self.meaning},
                {**self.defined},
                {**self.lengths},
                tuple(self.units),
                tuple(self.extra_coordinates),
            ),
        )
        d.inverses.append(inverse)
        return inverse

    def _rotations(self) -> tuple[sp.Expr, ...]:
        """The targets, with every rotation in free symbols instead of its entries."""
        R = rotation_parametrisation()
        turned = {self.R[i, j]: R[i, j] for i in range(3) for j in range(3)}
        return tuple(turned.get(x, x) for x in self.targets)


def _exact(argument: Any) -> Any:
    if type(argument) is tuple:
        return tuple(map(_exact, argument))
    return sp.Integer(argument) if type(argument) is int else argument


__all__ = ["Chain", "Choice"]
