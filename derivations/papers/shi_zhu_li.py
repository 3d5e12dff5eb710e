"""Shi, Zhu and Li: a palletising robot."""

from closedform import Paper

LEADS = "leads to the equation that follows"
DEFINES = "defines a name"
ANNOUNCES = "announces what follows"
REPORTS = "reports how the figures were made"

SHI_ZHU_LI = Paper(
    "shi-zhu-li",
    "New Method for Kinematic Analysis of a Hybrid Manipulator",
    ("Jun Shi", "Xiaorui Zhu", "Zexiang Li"),
    year="n.d. (the latest work that it cites is of 2005)",
    source="The text was read from a scan by optical character recognition; the drawings were not "
    "available.  What the drawings show is taken from the text and from the equations: the "
    "two loops, the axes of eqs. (1) to (5), and the captions of Figs. 4 to 6.  Errors of "
    "the scan may affect the small signs: the dots and the exponent of eq. (14), the "
    "primes and hats of eqs. (16) to (20), the index of $q_5$ in eqs. (5) and (23), and "
    "the number in the reference to Fig. 5.  All lines of eqs. (19) and (20) have the "
    "primes, so a single error of the scan does not explain them.  The heading of the last "
    "section has the number I, probably for VI.",
    out_of_scope=(
        ("New Method for Kinematic Analysis", "Fellow, IEEE*", "title and authors"),
        ("This paper presents a new method to analyze", "from the ABB Company.", ANNOUNCES),
        ("In this paper, the rigorous analytical", "and the screw theory.", ANNOUNCES),
        ("Then the kinematics can be solved using", "open-chain manipulators.", ANNOUNCES),
        ("Index Terms:", "two advantages [2].", "key words, and an introduction to the literature"),
        (
            "The other is to provide a very geometric",
            "analysis of mechanisms.",
            "a judgement of value about other work",
        ),
        (
            "Kinematic analysis has been a hot topic",
            "the kinematics for hybrid serial-parallel manipulators.",
            "an introduction to the literature, with judgements of difficulty",
        ),
        (
            "The main contribution of this paper is",
            "make the foundation for further analysis.",
            ANNOUNCES,
        ),
        ("II. BACKGROUND", "BACKGROUND", "a heading"),
        (
            "The four-bar mechanisms are widely used",
            "output links called the coupler.",
            "defines names by a drawing",
        ),
        (
            ", Fig. 1 (b). The main role",
            "upper arms of the robot.",
            "a judgement about other robots",
        ),
        (
            "Two parallel four-bar mechanisms are connected",
            "the proposed simple method.",
            "defines a name and announces what follows",
        ),
        (
            "This relationship can be easily understood",
            "packing robots.",
            "refers to a drawing and judges the use of the robot",
        ),
        ("III. MODELING", "ABB IRB260 [8].", "a heading and captions"),
        (
            "The traditional method is to find out",
            "the structure equations.",
            "describes the method of others",
        ),
        ("In this situation, we propose", "simpler to work out.", ANNOUNCES),
        ("Fig. 3. The diagram", "Simplified structure of IRB260", "captions"),
        ("IV. KINEMATICS", "According to the screw theories [2],", ANNOUNCES),
        ("Both of them are represented", "convenience of computation.", "states a convention"),
        ("Hence the corresponding vectors", "seen in Fig. 6,", LEADS),
        ("Fig. 5. A revolute joint [2].", "A revolute joint [2].", "a caption"),
        ("In order to find an exponential", "$SE(3)$,", LEADS),
        (". Therefore the corresponding twist", "homogeneous coordinates as,", LEADS),
        ("According to the Proposition 2.8", "can be derived as,", LEADS),
        ("Hence the connection between", "built already as,", LEADS),
        ("Fig. 6. Final simplified", "open-chain mechanism", "a caption"),
        ("where $i=1", "5$,", DEFINES),
        ("where the notation $c(", r"s(\theta_i) = \sin \theta_i$.", DEFINES),
        ("B. Spatial Jacobian", "Spatial Jacobian", "a heading"),
        ("Then applying the chain rule to the Equation (14)", "we can get,", LEADS),
        ("where the v operator is defined", "parameterizes a twist.", DEFINES),
        (", the spatial manipulator Jacobian can be extracted as,", "extracted as,", LEADS),
        ("For the i -th joint, we have", "we have", LEADS),
        ("where Ad represents the adjoint", "rigid transformation g [2],", DEFINES),
        ("V. VERIFICATION", "VERIFICATION", "a heading"),
        (
            "It is easy to check the velocity",
            "using the proposed method.",
            "announces the test and reports how it was made",
        ),
        ("Let $\\omega_1 = -30", "\\omega_3 = 5^\\circ/s$,", "the inputs of the test"),
        (". Then we plot the", "curves simulated from ADAMS", REPORTS),
        ("(b) $v_{q_5}^s$ curves", "Fig. 7(b).", REPORTS),
        ("I. CONCLUSIONS", "axes is assumed.", "a heading and a summary of what was done"),
        ("REFERENCES", "three directions.", "references and captions"),
    ),
)
