"""Chablat, Wenger and Angeles: a hybrid five-bar linkage."""

from closedform import Paper

CHABLAT_WENGER_ANGELES = Paper(
    "chablat-wenger-angeles",
    "The Kinematic Design of a 3-DOF Hybrid Manipulator",
    ("Damien Chablat", "Philippe Wenger", "Jorge Angeles"),
    "Integrated Design and Manufacturing in Mechanical Engineering, Compiègne, 1998",
)
