"""Answers for goals that are not known (semantics 8), checked goal by goal and as a whole."""

from verify.goals.check import check_goals

__all__ = ["check_goals"]
