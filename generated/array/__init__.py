"""The mechanisms as modules for any array library."""

from closedform.lazy import attach

__getattr__, __dir__ = attach(__name__, __path__)
