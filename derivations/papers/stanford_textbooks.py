"""The textbooks on the Stanford arm."""

from closedform.derivations.papers.textbooks import (
    PAUL,
    SPONG_HUTCHINSON_VIDYASAGAR,
)

from closedform import Paper

STANFORD_TEXTBOOKS = Paper(
    "stanford-textbooks",
    "The Stanford arm in the textbooks",
    ("R. P. Paul", "M. W. Spong", "S. Hutchinson", "M. Vidyasagar"),
    "Paul: Robot Manipulators; Spong, Hutchinson, Vidyasagar: Robot Modeling and Control",
    source="The books are quoted from memory for a result that is common knowledge; the claim "
    "gives its content, with the hand at the centre of the wrist ($d_6 = 0$), not its wording.",
    works=(PAUL, SPONG_HUTCHINSON_VIDYASAGAR),
)
