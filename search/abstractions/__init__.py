"""Abstractions of what the human does alone: projections as arrays, and the sums of several."""
