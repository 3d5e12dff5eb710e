"""Why printed code is not run."""


class UnavailableError(Exception):
    """What is needed to run code of this kind is not installed."""


class FailedError(Exception):
    """Code cannot be run: the first thing that its compiler or its interpreter says about it."""
