"""Loops of common structure, which no single paper publishes."""

from closedform.derivations.papers.textbooks import (
    BONEV_CHABLAT_WENGER,
    CARRETERO_PODHORODESKI_NAHON_GOSSELIN,
    CLAVEL,
    FREUDENSTEIN,
    GOSSELIN_HAMEL,
    MERLET,
    OUERFELLI_KUMAR,
    WENGER_CHABLAT,
)

from closedform import Paper

TEXTBOOK_LOOPS = Paper(
    "textbook-loops",
    "Loops of common structure, solved leg by leg",
    ("The closedform authors",),
    works=(MERLET, CLAVEL, WENGER_CHABLAT, FREUDENSTEIN),
)
SPHERICAL_LOOPS = Paper(
    "spherical-loops",
    "Loops on a sphere, solved leg by leg",
    ("The closedform authors",),
    works=(MERLET, OUERFELLI_KUMAR),
)
WRIST_LOOPS = Paper(
    "wrist-loops",
    "Three legs that turn a hand about a point",
    ("The closedform authors",),
    source="The claims are quoted from the abstract of Bonev, Chablat and Wenger.",
    works=(MERLET, GOSSELIN_HAMEL, BONEV_CHABLAT_WENGER),
)
TRIPODS = Paper(
    "tripods",
    "Three legs in vertical planes that lift and tilt a hand",
    ("The closedform authors",),
    works=(MERLET, CARRETERO_PODHORODESKI_NAHON_GOSSELIN),
)
