"""From exact expressions to a short straight-line program that any language can print."""

from closedform.lower.program import Lowered, lower, lower_branch, lowered, results_of

__all__ = ["Lowered", "lower", "lower_branch", "lowered", "results_of"]
