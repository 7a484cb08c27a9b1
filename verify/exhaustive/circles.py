"""Actions that only work together: sets that may share an epoch, and in no order follow each other."""

from serendipity.model import Deadline, GroundAction, Task
from verify.base.execution import fits


def circles(actions: list[tuple[int, GroundAction]], task: Task, deadline: Deadline) -> list[tuple[int, ...]]:
    """Sets of actions that may share an epoch but in no order follow each other.

    Args:
        actions: candidates with their ids.
    """
    by_id = dict(actions)
    disables = _all_disabled(actions, deadline)
    found: set[tuple[int, ...]] = set()

    def extend(chosen: tuple[int, ...]) -> None:
        deadline.tick()
        if len(chosen) > 1 and _strongly_connected(chosen, disables):
            found.add(tuple(sorted(chosen)))
        if len(chosen) < len(task.agents):
            beside = [by_id[i] for i in chosen]
            for j in {j for i in chosen for j in disables[i]} - set(chosen):
                if fits(by_id[j], beside, strict=False):
                    extend((*chosen, j))

    for i, _ in actions:
        extend((i,))
    return sorted(found)


def _all_disabled(actions: list[tuple[int, GroundAction]], deadline: Deadline) -> dict[int, list[int]]:
    """For each action, those of which it falsifies a precondition."""
    needing: dict[int, set[int]] = {}
    forbidding: dict[int, set[int]] = {}
    for j, action in deadline.each(actions):
        for fact in action.pre:
            needing.setdefault(fact, set()).add(j)
        for fact in action.neg:
            forbidding.setdefault(fact, set()).add(j)
    found: dict[int, list[int]] = {}
    for i, action in deadline.each(actions):
        disabled: set[int] = set()
        for fact in action.delete:
            disabled |= needing.get(fact, set())
        for fact in action.add:
            disabled |= forbidding.get(fact, set())
        found[i] = sorted(disabled - {i})
    return found


def _strongly_connected(chosen: tuple[int, ...], disables: dict[int, list[int]]) -> bool:
    """Whether each of the actions leads to each other one along ``disables``."""
    members = set(chosen)
    for start in chosen:
        reached, pending = {start}, [start]
        while pending:
            for j in disables[pending.pop()]:
                if j in members and j not in reached:
                    reached.add(j)
                    pending.append(j)
        if reached != members:
            return False
    return True
