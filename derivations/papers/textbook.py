"""Arms that no paper publishes."""

from closedform import Paper

TEXTBOOK = Paper(
    "textbook",
    "Arms of common structure, solved by lemmas",
    ("The closedform authors",),
)
