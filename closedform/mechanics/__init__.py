"""Frames, serial arms and loops."""
