"""Proofs and verdicts, by exact algebra."""
