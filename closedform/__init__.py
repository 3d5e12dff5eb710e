"""closedform: published mechanisms as proved, fast, closed-form kinematics."""

__version__ = "0.1.0"
