"""The textbooks on the Puma 560."""

from closedform.derivations.papers.textbooks import (
    CORKE,
    CRAIG,
    LEE_ZIEGLER,
    PAUL,
    SPONG_HUTCHINSON_VIDYASAGAR,
)

from closedform import Paper

PUMA_TEXTBOOKS = Paper(
    "puma-textbooks",
    "The Puma 560 in the textbooks",
    ("J. J. Craig", "P. I. Corke", "M. W. Spong", "R. P. Paul", "C. S. G. Lee", "M. Ziegler"),
    "Craig: Introduction to Robotics; Corke: Robotics, Vision and Control, and the Robotics "
    "Toolbox; Spong, Hutchinson, Vidyasagar: Robot Modeling and Control; Paul: Robot Manipulators; "
    "Lee, Ziegler: Geometric Approach in Solving Inverse Kinematics of PUMA Robots (1984)",
    source="The books are quoted from memory for results that are common knowledge: each claim "
    "gives the content of a formula or a sentence, not its wording.  An error of memory "
    "may affect any of them.",
    works=(CORKE, CRAIG, LEE_ZIEGLER, PAUL, SPONG_HUTCHINSON_VIDYASAGAR),
)
