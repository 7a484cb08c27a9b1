"""Distances to goals over many states: by state, by layer, around the goal."""
