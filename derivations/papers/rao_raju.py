"""Rao and Raju: the H6AR."""

from closedform import Paper

RAO_RAJU = Paper(
    "rao-raju",
    "Forward and inverse kinematics of a hybrid series-parallel manipulator",
    ("Sachit Rao", "Jagannath Raju"),
    "15th National Conference on Machines and Mechanisms, NaCoMM2011-134",
)
