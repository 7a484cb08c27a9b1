"""Searches that know nothing of planning: best first, A*, shortest paths, AND-OR graphs, dominance."""
