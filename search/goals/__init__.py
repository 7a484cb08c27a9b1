"""Goals that are not known: what explains observations, and help that fits every candidate (semantics 8)."""

from search.goals.observed import Likelihood, explanations
from search.goals.outcome import Candidate, Expected, ServedGoal
from search.goals.planner import solve_expected

__all__ = ["Candidate", "Expected", "Likelihood", "ServedGoal", "explanations", "solve_expected"]
