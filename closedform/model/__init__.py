"""The records that a derivation is made of."""
