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


def parts_of(action: GroundAction) -> tuple[GroundAction, ...]:
    """What an action asks and does in each of its epochs, as actions of one epoch."""
    timing = action.timing
    if timing is None:
        return (action,)

    def part(pre: set[int], neg: set[int], add: Iterable[int], delete: Iterable[int]) -> GroundAction:
        asked, refused = tuple(sorted(pre)), tuple(sorted(neg))
        return GroundAction(action.name, action.participants, asked, refused, tuple(add), tuple(delete))

    inside, last = timing.over_all, timing.at_end
    over, over_neg = set(inside.positive), set(inside.negative)
    middle = part(over, over_neg, (), ())
    return (
        part(set(action.pre), set(action.neg), timing.start_add, timing.start_delete),
        *[middle] * (timing.duration - 2),
        part(over | set(last.positive), over_neg | set(last.negative), action.add, action.delete),
    )
