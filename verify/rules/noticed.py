"""Whether the human notices what a plan has them leave their own for (semantics 14).

It follows the plan epoch by epoch, with the facts that robots have changed and the human has not seen since.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from serendipity.model import Deadline, GroundAction, HumanPlan, Result, Task
from serendipity.model.task.unit_steps import asked_of
from serendipity.model.task.visibility import Surroundings, surroundings
from verify.base import wording
from verify.base.execution import State, idling, unchosen
from verify.rules.replay import Replay, replay


def unnoticed(
    task: Task, result: Result, plan: HumanPlan | None, original: Task, deadline: Deadline
) -> str | None:
    """What the human leaves their plan for without having noticed it, in words; None if nothing.

    A plan that can't be executed is none of this rule's.
    """
    if not result.options.noticed or plan is None or result.plan is None:
        return None
    found = replay(task, result.plan, deadline, strict=False)
    if found.fault is not None:
        return None
    begun = [task.actions[i].name for i in plan if i not in unchosen(task)]
    watch = _Watch(task, begun, surroundings(original))
    for what in watch.asked(found):
        return wording.UNNOTICED.format(task.facts[what])
    return None


@dataclass
class _Watch:
    """What the human saw of a plan.

    Attributes:
        steps: names of the steps of the human's plan that are left.
        hidden: facts that robots have changed, and the human has not seen since.
    """

    task: Task
    steps: Sequence[str]
    around: Surroundings
    hidden: set[int] = field(default_factory=set)
    left: bool = False

    def asked(self, found: Replay) -> Iterator[int]:
        """Facts that the human would have had to notice, as the plan unfolds."""
        for epoch in sorted(found.sets):
            before, after = found.state_after(epoch - 1), found.state_after(epoch)
            his, others = None, list[GroundAction]()
            for i in found.sets[epoch]:
                if self.task.human in self.task.actions[i].participants:
                    his = None if i in idling(self.task) else i
                elif i not in self.task.of_bystanders:
                    others.append(self.task.actions[i])
            yield from self._epoch(before, after, his, others)
        yield from (fact for fact in self._wanted() if fact in self.hidden)

    def _epoch(
        self, before: State, after: State, number: int | None, others: Iterable[GroundAction]
    ) -> Iterator[int]:
        looks, his = not self.left, None if number is None else self.task.actions[number]
        if looks:
            self.hidden = {fact for fact in self.hidden if not self._sees(fact, before)}
        if his is not None and number not in self.going_on:
            planned = looks and bool(self.steps) and self.steps[0] == his.name and not his.joint
            self.left = not planned
            self.steps = self.steps[1:] if planned else self.steps
        arrives = his is not None and not self.left
        if number is not None and his is not None and self.left and not his.joint:
            yield from (fact for fact in self._asks(number) if fact in self.hidden)
        goals = {f for f in self._wanted() if arrives and self._sees(f, after) and not self._sees(f, before)}
        own = set() if his is None else {*his.add, *his.delete}
        news = {fact for other in others for fact in (*other.add, *other.delete) if fact in self.matters}
        if looks:
            news = {fact for fact in news if not self._sees(fact, before)}
        yield from news & (own | goals)
        self.hidden = (self.hidden | news) - own - goals

    def _wanted(self) -> set[int]:
        wanted = {*self.task.goal.positive, *self.task.goal.negative}
        return wanted.intersection(range(len(self.around.parts)))

    @cached_property
    def going_on(self) -> frozenset[int]:
        """What goes on whatever is chosen."""
        return frozenset(i for _, i in self.task.due)

    @cached_property
    def matters(self) -> set[int]:
        """The facts that the human's own actions, or their goal, ask for."""
        own = {fact for i in self.task.human_actions for fact in self._asks(i)}
        return self._wanted() | own.intersection(range(len(self.around.parts)))

    def _asks(self, number: int) -> set[int]:
        action = self.task.actions[number]
        return asked_of(self.task, action) if number in self.going_on else {*action.pre, *action.neg}

    def _sees(self, fact: int, state: State) -> bool:
        """Whether a fact is about the human, or their place; without places all are seen."""
        name, parts = self.task.agents[self.task.human], self.around.parts[fact]
        places = {f: at for f, (who, at) in self.around.located.items() if who == name}
        return not places or name in parts or any(at in parts for f, at in places.items() if f in state)
