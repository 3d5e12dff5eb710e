"""The checks that judge claims; a verdict is always computed."""
