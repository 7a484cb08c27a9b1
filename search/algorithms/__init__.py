"""Algorithms on graphs that know nothing of planning: shortest paths, A*, AND-OR graphs."""
