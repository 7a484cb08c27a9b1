"""One epoch: conditions, effects and all applicable action sets (semantics 2)."""

from collections.abc import Iterable, Iterator

from serendipity.model import Condition, GroundAction, Task

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


def action_sets(
    task: Task, state: State, candidates: Iterable[int], *, strict: bool = False
) -> Iterator[tuple[int, ...]]:
    """Every set of ``candidates`` that is applicable in ``state``, the empty one included."""
    ready = [i for i in candidates if usable(task.actions[i], state)]

    def extend(chosen: tuple[int, ...], start: int) -> Iterator[tuple[int, ...]]:
        yield chosen
        for k in range(start, len(ready)):
            action = task.actions[ready[k]]
            if all(compatible(task.actions[i], action, strict=strict) for i in chosen):
                yield from extend((*chosen, ready[k]), k + 1)

    yield from extend((), 0)


def action_sets_of_names(task: Task, *, strict: bool = False) -> set[frozenset[str]]:
    """The action sets that are applicable initially, by name."""
    everything = range(len(task.actions))
    return {
        frozenset(task.actions[i].name for i in chosen)
        for chosen in action_sets(task, task.init, everything, strict=strict)
    }
