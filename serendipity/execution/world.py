"""The world as it truly is: whose actions take place in an epoch, and what comes of them (semantics 2, 6)."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from serendipity.model import PlanStep, Task, UsageError
from serendipity.model.task.actions import apply, conflicting, fitted
from serendipity.model.task.execution import actions_named, variant_named
from serendipity.model.task.facts import Facts
from serendipity.model.task.task import canonical_name
from serendipity.robot import Outcome

WHY: Final = {
    "inapplicable": "its preconditions do not hold",
    "conflict": "it gets in the way of another action",
    "refused": "the person did something else",
    "failed": "the robot did not manage",
    "running": "it takes longer",
    "broken": "it could not go on",
}
"""Why something that robots meant to do did not take place, in words."""


@dataclass(frozen=True, slots=True)
class Unfinished:
    """Something that robots meant to do and that did not take place: which, and a key of ``WHY``."""

    step: PlanStep
    why: str

    def to_dict(self) -> dict[str, Any]:
        """The JSON object: the step, and why."""
        return {**self.step.to_dict(), "why": self.why}


@dataclass(frozen=True, slots=True)
class Happened:
    """What took place in an epoch, by action ids.

    Attributes:
        executed: the human's action first, if any; in time what began.
        unfinished: what robots meant to do and did not; in time also what was broken off.
        going: in time, what had begun before and went on.
    """

    executed: tuple[int, ...]
    unfinished: tuple[Unfinished, ...]
    going: tuple[PlanStep, ...] = ()


class World:
    """A task's true state, which actions change.

    Args:
        discount: of robots' costs.
        strict: whether interference is strict.

    Attributes:
        state: ids of the facts that are true.
    """

    def __init__(self, task: Task, discount: Fraction, *, strict: bool) -> None:
        self.task = task
        self.state = task.init
        self._discount = discount
        self._strict = strict

    @property
    def now(self) -> Task:
        """The task as it stands."""
        return self.task.at(self.state)

    @property
    def going(self) -> tuple[PlanStep, ...]:
        """What has begun and goes on: nothing, unless in time."""
        return ()

    def his(self, name: str) -> int:
        """The human's own action of that name, in the variant that is applicable where one is.

        Raises:
            UsageError: the human has no such action alone.
        """
        human = self.task.agents[self.task.human]
        if not actions_named(self.task, canonical_name(name), [human]):
            raise UsageError(f"there is no action '{name}' that {human} can do alone")
        return variant_named(self.task, canonical_name(name), [human], self.state)

    def of(self, step: PlanStep) -> int:
        """The action of a step, in the variant that is applicable where one is."""
        return variant_named(self.task, step.action, step.agents, self.state)

    def applicable(self, action: int) -> bool:
        """Whether an action is possible now."""
        return self.task.actions[action].applicable(self.state)

    def play(
        self,
        his: int | None,
        robots: Sequence[PlanStep],
        carry_out: Callable[[Sequence[PlanStep]], Sequence[Outcome]],
    ) -> Happened:
        """One epoch: what can take place does; the human has priority, then robots in the given order.

        Args:
            his: what the human does, an action that is applicable; None: they wait.
            robots: what robots mean to do without the human, or, where ``his`` is it, with them.
            carry_out: what robots make of those actions that are possible.
        """
        taken = [] if his is None else [his]
        obstacles: list[str | None] = []
        for step in robots:
            action = self.of(step)
            obstacles.append(self._obstacle(action, taken))
            if obstacles[-1] is None:
                taken.append(action)
        possible = (step for step, why in zip(robots, obstacles, strict=True) if why is None)
        outcomes = iter(carry_out(tuple(possible)))
        whys = [why or next(outcomes) for why in obstacles]
        meant = list(zip(robots, whys, strict=True))
        executed = [] if his is None else [his]
        executed += [self.of(step) for step, why in meant if why == "done"]
        self.state = self.after(executed)
        return Happened(tuple(executed), tuple(Unfinished(step, why) for step, why in meant if why != "done"))

    def after(self, actions: Iterable[int]) -> frozenset[int]:
        """The state that some actions would lead to from here."""
        return apply(self.state, *(self.task.actions[i] for i in actions))

    def change(self, facts: Iterable[tuple[str, bool]]) -> None:
        """Set facts to true or false, as somebody has seen them.

        Raises:
            UsageError: there is no such fact.
        """
        self.state = fitted(Facts(self.task.facts).seen(self.state, facts), self.task.disjunctions)

    def drop(self, robots: Iterable[int]) -> None:
        """Robots, by agent ids, are out of order, and what they are at is broken off."""

    def cost(self, actions: Iterable[int]) -> tuple[Fraction, Fraction]:
        """What actions cost the human, undiscounted, and the team."""
        chosen = [self.task.actions[i] for i in actions]
        own = sum((a.cost for a in chosen if self.task.human in a.participants), Fraction(0))
        return own, sum((self.task.team_cost(a, self._discount) for a in chosen), Fraction(0))

    def changes(self, before: frozenset[int]) -> tuple[str, ...]:
        """What has changed since a state: names of facts, ``!`` in front of those that are false now."""
        changed = [(self.task.facts[f], f in self.state) for f in before ^ self.state]
        return tuple(name if true else f"!{name}" for name, true in sorted(changed))

    def _obstacle(self, action: int, executed: Sequence[int]) -> str | None:
        if not self.applicable(action):
            return "inapplicable"
        first, others = self.task.actions[action], (self.task.actions[i] for i in executed)
        return "conflict" if any(conflicting(first, o, strict=self._strict) for o in others) else None
