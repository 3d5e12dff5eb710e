"""The cross-check of generated code against its derivation."""
