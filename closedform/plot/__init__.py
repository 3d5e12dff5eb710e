"""Figures of any generated module: ``closedform[plot]``, which is Matplotlib.

Every function takes a generated module, ``closedform.generated.numpy.<robot>`` or the faster
``closedform.generated.c.<robot>``, draws on ``ax`` (by default on new axes), and returns the axes.

    >>> import closedform
    >>> from closedform import plot
    >>> ax = plot.branches(closedform.planar_2r, [12.0, 8.0])
    >>> ax.figure.savefig("branches.svg")
"""

from closedform.plot.axes import joint_axes
from closedform.plot.diagram import Diagram
from closedform.plot.maps import field, singularities, workspace
from closedform.plot.motion import motion
from closedform.plot.paths import line, path
from closedform.plot.postures import branches, mechanism, posture
from closedform.plot.style import colour, new_axes, new_panels, save, styled

__all__ = [
    "Diagram",
    "branches",
    "colour",
    "field",
    "joint_axes",
    "line",
    "mechanism",
    "motion",
    "new_axes",
    "new_panels",
    "path",
    "posture",
    "save",
    "singularities",
    "styled",
    "workspace",
]
