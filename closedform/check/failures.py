"""The errors that say why printed code cannot be run."""


class UnavailableError(Exception):
    """Something that is needed to run code of this kind is not installed."""


class FailedError(Exception):
    """Code cannot be run; the message is the first thing that its compiler or interpreter said."""
