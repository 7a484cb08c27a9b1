"""Planning calls that explanations rest on, and exact accounts of their answers."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any, Final

from serendipity.facade.planning import plan
from serendipity.model import Deadline, LimitReachedError, Options, Result, Task
from serendipity.model.task.task import canonical_name

PROVED: Final = ("optimal", "infeasible")
"""The statuses of answers that say how things are."""


class Ask:
    """Repeats one planning call with some options changed; equal calls are made once.

    Args:
        options: of the call that is explained.
        human_plan: names of ``pi_H``, or None to predict it.
    """

    def __init__(
        self, task: Task, options: Options, human_plan: Sequence[str] | None, deadline: Deadline
    ) -> None:
        self.task = task
        self.options = options
        self.human_plan = human_plan
        self.deadline = deadline
        self._answers: dict[Options, Result] = {}

    def __call__(self, **changes: Any) -> Result:
        """The proved answer under changed options.

        Raises:
            LimitReachedError: the limit came before the proof.
        """
        answer = self.attempt(**changes)
        if answer.status not in PROVED:
            raise LimitReachedError(self.limit_of(answer))
        return answer

    def attempt(self, **changes: Any) -> Result:
        """The answer under changed options, proved or as far as the limit allows."""
        options = self.options.but(**changes)
        answer = self._answers.get(options)
        if answer is None:
            keywords = {field.name: getattr(options, field.name) for field in fields(options)}
            answer = plan(self.task, human_plan=self.human_plan, deadline=self.deadline, **keywords)
            self._answers[options] = answer
        return answer

    def limit_of(self, answer: Result) -> str:
        """Which limit kept an answer from being proved, as ``Result.reason`` has it."""
        if answer.reason is not None:
            return answer.reason
        # A call ends a little before its limit, and gives back what it took.
        likely = "memory-limit" if self.deadline.left() is None else "time-limit"
        return self.deadline.reached() or likely


@dataclass(frozen=True, slots=True)
class Parts:
    """What a composite plan costs, as a function of the discount.

    Attributes:
        human: undiscounted cost of what the human takes part in.
        robots: undiscounted cost of everything else.
        announced: communication cost.
        length: epochs of the window, 0 without one.
    """

    human: Fraction
    robots: Fraction
    announced: Fraction
    length: int

    def discounted(self, options: Options) -> Fraction:
        """What the robots' part costs."""
        return (1 - options.discount) * self.robots

    def objective(self, options: Options) -> Fraction:
        """Cost, communication and window (semantics 3.1, 3.4)."""
        return self.human + self.discounted(options) + self.announced + options.window_weight * self.length


def parts_of(task: Task, result: Result) -> Parts:
    """The parts of an answer's plan, exact whatever its discount."""
    former = set(result.human_plan or ())
    human = robots = announced = Fraction(0)
    for step in result.plan or ():
        cost = cost_of(task, step.action)
        if result.human not in step.agents:
            robots += cost
            continue
        human += cost
        if step.action not in former and result.options.mode == "communication":
            announced += cost * result.options.communication_weight
    return Parts(human, robots, announced, 0 if result.window is None else len(result.window))


def cost_of(task: Task, name: str) -> Fraction:
    """The undiscounted cost of the action of that name."""
    return task.actions[task.named[canonical_name(name)][0]].cost
