"""From a table of joints to a derivation script."""
