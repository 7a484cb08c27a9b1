"""Goals that are not known: what explains observations (semantics 8)."""

from search.modes.goals.observed import Explainer, Likelihood, Prices, Reading

__all__ = ["Explainer", "Likelihood", "Prices", "Reading"]
