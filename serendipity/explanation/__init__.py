"""Why this help, why now, why at this price - or why none: each statement backed by a planning call."""

from serendipity.explanation.explain import explain
from serendipity.explanation.explanation import Explanation
from serendipity.explanation.policies import PolicyExplanation, explain_policy

__all__ = ["Explanation", "PolicyExplanation", "explain", "explain_policy"]
