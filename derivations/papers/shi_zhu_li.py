"""Shi, Zhu and Li: a palletising robot."""

from closedform import Paper

SHI_ZHU_LI = Paper(
    "shi-zhu-li",
    "New Method for Kinematic Analysis of a Hybrid Manipulator",
    ("Jun Shi", "Xiaorui Zhu", "Zexiang Li"),
)
