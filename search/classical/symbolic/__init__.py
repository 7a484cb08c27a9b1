"""Symbolic bidirectional search: sets of states as decision diagrams (extra ``symbolic``)."""

from search.classical.symbolic.process import cheapest_plan, is_installed

__all__ = ["cheapest_plan", "is_installed"]
