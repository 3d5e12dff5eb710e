"""Robots: a generated module with the dimensions, limits, base and tool of one robot.

    >>> from closedform import puma560
    >>> from closedform.robots import Robot
    >>> arm = Robot(puma560, tool=[0, 0, 0.1])
    >>> q = [0.3, -0.6, 0.4, 0.5, 0.9, -0.2]
    >>> arm.nearest(arm.fk(q), q_seed=[0.2, -0.6, 0.4, 0.5, 0.9, -0.2]).q.round(3).tolist()
    [0.3, -0.6, 0.4, 0.5, 0.9, -0.2]

It needs NumPy only.
"""

from closedform.robots.limits import Limits
from closedform.robots.nearest import Nearest
from closedform.robots.robot import Robot
from closedform.robots.track import Path
from closedform.robots.velocity import Rates

__all__ = ["Limits", "Nearest", "Path", "Rates", "Robot"]
