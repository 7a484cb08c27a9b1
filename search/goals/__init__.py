"""Goals that are not known: what explains observations, and help that fits every candidate (SPEC 8)."""

from search.goals.observed import Explanation, explanations
from search.goals.outcome import Candidate, Expected, Served
from search.goals.planner import solve_expected

__all__ = ["Candidate", "Expected", "Explanation", "Served", "explanations", "solve_expected"]
