"""Limits on time and memory, and how they are kept."""
