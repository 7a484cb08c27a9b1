"""What may happen in one epoch (semantics 2), in the verifier's own words.

The model says the same for the planner; an error there must not hide here.
"""

from serendipity.model import GroundAction


def applicable(action: GroundAction, state: frozenset[int]) -> bool:
    """Whether every precondition holds (eq. 4)."""
    return state.issuperset(action.pre) and state.isdisjoint(action.neg)


def clash(a: GroundAction, b: GroundAction, *, strict: bool) -> int | None:
    """A fact over which two actions conflict (eq. 5, 6), or None; ``strict`` as in semantics 2."""
    clashes = set(a.delete) & set(b.delete) | set(a.delete) & set(b.add) | set(a.add) & set(b.delete)
    if strict:
        clashes |= set(a.delete) & set(b.pre) | set(a.add) & set(b.neg)
        clashes |= set(b.delete) & set(a.pre) | set(b.add) & set(a.neg)
    return min(clashes, default=None)


def conflicting(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    """Whether two actions can't share an epoch: an agent takes part in both (eq. 10), or they clash."""
    return not set(a.participants).isdisjoint(b.participants) or clash(a, b, strict=strict) is not None
