"""The triangle of two links and the line between their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair

NEARER, FARTHER = "nearer than full stretch", "farther than the fold"
"""The meanings of the bounds of a triangle, which exists if both hold."""

theorem(
    "two-link triangle",
    statement=r"""Two links of lengths $l_1, l_2 > 0$ are joined at the angle $\theta$, and their
ends are at the distance $R > 0$.  Let $\alpha$ be the angle from the first link to the line of
the ends: $l_1 + l_2\cos\theta = R\cos\alpha$ and $l_2\sin\theta = R\sin\alpha$.  With $N = (l_1 +
l_2)^2 - R^2$ and $M = R^2 - (l_1 - l_2)^2$ there is a solution if and only if $N \ge 0$ and $M
\ge 0$.  The solutions are
$$\tan\frac{\theta}{2} = \sigma\frac{\sqrt N}{\sqrt M}, \qquad
\tan\alpha = \sigma\frac{2 l_2\sqrt{N M}}{(l_1 - l_2) N + (l_1 + l_2) M}, \qquad \sigma = \pm 1.$$
With the factors of Heron's formula, $\mathcal S = l_1 + l_2 + R$, $\mathcal A = l_1 + l_2 - R$,
$\mathcal B = R + l_1 - l_2$ and $\mathcal C = R - l_1 + l_2$, the same solutions are
$$\tan\frac{\theta}{2} = \sigma\frac{\sqrt{\mathcal S\mathcal A}}{\sqrt{\mathcal B\mathcal C}},
\qquad
\tan\frac{\alpha}{2} = \sigma\frac{\sqrt{\mathcal A\mathcal C}}{\sqrt{\mathcal S\mathcal B}}.$$""",
    proof=r"""The sum of the squares of both equations is $l_1^2 + l_2^2 + 2 l_1 l_2\cos\theta =
R^2$.  Since $N + M = 4 l_1 l_2$, this says $\cos\theta = (M - N)/(M + N)$.  Such a $\theta$
exists if and only if $N$ and $M$ are not negative, because their sum is positive.  Then
$\tan^2(\theta/2) = (1 - \cos\theta)/(1 + \cos\theta) = N/M$, and $\sigma$ is the sign of
$\theta$.  Here $\sin\theta = 2\sigma\sqrt{N M}/(N + M)$.  Inserted into both equations, this
gives $R\cos\alpha$ and $R\sin\alpha$, and $\tan\alpha$ as their quotient.  The first two factors
of Heron's formula give $N = \mathcal S\mathcal A$ and the others $M = \mathcal B\mathcal C$.  The
law of cosines for the angle at the base, $2 R l_1\cos\alpha = R^2 + l_1^2 - l_2^2$, gives
$\tan^2(\alpha/2) = (1 - \cos\alpha)/(1 + \cos\alpha) = \mathcal A\mathcal C/(\mathcal S\mathcal
B)$ in the same way; $\alpha$ has the sign of $\theta$, because $R\sin\alpha = l_2\sin\theta$.""",
    exception=r"""If a link has no length, $N + M = 0$ and $\theta$ is free.  If $R = 0$, which
