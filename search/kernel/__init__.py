"""The compiled part: generic search over packed states in C, and how it is built and loaded."""
