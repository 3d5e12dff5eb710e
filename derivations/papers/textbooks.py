"""Textbooks and papers on mechanisms of common structure."""

from closedform import Work

BONEV_CHABLAT_WENGER = Work(
    "bonev-chablat-wenger",
    ("Ilian A. Bonev", "Damien Chablat", "Philippe Wenger"),
    "Working and Assembly Modes of the Agile Eye",
    "IEEE International Conference on Robotics and Automation, 2317–2322",
    "2006",
)
CARRETERO_PODHORODESKI_NAHON_GOSSELIN = Work(
    "carretero-podhorodeski-nahon-gosselin",
    ("Juan A. Carretero", "Ron P. Podhorodeski", "Meyer A. Nahon", "Clément M. Gosselin"),
    "Kinematic Analysis and Optimization of a New Three Degree-of-Freedom Spatial Parallel "
    "Manipulator",
    "Journal of Mechanical Design, 122(1), 17–24",
    "2000",
)
CLAVEL = Work(
    "clavel",
    ("Reymond Clavel",),
    "Delta, a Fast Robot with Parallel Geometry",
    "18th International Symposium on Industrial Robots, Lausanne, 91–100",
    "1988",
)
CORKE = Work(
    "corke",
    ("Peter Corke",),
    "Robotics, Vision and Control: Fundamental Algorithms in MATLAB",
    "Springer",
    "2011",
)
CRAIG = Work(
    "craig",
    ("John J. Craig",),
    "Introduction to Robotics: Mechanics and Control",
    "3rd edition, Pearson Prentice Hall",
    "2005",
)
FREUDENSTEIN = Work(
    "freudenstein",
    ("Ferdinand Freudenstein",),
    "Approximate Synthesis of Four-Bar Linkages",
    "Transactions of the ASME, 77(6), 853–861",
    "1955",
)
GOSSELIN_HAMEL = Work(
    "gosselin-hamel",
    ("Clément M. Gosselin", "Jean-François Hamel"),
    "The Agile Eye: A High-Performance Three-Degree-of-Freedom Camera-Orienting Device",
    "IEEE International Conference on Robotics and Automation, 781–786",
    "1994",
)
HE_LIU = Work(
    "he-liu",
    ("Yanhao He", "Steven Liu"),
    "Analytical Inverse Kinematics for Franka Emika Panda – a Geometrical Solver for 7-DOF "
    "Manipulators with Unconventional Design",
    "9th International Conference on Control, Mechatronics and Automation",
    "2021",
)
KREUTZ_DELGADO_LONG_SERAJI = Work(
    "kreutz-delgado-long-seraji",
    ("Kenneth Kreutz-Delgado", "Mark Long", "Homayoun Seraji"),
    "Kinematic Analysis of 7-DOF Manipulators",
    "The International Journal of Robotics Research, 11(5), 469–481",
    "1992",
)
LEE_ZIEGLER = Work(
    "lee-ziegler",
    ("C. S. George Lee", "M. Ziegler"),
    "Geometric Approach in Solving Inverse Kinematics of PUMA Robots",
    "IEEE Transactions on Aerospace and Electronic Systems, AES-20(6), 695–706",
    "1984",
)
LYNCH_PARK = Work(
    "lynch-park",
    ("Kevin M. Lynch", "Frank C. Park"),
    "Modern Robotics: Mechanics, Planning, and Control",
    "Cambridge University Press",
    "2017",
)
LOPEZ_CUSTODIO_GONG_FIGUEREDO = Work(
    "lopez-custodio-gong-figueredo",
    ("Pablo C. Lopez-Custodio", "Yuhe Gong", "Luis F. C. Figueredo"),
    "GeoFIK: A Fast and Reliable Geometric Solver for the IK of the Franka Arm based on Screw "
    "Theory Enabling Multiple Redundancy Parameters",
    "arXiv:2503.03992",
    "2025",
)
MERLET = Work("merlet", ("Jean-Pierre Merlet",), "Parallel Robots", "2nd edition, Springer", "2006")
MURRAY_LI_SASTRY = Work(
    "murray-li-sastry",
    ("Richard M. Murray", "Zexiang Li", "S. Shankar Sastry"),
    "A Mathematical Introduction to Robotic Manipulation",
    "CRC Press",
    "1994",
)
OUERFELLI_KUMAR = Work(
    "ouerfelli-kumar",
    ("Mohamed Ouerfelli", "Vijay Kumar"),
    "Optimization of a Spherical Five-Bar Parallel Drive Linkage",
    "Journal of Mechanical Design, 116(1), 166–173",
    "1994",
)
PAUL = Work(
    "paul",
    ("Richard P. Paul",),
    "Robot Manipulators: Mathematics, Programming, and Control",
    "MIT Press",
    "1981",
)
SHIMIZU_AND_OTHERS = Work(
    "shimizu-and-others",
    (
        "Masayuki Shimizu",
        "Hiromu Kakuya",
        "Woo-Keun Yoon",
        "Kosei Kitagaki",
        "Kazuhiro Kosuge",
    ),
    "Analytical Inverse Kinematic Computation for 7-DOF Redundant Manipulators with Joint Limits "
    "and Its Application to Redundancy Resolution",
    "IEEE Transactions on Robotics, 24(5), 1131–1142",
    "2008",
)
SPONG_HUTCHINSON_VIDYASAGAR = Work(
    "spong-hutchinson-vidyasagar",
    ("Mark W. Spong", "Seth Hutchinson", "M. Vidyasagar"),
    "Robot Modeling and Control",
    "Wiley",
    "2006",
)
WENGER_CHABLAT = Work(
    "wenger-chablat",
    ("Philippe Wenger", "Damien Chablat"),
    "Kinematic Analysis of a New Parallel Machine Tool: the Orthoglide",
    "Advances in Robot Kinematics, Kluwer, 305–314",
    "2000",
)
