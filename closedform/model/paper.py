"""The published sources of a derivation."""

from __future__ import annotations

from dataclasses import dataclass

from closedform.model.names import check_formulas, check_key, check_text


@dataclass(frozen=True)
class Work:
    """A book or a paper, as a bibliography lists it."""

    key: str
    authors: tuple[str, ...]
    title: str
    published: str
    """Where: a publisher, or a journal or conference with its volume and pages."""
    year: str

    def __post_init__(self) -> None:
        check_key(self.key, "key of a work")
        check_text(f"work {self.key}", *self.authors, self.title, self.published, self.year)


@dataclass(frozen=True)
class Paper:
    """A published source."""

    key: str
    title: str
    authors: tuple[str, ...]
    reference: str = ""
    source: str = ""
    """How the text was obtained, and which claims a reading error may affect."""
    out_of_scope: tuple[tuple[str, str, str], ...] = ()
    """What the claims leave out: the first and last words of each passage, and the reason."""
    year: str = ""
    """The date of publication, or what is known of it."""
    sections: tuple[str, ...] = ()
    """The sections in the order of the paper, if its claims are judged in another one."""
    works: tuple[Work, ...] = ()
    """The books and papers that this source stands for, if it is a collection of them."""

    def __post_init__(self) -> None:
        check_key(self.key, "key of the paper")
        check_text("year of the paper", self.year)
        check_text("title of the paper", self.title)
        if isinstance(self.authors, str):
            raise TypeError(f"authors of the paper: write a tuple, as in ({self.authors!r},)")
        check_text("authors of the paper", *self.authors)
        check_text("reference of the paper", self.reference)
        check_text("source of the paper", self.source)
        check_formulas("source of the paper", self.source)
        check_text("sections of the paper", *self.sections)
        check_text("passage of the paper", *(part for p in self.out_of_scope for part in p))

    @property
    def cited(self) -> tuple[Work, ...]:
        """The entries of a bibliography: the paper itself, or the works of a collection."""
        own = Work(self.key, self.authors, self.title, self.reference, self.year)
        return self.works or ((own,) if self.reference or self.year else ())


__all__ = ["Paper", "Work"]
