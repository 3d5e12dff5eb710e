"""Arms of common structure, which no single paper publishes."""

from closedform.derivations.papers.textbooks import LYNCH_PARK, MURRAY_LI_SASTRY

from closedform import Paper

TEXTBOOK = Paper(
    "textbook",
    "Arms of common structure, solved by lemmas",
    ("The closedform authors",),
    works=(LYNCH_PARK, MURRAY_LI_SASTRY),
)
