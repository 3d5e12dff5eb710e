"""The textbooks on the Stanford arm."""

from closedform import Paper

STANFORD_TEXTBOOKS = Paper(
    "stanford-textbooks",
    "The Stanford arm in the textbooks",
    ("R. P. Paul", "M. W. Spong", "S. Hutchinson", "M. Vidyasagar"),
    "Paul: Robot Manipulators; Spong, Hutchinson, Vidyasagar: Robot Modeling and Control",
)
