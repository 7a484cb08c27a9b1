"""Scenarios: a human of whom only possible plans are known, and robots that watch (semantics 11)."""

from search.modes.scenarios.planner import Candidate, solve_scenarios

__all__ = ["Candidate", "solve_scenarios"]
