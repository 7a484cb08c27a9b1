"""Limits of time and memory, and how well commands keep them."""
