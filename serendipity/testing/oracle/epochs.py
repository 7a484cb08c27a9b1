"""One epoch: conditions, effects, and which actions may share it (semantics 2)."""

from collections.abc import Iterable

from serendipity.model import Condition, GroundAction

State = frozenset[int]


def holds(condition: Condition, state: State) -> bool:
    """Whether every literal is true."""
    return state.issuperset(condition.positive) and state.isdisjoint(condition.negative)


def usable(action: GroundAction, state: State) -> bool:
    """Whether every precondition holds (eq. 4)."""
    return state.issuperset(action.pre) and state.isdisjoint(action.neg)


def after(state: State, actions: Iterable[GroundAction]) -> State:
    """``(state - deletes) + adds``."""
    chosen = list(actions)
    deletes = {fact for action in chosen for fact in action.delete}
    adds = {fact for action in chosen for fact in action.add}
    return frozenset((state - deletes) | adds)


def compatible(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    """Whether two actions may share an epoch (eq. 5, 6, 10)."""
    if set(a.participants) & set(b.participants):
        return False
    if set(a.delete) & set(b.delete) or set(a.add) & set(b.delete) or set(a.delete) & set(b.add):
        return False
    if strict:
        for one, other in ((a, b), (b, a)):
            if set(one.delete) & set(other.pre) or set(one.add) & set(other.neg):
                return False
    return True
