"""Prints lowered programs.  Python prepares plain strings; the templates lay them out."""
