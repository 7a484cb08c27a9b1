"""Which actions and facts can matter at all: reachable from ``I``, relevant for what is asked.

Both tests keep at least one optimal plan of the question: an unreachable action occurs in
no plan, and an action that changes no relevant fact can be left out of any plan without
making a precondition, a goal or another action's applicability false.
"""

from collections.abc import Collection, Iterable, Sequence, Set
from dataclasses import dataclass, replace

from serendipity.model import Deadline, Task
from verify.base.execution import awake, grouped, is_last
from verify.base.subproblem import Subproblem


@dataclass(frozen=True, slots=True)
class Relevant:
    """The part of a task that matters for a question.

    Attributes:
        actions: ids of the actions, ascending.
        facts: the facts whose truth matters and can change.
        pre: for each task action, the facts in ``facts`` that must be true (empty if not kept).
        neg: the same for those that must be false.
    """

    actions: tuple[int, ...]
    facts: frozenset[int]
    pre: dict[int, tuple[int, ...]]
    neg: dict[int, tuple[int, ...]]

    def only(self, actions: Set[int]) -> "Relevant":
        """The same with some of the actions."""
        return replace(self, actions=tuple(i for i in self.actions if i in actions))


def relevant_part(question: Subproblem, extra: Iterable[int] = ()) -> Relevant | None:
    """Reduce a question's task; None if a goal can't be reached even without deletes.

    Args:
        extra: further facts whose truth matters (the states of ``preservation = state``).
    """
    task, deadline = question.task, question.deadline
    true, false, usable = _reachable(task, question.allowed(), deadline)
    positive, negative = set(question.goal.positive), set(question.goal.negative)
    if not positive <= true or not negative <= false:
        return None
    forced = [i for i in question.human_plan if i in usable]
    seeds = (positive - set(task.at_rest)) | negative | set(extra)
    # Nobody disturbs a bystander: what they need matters, and when they begin.
    forced += [i for i in task.of_bystanders if i in usable and not is_last(task.actions[i])]
    seeds.update(fact for fact, i in task.due if i in task.of_bystanders and not is_last(task.actions[i]))
    if awake(task):  # where waiting costs, anything that the human does may be cheaper
        forced += [i for i in usable if task.human in task.actions[i].participants]
    for i in forced:
        seeds.update(task.actions[i].pre, task.actions[i].neg)
    changing = true & false
    kept, facts = closure(task, usable, seeds & changing, changing, deadline)
    kept |= set(forced)
    return _kept(task, sorted(kept), facts, deadline)


def whole_task(question: Subproblem) -> Relevant:
    """All of a question's task, where :func:`relevant_part` leaves nothing to ask."""
    task = question.task
    return _kept(task, question.allowed(), range(len(task.facts)), question.deadline)


def _kept(task: Task, actions: Sequence[int], facts: Collection[int], deadline: Deadline) -> Relevant:
    return Relevant(
        tuple(actions),
        frozenset(facts),
        {i: tuple(f for f in task.actions[i].pre if f in facts) for i in deadline.each(actions)},
        {i: tuple(f for f in task.actions[i].neg if f in facts) for i in deadline.each(actions)},
    )


def _reachable(task: Task, allowed: Sequence[int], deadline: Deadline) -> tuple[set[int], set[int], set[int]]:
    """Facts that may become true, facts that may become false, actions that may become applicable."""
    true, false = set(task.init), set(range(len(task.facts))) - task.init
    usable: set[int] = set()
    missing: dict[int, int] = {}
    for_true: dict[int, list[int]] = {}
    for_false: dict[int, list[int]] = {}
    ready: list[int] = []
    for i in deadline.each(allowed):
        lacking = [(for_true, f) for f in task.actions[i].pre if f not in true]
        lacking += [(for_false, f) for f in task.actions[i].neg if f not in false]
        for waiting, f in lacking:
            waiting.setdefault(f, []).append(i)
        missing[i] = len(lacking)
        if not lacking:
            ready.append(i)
    while ready:
        deadline.tick()
        i = ready.pop()
        usable.add(i)
        new = [j for f in task.actions[i].add if f not in true for j in for_true.get(f, ())]
        new += [j for f in task.actions[i].delete if f not in false for j in for_false.get(f, ())]
        true.update(task.actions[i].add)
        false.update(task.actions[i].delete)
        for j in new:
            missing[j] -= 1
            if not missing[j]:
                ready.append(j)
    return true, false, usable


def closure(
    task: Task, usable: Iterable[int], seeds: set[int], changing: set[int], deadline: Deadline
) -> tuple[set[int], set[int]]:
    """Facts that matter for the seeds, and the actions that change one of them; what is begun goes on."""
    actions, due = task.actions, task.due_for
    changers = grouped((f, i) for i in deadline.each(usable) for f in (*actions[i].add, *actions[i].delete))
    kept: set[int] = set()
    facts, pending = set(seeds), list(seeds)
    while pending:
        for i in deadline.each(changers.get(pending.pop(), ())):
            if i in kept:
                continue
            kept.add(i)
            going_on = (f for f in actions[i].add if f in due) if due else ()
            for f in (*actions[i].pre, *actions[i].neg, *going_on):
                if f in changing and f not in facts:
                    facts.add(f)
                    pending.append(f)
    return kept, facts
