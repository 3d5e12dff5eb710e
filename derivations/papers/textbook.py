"""Arms that no paper publishes."""

from closedform.derivations.papers.textbooks import LYNCH_PARK, MERLET, MURRAY_LI_SASTRY

from closedform import Paper

TEXTBOOK = Paper(
    "textbook",
    "Arms of common structure, solved by lemmas",
    ("The closedform authors",),
    works=(LYNCH_PARK, MERLET, MURRAY_LI_SASTRY),
)
