"""Shrinking: leave out whatever the disagreement does not need, first by halves, then one by one."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from time import monotonic
from typing import Final, TypeVar

from serendipity.model import Condition, GroundAction, Task
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.generator.tasks import unambiguous

T = TypeVar("T")

TIME_LIMIT: Final = 60.0
"""Seconds after which the smallest call so far is good enough."""


def shrink(
    call: PlanCall,
    disagrees: Callable[[PlanCall], bool],
    *,
    most: int = 2000,
    time_limit: float = TIME_LIMIT,
    on_try: Callable[[int], None] | None = None,
) -> PlanCall:
    """The smallest call reached by leaving out things while judges still differ.

    Args:
        call: a call on which ``disagrees`` is true.
        disagrees: whether the judges differ, in the same way.
        most: calls that are tried at most.
        time_limit: seconds after which no more are tried.
        on_try: called with the number of calls that were tried.
    """
    tries = _Tries(disagrees, most, time_limit, on_try)
    call = _without_actions(call, tries)
    call = _without_facts(call, tries)
    while (smaller := next(filter(tries.shows, _smaller(call)), None)) is not None:
        call = smaller
    return call


class _Tries:
    """Asks whether calls show it, too, as long as there is time."""

    def __init__(
        self,
        disagrees: Callable[[PlanCall], bool],
        most: int,
        time_limit: float,
        on_try: Callable[[int], None] | None,
    ) -> None:
        self._disagrees = disagrees
        self._most = most
        self._until = monotonic() + time_limit
        self._on_try = on_try
        self._tried = 0

    def shows(self, call: PlanCall) -> bool:
        """Whether a call shows it; none does where no time is left."""
        if self._tried >= self._most or monotonic() > self._until:
            return False
        self._tried += 1
        if self._on_try is not None:
            self._on_try(self._tried)
        return self._disagrees(call)


def _without_actions(call: PlanCall, tries: _Tries) -> PlanCall:
    def fewer(kept: Sequence[GroundAction]) -> PlanCall:
        return replace(call, task=replace(call.task, actions=tuple(kept)))

    return fewer(_by_halves(call.task.actions, fewer, tries))


def _without_facts(call: PlanCall, tries: _Tries) -> PlanCall:
    def fewer(kept: Sequence[int]) -> PlanCall:
        return replace(call, task=replace(call.task, init=frozenset(kept)))

    return fewer(_by_halves(sorted(call.task.init), fewer, tries))


def _by_halves(parts: Sequence[T], fewer: Callable[[Sequence[T]], PlanCall], tries: _Tries) -> list[T]:
    """The parts that have to stay: pieces are left out, half of all at first, then half as many ..."""
    kept, size = list(parts), len(parts) // 2
    while size:
        i = 0
        while i < len(kept):
            smaller = [*kept[:i], *kept[i + size :]]
            call = fewer(smaller)
            if unambiguous(call.task) and tries.shows(call):
                kept = smaller
            else:
                i += size
        size //= 2
    return kept


def _smaller(call: PlanCall) -> Iterator[PlanCall]:
    for name in call.options:
        if name != "mode":
            yield replace(call, options={key: value for key, value in call.options.items() if key != name})
    if call.human_plan is not None:
        yield replace(call, human_plan=None)
    for task in filter(unambiguous, _smaller_tasks(call.task)):
        yield replace(call, task=task)


def _smaller_tasks(task: Task) -> Iterator[Task]:
    for i in range(len(task.actions)):
        yield replace(task, actions=task.actions[:i] + task.actions[i + 1 :])
    for f in sorted(task.init):
        yield replace(task, init=task.init - {f})
    for goal in _smaller_conditions(task.goal):
        yield replace(task, goal=goal)
    for goal in _smaller_conditions(task.robot_goal):
        yield replace(task, robot_goal=goal)
    for i, action in enumerate(task.actions):
        variants = len(task.named[action.name]) > 1  # whose effects are those of one PDDL action
        for name in ("pre", "neg") if variants else ("pre", "neg", "add", "delete"):
            facts = getattr(action, name)
            for f in facts:
                less = replace(action, **{name: tuple(g for g in facts if g != f)})  # type: ignore[arg-type]
                if any((less.pre, less.neg, less.add, less.delete)):  # else it would be a noop
                    yield _with_action(task, i, less)
    for i, action in enumerate(task.actions):
        if action.cost not in (0, 1):
            yield _with_action(task, i, replace(action, cost=Fraction(1)))
    yield from _with_less_happening(task)
    yield from _without_idle_agents(task)


def _with_less_happening(task: Task) -> Iterator[Task]:
    """The task with less in its script, and without what a bystander wants."""
    script = task.script
    for k in range(len(script.deeds)):
        yield replace(task, script=replace(script, deeds=script.deeds[:k] + script.deeds[k + 1 :]))
    for k in range(len(script.facts)):
        yield replace(task, script=replace(script, facts=script.facts[:k] + script.facts[k + 1 :]))
    for k in range(len(task.own_goals)):
        yield replace(task, own_goals=task.own_goals[:k] + task.own_goals[k + 1 :])


def _with_action(task: Task, i: int, action: GroundAction) -> Task:
    return replace(task, actions=(*task.actions[:i], action, *task.actions[i + 1 :]))


def _without_idle_agents(task: Task) -> Iterator[Task]:
    """The task without somebody who does and can do nothing; one robot there has to be."""
    every = (*task.actions, *(action for deed in task.script.deeds for action in deed.variants))
    busy = {agent for action in every for agent in action.participants}
    idle = [*(task.robots if len(task.robots) > 1 else ()), *sorted(task.script.people)]
    yield from (_without(task, agent) for agent in idle if agent not in busy)


def _without(task: Task, gone: int) -> Task:
    """The task without an agent."""
    ids = {agent: agent - (agent > gone) for agent in range(len(task.agents)) if agent != gone}

    def moved(action: GroundAction) -> GroundAction:
        return replace(action, participants=tuple(ids[agent] for agent in action.participants))

    deeds = tuple(
        replace(deed, agent=ids[deed.agent], variants=tuple(map(moved, deed.variants)))
        for deed in task.script.deeds
    )
    people = frozenset(ids[agent] for agent in task.script.people if agent != gone)
    return replace(
        task,
        agents=tuple(task.agents[agent] for agent in ids),
        human=ids[task.human],
        actions=tuple(map(moved, task.actions)),
        own_goals=tuple((ids[agent], goal) for agent, goal in task.own_goals if agent != gone),
        script=replace(task.script, deeds=deeds, people=people),
    )


def _smaller_conditions(condition: Condition) -> Iterator[Condition]:
    for f in condition.positive:
        yield Condition(tuple(g for g in condition.positive if g != f), condition.negative)
    for f in condition.negative:
        yield Condition(condition.positive, tuple(g for g in condition.negative if g != f))
