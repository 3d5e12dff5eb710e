"""Chablat, Wenger and Angeles: a hybrid five-bar linkage."""

from closedform import Paper

HEADING = "a heading"
NAMES = "only names what the neighbouring claims judge"
KNOWN = "general statements about other manipulators, or literature"
AIMS = "aims and announcements; what is announced is judged where it appears"
FIGURE = "the caption of a figure that is not in the text"
DEFINITION = "a definition"
RUNNING = "the running title of the paper"
TITLE = "THE KINEMATIC DESIGN OF A 3-DOF HYBRID MANIPULATOR"

CHABLAT_WENGER_ANGELES = Paper(
    "chablat-wenger-angeles",
    "The Kinematic Design of a 3-DOF Hybrid Manipulator",
    ("Damien Chablat", "Philippe Wenger", "Jorge Angeles"),
    "Integrated Design and Manufacturing in Mechanical Engineering, Compiègne",
    year="1998",
    source="The text is a scan of the paper, read by optical character recognition, without its "
           "figures.  A misread index or fraction could affect eq. (4), the condition after eq. "
           "(6), the eigenvalues, eq. (8) and the angles that follow it.  The wrong indices of "
           "section 3.4 appear in all its formulas, so the scan is not their cause.  The indices "
           "in section 3.2 may be misread: the text has the sum of the lengths $L_1 + L_1$.",
    out_of_scope=(
        ("HAL", "### Abstract", "the cover page of the archive, title and authors"),
        ("(similar to the one studied", "Roth [1])", KNOWN),
        ("Fully-parallel manipulators are known", "relatively large positioning errors.", KNOWN),
        ("The influence of the different structural", "optimal design of such hybrid", AIMS),
        ("manipulators. ### 1. Introduction", "gained with such architecture.", KNOWN),
        ("Figure 1.", "Robot anthropomorphe", FIGURE),
        ("The main kinematic equations", "direct-kinematics matrices »", AIMS),
        (". These matrices enable the determination", "joint spaces. The influence of", AIMS),
        ("the different structural dimensions (e.g. the link lengths) on the kinematic and "
         "mechanical properties are analyzed", "CLOSED-CHAIN MANIPULATOR", AIMS),
        (", as displayed in figure 2.", "figure 2.", "refers to a figure"),
        ("In manipulator design, then,", "### 2.2 A THREE-DOF HYBRID MANIPULATOR", AIMS),
        ("We thus obtain the manipulator of figure 3.", "Figure 2.", "refers to figures"),
        ("### 2.3 KINEMATIC RELATIONS", "2.3 KINEMATIC RELATIONS", HEADING),
        ("while vectors $\\dot", "are given by", NAMES),
        ("### 2.4 THE WORKING MODE", "2.4 THE WORKING MODE", HEADING),
        ("The set of manipulator postures free", "*working mode*.", DEFINITION),
        ("The formal definition of the working mode", "in [2].", KNOWN),
        ("### 2.5 THE PARALLEL SINGULARITIES", "2.5 THE PARALLEL SINGULARITIES", HEADING),
        ("To interpret these singularities, we calculate", "\\mathbf{A}^T", NAMES),
        ("Figure 5. Parallel singularity", "whence it is apparent that", FIGURE),
        ("### 2.6 THE SERIAL SINGULARITIES", "2.6 THE SERIAL SINGULARITIES", HEADING),
        (f"{TITLE} at the boundary", "at the boundary", RUNNING),
        ("Figure 7. Serial singularity", "#### 3.1 WORKSPACE", FIGURE),
        ("A cross section of the workspace of such", "Figure 9. A cross section of the joint space",
         FIGURE),
        ("### 3.2 AVOIDING PARALLEL", "SINGULARITIES BY PROPER DESIGN", HEADING),
        ("### 3.3 AVOIDING PARALLEL", "BY A CHANGE OF WORKING MODE", HEADING),
        ("Figure 12. Working mode and parallel", "singularity", FIGURE),
        ("Also, to execute operations in a highly", "desirable to change working mode.", AIMS),
        (f"{TITLE} working mode, the condition", "working mode,", RUNNING),
        ("### 3.4 THE ISOCONDITIONING CURVES", "defined, in turn, as", DEFINITION),
        ("\\mathbf{M} \\mathbf{M}^T$ .", "\\mathbf{M}^T$ .", NAMES),
        ("The eigenvalues of the matrix $\\mathbf{A} \\mathbf{A}^T$ (6) are", "are,", NAMES),
        ("[3], the foregoing eigenvalues", "ordered as", NAMES),
        ("The condition number of matrix", "is thus", NAMES),
        ("Correspondingly, the locus of points whereby", "On the other hand,", DEFINITION),
        ("Figure 15. Isoconditioning curves", "for two working modes", FIGURE),
        ("#### 4. Conclusions", "implementation of these manipulators.", AIMS),
        ("Further research work is being conducted", "No. 2, pp. 43-61.",
         "plans, acknowledgments and references"),
    ),
)  # fmt: skip
