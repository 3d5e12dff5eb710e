"""From derivation scripts to files."""
