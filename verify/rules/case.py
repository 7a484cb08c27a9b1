"""One result under examination: what several rules look at, worked out once."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from serendipity.model import PlanError, Result, Task
from verify.base.execution import idling, price, shares
from verify.base.individual import IndividualOptimum
from verify.rules.replay import Replay, replay, replay_human


class RuleFault(NamedTuple):
    """What a rule found wrong; the registry adds the rule's name, claim and section."""

    message: str
    epoch: int | None = None
    action: str | None = None


@dataclass(frozen=True)
class CheckedResult:
    """A task, a result, and tables of the human alone.

    Properties that need a valid ``pi_H`` or an executable plan are only looked at by
    rules that come after those that check these.  What takes long polls the deadline of ``alone``.
    """

    task: Task
    result: Result
    alone: IndividualOptimum

    @cached_property
    def human_plan(self) -> tuple[int, ...] | PlanError | None:
        """``pi_H`` by ids; an error if it is no plan of the human's; None where none is reported."""
        if self.result.human_plan is None:
            return None
        try:
            return replay_human(self.task, self.result.human_plan, self.alone.deadline)
        except PlanError as error:
            return error

    @property
    def pi_h(self) -> tuple[int, ...]:
        """``pi_H``, empty where there is none."""
        plan = self.human_plan
        return plan if isinstance(plan, tuple) else ()

    @cached_property
    def human_cost(self) -> Fraction | None:
        """cost(pi_H)."""
        if not isinstance(self.human_plan, tuple):
            return None
        return sum((self.task.actions[i].cost for i in self.human_plan), Fraction(0))

    @property
    def improvable(self) -> bool:
        """Whether it is certain that ``pi_H`` costs more than an optimal plan of the human's."""
        optimum = self.alone.predicted()
        return self.human_cost is not None and optimum is not None and optimum[0] < self.human_cost

    @cached_property
    def replay(self) -> Replay:
        """The reported plan, executed."""
        steps, strict = self.result.plan or (), self.result.options.strict
        return replay(self.task, steps, self.alone.deadline, strict=strict)

    @property
    def epochs(self) -> int | None:
        """``T``, or None where it is infinite or absent."""
        return self.result.horizon if isinstance(self.result.horizon, int) else None

    @property
    def robots_goal(self) -> bool:
        """Whether robots have goals of their own in this mode."""
        return bool(self.task.robot_goal) and self.result.mode != "individual"

    @cached_property
    def cost(self) -> Fraction:
        """What the replayed plan costs the team."""
        return sum((self.price(i) for _, i in self.steps()), Fraction(0))

    @cached_property
    def talk(self) -> Fraction:
        """Communication cost (Def. 3.2), the weight included."""
        if self.result.mode != "communication":
            return Fraction(0)
        off_plan = (self.task.actions[i].cost for _, i in self.steps() if self.his(i) and not self.planned(i))
        return self.result.options.communication_weight * sum(off_plan, Fraction(0))

    def steps(self) -> Iterator[tuple[int, int]]:
        """(epoch, action id) of the replayed plan, in order; but for what happens anyway."""
        for epoch, chosen in self.alone.deadline.each(self.replay.sets.items()):
            for i in chosen:
                if i not in self.task.of_bystanders:
                    yield epoch, i

    def first(
        self, steps: Iterable[tuple[int, int]], wrong: Callable[[int], bool], message: str
    ) -> RuleFault | None:
        """What is wrong with the first of some steps with which something is; None if with none."""
        found = next(((epoch, i) for epoch, i in steps if wrong(i)), None)
        return None if found is None else RuleFault(message, found[0], self.name(found[1]))

    @cached_property
    def waiting(self) -> frozenset[int]:
        """The actions that are waiting, where the task takes place in time (semantics 10.2)."""
        return idling(self.task)

    def price(self, action: int) -> Fraction:
        """Cost to the team: undiscounted if the human takes part (semantics 1)."""
        return price(self.task, self.task.actions[action], self.result.options.discount)

    @property
    def shares(self) -> Mapping[str, Fraction]:
        """What each agent contributes, by name: a joint action's cost is shared equally."""
        return shares(self.task, (i for _, i in self.steps()), self.result.options.discount)

    def his(self, action: int) -> bool:
        """Whether the human takes part."""
        return self.task.human in self.task.actions[action].participants

    def own(self, action: int) -> bool:
        """Whether it is the human's alone."""
        return self.task.actions[action].participants == (self.task.human,)

    def planned(self, action: int) -> bool:
        """Whether it is in ``pi_H``, by its name, as variants of one action are the same; or is waiting."""
        return action in self.waiting or any(self.name(action) == self.name(i) for i in self.pi_h)

    def name(self, action: int) -> str:
        """An action's name."""
        return self.task.actions[action].name

    def human_does(self) -> dict[int, int]:
        """What the human does, by epoch; epochs in which they wait are absent."""
        return {epoch: i for epoch, i in self.steps() if self.his(i) and i not in self.waiting}
