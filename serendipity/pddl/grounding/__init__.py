"""Lifted values to the task: bindings, ground actions, pruning, numbers.

What does not fit into memory, or into the time that there is, is a ``LimitReachedError``; what is not
supported, or has too many cases, an ``InputError``.
"""
