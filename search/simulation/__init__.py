"""The human who replans: what they do with a plan that nobody told them of (semantics 6)."""

from search.modes.simulation.planner import solve_for_human
from search.modes.simulation.simulator import Epoch, Simulated, Skipped, simulate

__all__ = ["Epoch", "Simulated", "Skipped", "simulate", "solve_for_human"]
