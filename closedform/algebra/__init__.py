"""Exact mathematics that knows nothing of robots."""
