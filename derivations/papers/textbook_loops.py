"""Loops of common structure, which no single paper publishes."""

from closedform.derivations.papers.textbooks import CLAVEL, MERLET, WENGER_CHABLAT

from closedform import Paper

TEXTBOOK_LOOPS = Paper(
    "textbook-loops",
    "Loops of common structure, solved leg by leg",
    ("The closedform authors",),
    works=(MERLET, CLAVEL, WENGER_CHABLAT),
)