needs $l_1 = l_2$, the links coincide and $\alpha$ is free.""",
)


def indexed(letter: str, tag: str) -> str:
    """A letter with the tag of a leg or a joint as its index: ``_1`` or ``_elbow``."""
    index = tag.strip("_")
    if not index:
        return letter
    return rf"{letter}_{{{index}}}" if index.isdigit() else rf"{letter}_{{\mathrm{{{index}}}}}"


@dataclass(frozen=True)
class Triangle:
    """Two links of lengths l1 = ``first`` and l2 = ``second`` whose ends are R apart.

    ``elbow`` is the joint angle between the links, zero when stretched, and ``base`` the angle from
    the first link to the line of the ends, so that a link at ``theta`` reaches the direction
    ``theta + base``.  There are two mirror images, by ``sigma``.  With

        N = (l1 + l2)^2 - R^2,   M = R^2 - (l1 - l2)^2

    both angles follow without R itself:

        tan(elbow / 2) = sqrt(N / M),
        tan(base) = 2 l2 sqrt(N M) / ((l1 - l2) N + (l1 + l2) M).

    Where R is known and not only its square, N = S A and M = B C with the ``factors`` of Heron's
    formula, which lose no digits at the limits, and tan(base / 2) = sqrt(A C) / sqrt(S B).
    """

    first: sp.Expr
    second: sp.Expr
    sigma: sp.Expr
    N: sp.Expr
    M: sp.Expr
    factors: tuple[sp.Expr, ...] = ()
    """S, A, B and C, where the triangle is made from a reach."""

    @classmethod
    def from_reach(
        cls,
        program: Program,
        links: tuple[sp.Expr, sp.Expr],
        reach: sp.Expr,
        sigma: sp.Expr,
        *,
        scale: sp.Expr | None = None,
        suffix: str = "",
    ) -> Triangle:
        """The triangle whose ends are ``reach`` apart, with its four bounds.

        Parameters
        ----------
        program
            the program that the names and bounds are added to
        links
            their lengths
        reach
            the distance of the ends
        sigma
            the sign of the elbow
        scale
            the natural scale of the lengths: by default that of the links, more where the reach is
            a difference of larger lengths
        suffix
            what the names end in
        """
        first, second = links
        scale = first + second if scale is None else scale
        S = program.let(f"S{suffix}", first + second + reach, nonnegative=True)
        A, B, C = (
            program.bound(f"{name}{suffix}", value, scale, meaning)
            for name, value, meaning in (
                ("A", first + second - reach, NEARER),
                ("B", reach + first - second, FARTHER),
                ("C", reach - first + second, FARTHER),
            )
        )
        return cls(first, second, sigma, S * A, B * C, (S, A, B, C))

    @classmethod
    def from_square(
        cls,
        program: Program,
        links: tuple[sp.Expr, sp.Expr],
        square: sp.Expr,
        sigma: sp.Expr,
        *,
        scale: sp.Expr | None = None,
        suffix: str = "",
    ) -> Triangle:
        """The triangle with the ``square`` of the distance of the ends, and its two bounds.

        Both angles follow from the same N and M, whose rounding errors are equivalent to one of R.
        So the links end where they should even if their angles are ill-conditioned.  A fold closer
        than 2^-44 of the links does not count as one: there M may be missed by its own square.

        Parameters
        ----------
        square
            the square of the distance of the ends
        program, links, sigma, scale, suffix
            as in :meth:`from_reach`
        """
        first, second = links
        total, difference = first + second, first - second
        scale = total if scale is None else scale
        N = program.bound(f"N{suffix}", total**2 - square, 2 * total * scale, NEARER)
        M = program.bound(
            f"M{suffix}",
            square - difference**2,
            2 * (sp.Abs(difference) + total / 2**44) * scale,
            FARTHER,
        )
        return cls(first, second, sigma, N, M)

    @property
    def whole(self) -> sp.Expr:
        """``4 l1 l2``, as a sum of what the elbow is computed from."""
        return self.N + self.M

    @property
    def root(self) -> sp.Expr:
        """The root of ``N M``, which is four times the area."""
        return sp.Mul(*map(sp.sqrt, self.factors or (self.N, self.M)))

    def rooted(self, program: Program, suffix: str = "") -> Triangle:
        """The same with names for the roots of the four factors."""
        S, A, B, C = (
            program.let(f"r{name}{suffix}", sp.sqrt(value), nonnegative=True) ** 2
            for name, value in zip("SABC", self.factors, strict=True)
        )
        return Triangle(
            first=self.first,
            second=self.second,
            sigma=self.sigma,
            N=S * A,
            M=B * C,
            factors=(S, A, B, C),
        )

    @property
    def letters(self) -> dict[sp.Symbol, str]:
        """The letters of the factors, which have no other meaning."""
        return {
            s: indexed(rf"\mathcal {n}", str(s)[1:])
            for s, n in zip(self.factors, "SABC", strict=False)
            if isinstance(s, sp.Symbol)
        }

    @property
    def elbow(self) -> sp.Expr:
        """The angle between the links; free where a link has no length."""
        return 2 * self.sigma * sp.atan2(sp.sqrt(self.N), sp.sqrt(self.M))

    def elbow_pair(self, twice: sp.Expr, whole: sp.Expr) -> Pair:
        """The pair of the elbow, from names for twice the :attr:`root` and the :attr:`whole`."""
        return Pair(self.sigma * twice / whole, (self.M - self.N) / whole)

    @property
    def base(self) -> sp.Expr:
        """The angle from the first link to the line of the ends; free where R = 0."""
        if self.factors:
            S, A, B, C = self.factors
            return 2 * self.sigma * sp.atan2(sp.sqrt(A * C), sp.sqrt(S * B))
        return sp.atan2(self.beyond, self.ahead)

    @property
    def width(self) -> sp.Expr:
        """``4 l1 R``, as a sum of what the base is computed from."""
        S, A, B, C = self.factors
        return S * B + A * C

    def base_pair(self, twice: sp.Expr, width: sp.Expr) -> Pair:
        """The pair of the base, from names for twice the :attr:`root` and the :attr:`width`."""
        S, A, B, C = self.factors
        return Pair(self.sigma * twice / width, (S * B - A * C) / width)

    @property
    def ahead(self) -> sp.Expr:
        """``4 l1 R cos(base)``, without R."""
        return (self.first - self.second) * self.N + (self.first + self.second) * self.M

    @property
    def beyond(self) -> sp.Expr:
        """``4 l1 R sin(base)``, without R."""
        return 2 * self.sigma * self.second * self.root

    def lemma(
        self,
        angles: tuple[sp.Symbol, sp.Symbol],
        reach: sp.Expr,
        elbow: sp.Expr | None = None,
        base: sp.Expr | None = None,
    ) -> Lemma:
        """The lemma for the ``angles`` of the elbow and of the base.

        ``elbow`` and ``base`` are the closed forms where a flag chooses between them and a
        convention; by default those of the triangle.
        """
        statement = (
            r"\tan\frac{\theta}{2} = \sigma\frac{\sqrt{\mathcal S\mathcal A}}"
            r"{\sqrt{\mathcal B\mathcal C}},\quad \tan\frac{\alpha}{2} = "
            r"\sigma\frac{\sqrt{\mathcal A\mathcal C}}{\sqrt{\mathcal S\mathcal B}}"
            if self.factors
            else r"N = (l_1 + l_2)^2 - R^2,\ M = R^2 - (l_1 - l_2)^2:\quad "
            r"\tan\frac{\theta}{2} = \sigma\frac{\sqrt N}{\sqrt M},\quad "
            r"\tan\alpha = \sigma\frac{2 l_2 \sqrt{N M}}{(l_1 - l_2) N + (l_1 + l_2) M}"
        )
        at_elbow, at_base = angles
        return Lemma(
            "two-link triangle",
            statement,
            (
                self.first + self.second * sp.cos(at_elbow) - reach * sp.cos(at_base),
                self.second * sp.sin(at_elbow) - reach * sp.sin(at_base),
            ),
            {
                at_elbow: self.elbow if elbow is None else elbow,
                at_base: self.base if base is None else base,
            },
            2,
            signs=(self.sigma,),
            roles=(("l_1", self.first), ("l_2", self.second), ("R", reach)),
            letters=self.letters,
        )

    def stretched_without_link(
        self,
        program: Program,
        angles: tuple[sp.Symbol, sp.Symbol],
        reach: sp.Expr,
        *,
        free: Sequence[sp.Symbol] = (),
        suffix: str = "",
    ) -> tuple[Lemma, tuple[sp.Symbol, sp.Symbol]]:
        """The lemma, and names for :attr:`ahead` and :attr:`beyond`, which turn with the base.

        The elbow is free if a link has no length.  The stretched one is returned then, and the
        ``free`` joints get the status.
        """
        no_link = program.vanishes(
            f"no_link{suffix}",
            self.first * self.second,
            (self.first + self.second) ** 2,
            "a link has no length",
            free,
        )
        ahead = program.let(f"ahead{suffix}", choose(no_link, 1, self.ahead))
        beyond = program.let(f"beyond{suffix}", choose(no_link, 0, self.beyond))
        elbow = choose(no_link, 0, self.elbow)
        return self.lemma(angles, reach, elbow, sp.atan2(beyond, ahead)), (ahead, beyond)


__all__ = ["FARTHER", "NEARER", "Triangle", "indexed"]
