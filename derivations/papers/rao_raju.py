"""Rao and Raju: the H6AR."""

from closedform import Paper

OUTLINE = "says what follows; what it announces is judged where it appears"
BUILT = "describes the construction, which the model takes as given"
NAMES = "introduces names and conventions"
LITERATURE = "speaks of other robots and of the literature"
FIGURES = "describes a figure, which the text does not contain"
DATA = "title, authors, addresses and references"
REPEATED = "repeats what is judged elsewhere"

RAO_RAJU = Paper(
    "rao-raju",
    "Forward and inverse kinematics of a hybrid series-parallel manipulator",
    ("Sachit Rao", "Jagannath Raju"),
    "15th National Conference on Machines and Mechanisms, NaCoMM2011-134",
    year="2011",
    sections=(
        "Abstract",
        "1 Introduction",
        "2 Description of the H6AR",
        "3.1 Tips of the fore-arms",
        "3.2 Invariant point-forward kinematics",
        "3.3 Equivalent serial mechanism",
        "3.4 Wrist",
        "4 Inverse Kinematics",
        "5 Conclusions",
    ),
    source="The text was read from a scan by optical character recognition, without the figures.  "
    "The order of the axes of the wrist is taken from (9), because Fig. 4 is not legible "
    "there.  Errors of the scan may affect signs and indices: eq. (3), whose sign is "
    "compared with (9), and the second equation before (14).  In the line of (9) for "
    "$L_\\theta$ the scan has $l_n$, which is read as $l_p$.  The sentence after (14) "
    "about the coordinates of the right tip is printed twice, once garbled.",
    out_of_scope=(
        ("Forward and inverse kinematics of a hybrid", "relations of", DATA),
        (", named the H6AR, are presented.", "presented.", NAMES),
        ("Closed-form forward and inverse", "are presented.", OUTLINE),
        ("Conventional serial link manipulators", '"dual-elbow" manipulator, [9].', LITERATURE),
        ("Jagannath Raju Sachit Rao (Corr", "Conference on Machines and Mechanisms", DATA),
        ("The paper is organised as follows", "shown in Fig. 1.", OUTLINE),
        ("Figure 1: Schematics of", "the H6AR wrist", FIGURES),
        ("The entire H6AR assembly is mounted", "stationary base.", BUILT),
        ("The wrist assembly, whose schematic", "one of the bars.", BUILT),
        ('This point is termed as the "invariant" point.', '"invariant" point.', NAMES),
        ("The wrist assembly also consists of a link", "generate the pitching motion.", BUILT),
        ("The physical parameters of the H6AR are as follows", "has a length l_p .", NAMES),
        ("The procedure to design them is presented", "in Sec. 3.4.", OUTLINE),
        ("The joint angles of H6AR are denoted", "ϕ , and θ , respectively.", NAMES),
        ("To show that the H6AR does have 6 DOFs,", "DOFs,", REPEATED),
        ("In this equation, M is the total number", "i^{th} joint.", NAMES),
        ("Name $\\operatorname{DOF}", "(f_i)", NAMES),
        ("Table 1: Joints of the H6AR", "their DOFs", NAMES),
        ("3 Forward Kinematics In this section", "with respect to this point.", OUTLINE),
        ("The coordinate frames and D-H parameters of the waist, right", "assigned", FIGURES),
        ("The Y-axis of each of these", "left-side components as well.", NAMES),
        ("By denoting the Figure 2:", "their values are given by", NAMES),
        (", \\ (c) s_i =", "\\theta_i", NAMES),
        (", \\ (c) s_{ij} =", "NaCoMM2011-134 and", NAMES),
        (", $$ respectively. In the next", "about the invariant point.", REPEATED),
        ("The reflective-symmetric motions and the location", "\\theta \\neq 0$.", FIGURES),
        ("$\\theta_1 = 0$ and $\\theta \\neq 0$.", "0$.", FIGURES),
        ("Due to the reflective-symmetric motion that", "generates the roll angle,", FIGURES),
        ("Similarly, to calculate the coordinates", "consider Fig. 3(a).", OUTLINE),
        ("triangles $\\triangle AOC", "BCD$", FIGURES),
        ("can be derived. Thus", "derived.", OUTLINE),
        ("motions, its coordinates when expressed in", "are given by", OUTLINE),
        (", \\ \\theta_i^A = \\frac{\\theta_i^R", "i = 2, 3.", NAMES),
        ("In addition, from Fig. 3(a),", "3(a),", FIGURES),
        ("To determine the coordinates of the tip, denoted", "as shown in Fig. 4.", FIGURES),
        ("(X, Y, Z)_{3V}$ and", "(X, Y, Z)_{4V}", NAMES),
        ("Following the procedure used to de15th", "are given by", OUTLINE),
        ("denoted by $|\\psi| \\leq", "\\psi_{\\max}$,", NAMES),
        ("In order that this singularity", "|\\psi| = \\psi_{\\max}$.", "chooses a parameter"),
        ("Now, to design the length", "selected to satisfy", OUTLINE),
        ("3.1 Tips of the fore-arms", "fore-arms", NAMES),
        ("(6) From (1) and (2) and", "and", OUTLINE),
        ("3.3 Equivalent serial mechanism Comparing", "given by (1) and (2),", OUTLINE),
        ("the coordinates $(x, y, z)_R$ are calculated to", "(x, y, z)_I$", REPEATED),
        ("5 Conclusions", "Conclusions", NAMES),
        ("4 Inverse Kinematics In this section", "Waist Angle:", OUTLINE),
        ("can be derived. To solve this", "the identity", OUTLINE),
        ("Invariant Point: To evaluate the", "to be determined.", OUTLINE),
        ("which is derived using (9).", "it can be shown that", OUTLINE),
        ("Next, by solving the simultaneous equations", "equations", OUTLINE),
        ("the angle θ_2^A can be obtained from", "the sum", OUTLINE),
        ("Twin Shoulder and Elbow Angles:", "Angles:", NAMES),
        ("say θ_2^R , θ_3^R (or", "In addition,", NAMES),
        ("Here, only the calculation", "Since the coordinates $(x, y, z)_I$ are known,", OUTLINE),
        ("are known. Since the coordinates $(x, y, z)_I$ are known,", "known,", REPEATED),
        ("15th National Conference on Machines and Mechanisms The angle", "The angle", DATA),
        ("θ_2^R is calculated by following", "is given by", OUTLINE),
        ("References - T. Arai", "28(3):357–373, 1993.", DATA),
    ),
)
