"""The mechanisms as NumPy modules."""

from closedform.lazy import attach

__getattr__, __dir__ = attach(__name__, __path__)
