"""The papers behind the derivations."""

from closedform import Paper

REDDY_BABU = Paper(
    "reddy-babu",
    "Kinematic Attitudes of a Planar Robot and a Spherical Wrist",
    ("S. Baswanth Kumar Reddy", "K. Rajesh Babu"),
)

SHI_ZHU_LI = Paper(
    "shi-zhu-li",
    "New Method for Kinematic Analysis of a Hybrid Manipulator",
    ("Jun Shi", "Xiaorui Zhu", "Zexiang Li"),
)

CHABLAT_WENGER_ANGELES = Paper(
    "chablat-wenger-angeles",
    "The Kinematic Design of a 3-DOF Hybrid Manipulator",
    ("Damien Chablat", "Philippe Wenger", "Jorge Angeles"),
    "Integrated Design and Manufacturing in Mechanical Engineering, Compiègne, 1998",
)

TEXTBOOK = Paper(
    "textbook",
    "Arms of common structure, solved by lemmas",
    ("The closedform authors",),
)

PUMA_TEXTBOOKS = Paper(
    "puma-textbooks",
    "The Puma 560 in the textbooks",
    ("J. J. Craig", "P. I. Corke", "M. W. Spong", "R. P. Paul", "C. S. G. Lee", "M. Ziegler"),
    "Craig: Introduction to Robotics; Corke: Robotics, Vision and Control, and the Robotics "
    "Toolbox; Spong, Hutchinson, Vidyasagar: Robot Modeling and Control; Paul: Robot Manipulators; "
    "Lee, Ziegler: Geometric Approach in Solving Inverse Kinematics of PUMA Robots (1984)",
)

STANFORD_TEXTBOOKS = Paper(
    "stanford-textbooks",
    "The Stanford arm in the textbooks",
    ("R. P. Paul", "M. W. Spong", "S. Hutchinson", "M. Vidyasagar"),
    "Paul: Robot Manipulators; Spong, Hutchinson, Vidyasagar: Robot Modeling and Control",
)

RAO_RAJU = Paper(
    "rao-raju",
    "Forward and inverse kinematics of a hybrid series-parallel manipulator",
    ("Sachit Rao", "Jagannath Raju"),
    "15th National Conference on Machines and Mechanisms, NaCoMM2011-134",
)
