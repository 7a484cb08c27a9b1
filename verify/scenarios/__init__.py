"""Answers over scenarios (semantics 8, 11), checked one by one and as a whole."""
