"""The mechanisms as compiled modules, with the names and the meaning of the NumPy modules."""

from closedform.lazy import attach

__getattr__, __dir__ = attach(__name__, __path__)
