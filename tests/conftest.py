"""Hypothesis draws the same examples on every run: a failure can be repeated, a build is stable."""

from hypothesis import settings

settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")
