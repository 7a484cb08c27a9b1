"""States as rows of machine words, thousands at a time in numpy: operators, tables, bounds, searches.

What a fact or an action means is not known here: operators need, forbid, add and delete facts, and have
a weight.
"""
