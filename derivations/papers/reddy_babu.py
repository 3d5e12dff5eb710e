"""Reddy and Babu: a planar arm and a spherical wrist."""

from closedform import Paper

DEFINITION = "definitions of terms or names"
ANNOUNCEMENT = "announces what follows"
CAPTION = "caption of a figure, which the text does not contain"

REDDY_BABU = Paper(
    "reddy-babu",
    "Kinematic Attitudes of a Planar Robot and a Spherical Wrist",
    ("S. Baswanth Kumar Reddy", "K. Rajesh Babu"),
    year="n.d. (the latest work that it cites is of 2015)",
    sections=(
        "Abstract",
        "Introduction",
        "Kinematic Analysis By Geometric Approach, A. Forward Kinematics",
        "Kinematic Analysis By Geometric Approach, B. Inverse Kinematics",
        "Kinematic Analysis By Denavit – Hartenberg Convention",
        "Kinematic Analysis By Denavit – Hartenberg Convention, A. Forward Kinematics",
        "Kinematic Analysis By Denavit – Hartenberg Convention, B. Inverse Kinematics",
        "Orientation Aspects of A Spherical Wrist",
        "Orientation Aspects of A Spherical Wrist, A. Euler Angles",
        "Orientation Aspects of A Spherical Wrist, B. D-H Convention",
        "Results and Discussion, A. Result for 2-DOF planar robot by Geometric approach",
        "Results and Discussion, B. Result for 2-DOF planar robot by D-H Convention method",
        "Results and Discussion, C. Results for Orientation of a Spherical Wrist",
        "Results and Discussion",
        "Conclusions",
    ),
    source="The text was read from a scan by optical character recognition, without the figures.  "
    "Errors of the scan may affect single characters: the cosine in the numerator of tan "
    "α, the sum in $c_{12}$, the last row of T in eq. (9), s_5 in row 1, column 2 of eqs. (14) "
    "and (15) (it appears in both), and the last digits in the results A and B.  The scan "
    "has R_{zγz} for R_{zyz} in eq. (12), and superscripts instead of indices in Table II; "
    "these are not counted.",
    out_of_scope=(
        ("Kinematic Attitudes of a Planar Robot", "²Associate Professor", "title and authors"),
        ("Abstract: --The central issue", "in a world space.", "introduction"),
        (
            "These homogeneous transformations are used to solve",
            "the present work focuses on",
            "introduction",
        ),
        (
            "and the orientation aspects of a spherical wrist. This is to say",
            "HT matrix in robotic engineering.",
            "the aim of the paper, and a judgement of value",
        ),
        ("Keywords:", "Robot hand, Spherical wrist.", "keywords"),
        ("Introduction Robotics is", "opposite relationship. [3]", "introduction and definitions"),
        (
            "This paper aims to clarify",
            "orientation aspects of a spherical wrist.",
            "the aim of the paper",
        ),
        (
            "Kinematic Analysis By Geometric Approach A.",
            "is called as forward kinematics",
            DEFINITION,
        ),
        ("Fig. 1: Schematic", "planar manipulator [12]", CAPTION),
        ("where θ_1, θ_2 are joint angles", "is called inverse kinematics.", DEFINITION),
        ("Fig. 2: Multiple", "solutions [1]", CAPTION),
        ("Fig. 3: Solving", "joint angles [12]", CAPTION),
        (
            "Kinematic Analysis By Denavit – Hartenberg Convention The Denavit",
            "Representation of four D-H parameters [11]",
            "describes the convention in general and announces what follows",
        ),
        (
            "A. Forward Kinematics The following table describes the D-H",
            "Table I: D-H parameters for 2-DOF planar manipulator",
            ANNOUNCEMENT,
        ),
        ("B. Inverse Kinematics The inverse kinematics can", "B. Inverse Kinematics", "heading"),
        ("Orientation Aspects of A Spherical Wrist", "Spherical Wrist", "heading"),
        ("Let (i_x, j_y, k_z)", "OUVW systems respectively.", DEFINITION),
        ("where I, j, k are unit vectors A. Euler Angles", "A. Euler Angles", DEFINITION),
        ("Fig. 5: Representation", "of Euler angles [5]", CAPTION),
        (
            "(12) where I, j, k are unit vectors",
            "(a) Inverse orientation",
            "defines names that eq. (12) does not contain",
        ),
        (
            "B. D-H Convention Representation of orientation",
            "D-H parameters for the spherical wrist.",
            ANNOUNCEMENT,
        ),
        ("(15) (a) Inverse orientation", "(a) Inverse orientation", "heading"),
        (
            "Results and Discussion A. Result for 2-DOF",
            "by Geometric approach",
            "heading",
        ),
        ("B. Result for 2-DOF planar robot", "D-H Convention method", "heading"),
        (
            "C. Results for Orientation of a Spherical Wrist",
            "(b) Relation between Σ_A and Σ_H [5]",
            "heading and caption of a figure, which the text does not contain",
        ),
        ("The joint angles of the spherical wrist are obtained", "D-H Convention", ANNOUNCEMENT),
        (
            "Conclusions In the present work",
            "using Euler angles and D-H Convention",
            "summary of what was done",
        ),
        ("References", "planar 3R manipulator by V. Kumar", "references"),
    ),
)
