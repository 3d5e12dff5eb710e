"""Robots: a generated module with the dimensions, limits, base and tool of one robot.

    >>> from closedform import robots
    >>> arm = robots.load("ur5e", tool=[0, 0, 0.15])
    >>> q = [0.3, -1.6, 1.4, 0.5, 0.9, -0.2]
    >>> arm.nearest(arm.fk(q), q_seed=[0.2, -1.6, 1.4, 0.5, 0.9, -0.2]).q.round(3).tolist()
    [0.3, -1.6, 1.4, 0.5, 0.9, -0.2]

``Robot(module, parameters, ...)`` makes one of any generated module.  NumPy is all that it needs.
"""

from closedform.robots.catalogue import entries, load, names
from closedform.robots.limits import Limits
from closedform.robots.nearest import Nearest
from closedform.robots.robot import Robot
from closedform.robots.track import Path
from closedform.robots.velocity import Rates

__all__ = ["Limits", "Nearest", "Path", "Rates", "Robot", "entries", "load", "names"]
