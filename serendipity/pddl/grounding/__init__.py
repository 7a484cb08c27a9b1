"""Lifted values to the task: bindings, ground actions, pruning, numbers."""
