"""Answers for goals that are not known (semantics 8), checked goal by goal and as a whole."""
