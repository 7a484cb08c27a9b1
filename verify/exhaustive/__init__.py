"""Proofs by exhaustive search where no horizon bounds a program."""
