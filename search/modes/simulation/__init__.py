"""The human who replans: what they do with a plan that nobody told them of (semantics 6)."""

from search.modes.simulation.simulator import simulate

__all__ = ["simulate"]
