"""The printed modules: NumPy in ``numpy``, compiled in ``c``."""

from closedform.lazy import attach

__getattr__, __dir__ = attach(__name__, __path__)
