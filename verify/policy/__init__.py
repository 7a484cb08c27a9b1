"""Checks policies of silent assistance (semantics 7) by their own rules; nothing of the search is used.

A policy is *closed* if it says what to do after whatever the human may optimally do,
*consistent* if each value is what one round and the values after it make (a Bellman
residual of zero), *optimal* if lower bounds that prove each other round by round reach
its value in the initial state.
"""

from verify.policy.check import check_policy

__all__ = ["check_policy"]
