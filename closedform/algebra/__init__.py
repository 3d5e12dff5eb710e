"""Exact mathematics, independent of robots."""
