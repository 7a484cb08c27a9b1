"""Goals that are not known: what explains observations, and help that fits every candidate (semantics 8)."""

from search.modes.goals.observed import Explainer, Likelihood, explanations
from search.modes.goals.planner import Candidate, solve_expected

__all__ = ["Candidate", "Explainer", "Likelihood", "explanations", "solve_expected"]
