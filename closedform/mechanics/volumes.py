"""Volumes in closed form, for workspaces."""

from __future__ import annotations

import sympy as sp


def lens(first: sp.Expr, second: sp.Expr, distance: sp.Expr) -> sp.Expr:
    """The volume that two intersecting balls share: two caps, by integration."""
    t = sp.Dummy("t", real=True)
    plane = (distance**2 + first**2 - second**2) / (2 * distance)
    caps = ((first, plane), (second, distance - plane))
    volume = sum(sp.integrate(sp.pi * (r**2 - t**2), (t, start, r)) for r, start in caps)
    return sp.factor(volume)
