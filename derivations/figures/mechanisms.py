"""How each mechanism is shown: its postures and the section of its workspace."""

import numpy as np

from closedform.plot.catalogue import View

VIRTUAL = ("upper_virtual", "fore_virtual")
TWIN = (-10, 62, 4, 54, 12, 30)
"""The angles of the H6AR in a general posture, in degrees: the arms differ, the wrist turns."""


def degrees(*angles: float) -> tuple[float, ...]:
    return tuple(float(a) for a in np.radians(angles))


VIEWS = {
    "planar_2r": View(unit="cm", home=degrees(0, 0), general=degrees(35, 50)),
    "spherical_wrist": View(
        home=degrees(0, 0, 0), general=degrees(35, 55, 40), measured=("theta4", "theta5")
    ),
    "irb260": View(unit="m", general=degrees(-50, 25, 15, 40)),
    "hybrid_five_bar": View(
        home=degrees(90, 70, 110), general=degrees(65, 75, 85), plane=("y", "x"), at=(0, 0, 0)
    ),
    "h6ar": View(
        unit="m", home=degrees(0, 60, 30, 60, 30, 0), general=degrees(*TWIN), faint=VIRTUAL
    ),
    "h6ar_loop_closed": View(
        unit="m",
        home=degrees(0, 60, 30, 60, 30, 0),
        general=degrees(*TWIN),
        faint=VIRTUAL,
        published="h6ar",
    ),
    "puma560": View(unit="m"),
    "stanford_arm": View(
        unit="m",
        home=(0, 0, 0.35, 0, 0, 0),
        general=(*degrees(-30, 60), 0.45, *degrees(40, 45, 20)),
        limits=((-0.8, 0.8), (-0.8, 0.8)),
    ),
    "scara": View(
        unit="m",
        home=(0, 0, 0.2, 0),
        general=(*degrees(-20, 60), 0.2, *degrees(40)),
        plane=("x", "y"),
    ),
    "irb2400": View(unit="m", general=degrees(-30, 25, -20, 30, 40, 20)),
    "opw_arm": View(unit="m", general=degrees(-30, 15, 70, 30, 40, 20), shown={"b": 0.12}),
    "ur_arm": View(
        unit="m",
        home=degrees(0, -60, 80, -110, -90, 0),
        general=degrees(-30, -75, 95, -50, -60, 40),
    ),
    "srs_arm": View(unit="m", general=degrees(-20, 40, 30, -70, 20, 60, 0), given=0.3),
    "franka_arm": View(unit="m", general=degrees(-20, -30, 20, -120, 10, 110, 45)),
    "five_bar": View(home=degrees(110, 70), general=degrees(140, 65)),
    "delta": View(
        unit="m",
        home=degrees(30, 30, 30),
        general=degrees(20, 35, 50),
        shown={"f": 0.15},
        plane=("x", "z"),
    ),
    "linear_delta": View(
        unit="m", home=(0.4, 0.4, 0.4), general=(0.4, 0.45, 0.36), plane=("x", "y")
    ),
    "orthoglide": View(
        unit="m", home=(1, 1, 1), general=(1.15, 0.9, 0.8), plane=("x", "y"), at=(0, 0, 0), mode=1
    ),
    "three_prs": View(
        unit="m",
        home=(0.5, 0, 0),
        general=(0.45, *degrees(20, -25)),
        plane=("tilt_x", "tilt_y"),
        at=(0.45, 0, 0),
    ),
    "spherical_five_bar": View(
        unit="m",
        home=degrees(110, 70),
        general=degrees(130, 60),
        on_sphere=True,
        measured=("theta1", "theta2"),
        faint=("rod0",),
    ),
    "agile_wrist": View(
        unit="m",
        home=degrees(0, 0, 0),
        general=degrees(-30, -60, 60),
        measured=("theta1", "theta2"),
        faint=("ground", "hand1", "hand2", "hand3"),
        hues={f"{link}{k}": k + 1 for k in (1, 2, 3) for link in ("crank", "rod")},
    ),
    "four_bar": View(home=degrees(90), general=degrees(50)),
    "slider_crank": View(unit="m", home=degrees(90), general=degrees(50), mode=1, shown={"e": 0.5}),
    "rpr_planar": View(
        unit="m", home=(0.8, 0.8), general=(0.9, 0.6), limits=((-0.7, 1.7), (-1.1, 1.1))
    ),
}
"""For each mechanism; one that is not listed is shown at zero and far from singular."""
