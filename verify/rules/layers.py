"""A task that allows nothing but what rules of help do (semantics 12 to 14)."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from serendipity.model import Condition, Deadline, HumanPlan, Options, Task
from serendipity.model.task.disturbance import DisturbanceTask, disturbance_from
from serendipity.model.task.metered import Metered
from serendipity.model.task.noticed import Noticed
from serendipity.model.task.protected import protected


class Layers:
    """The task, with some layers on it.

    Args:
        plan: the human's.
        most: that they may pay; None: anything.

    Attributes:
        original: by action that of the task that was given.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        plan: HumanPlan | None,
        most: Fraction | None,
        original: Task,
        deadline: Deadline,
    ) -> None:
        self.original: Sequence[int] = range(len(task.actions))
        if options.noticed and plan is not None:
            noticed = Noticed(task, plan, original)
            task = self._under(noticed.task, noticed.back)
        self._paid = None if most is None else Metered(task, most, deadline)
        if self._paid is not None:
            task = self._under(self._paid.task, self._paid.back)
        if options.max_disturbance is not None:
            weighed = DisturbanceTask(task, disturbance_from(options.disturbance), original)
            calm = Metered(weighed.task, options.max_disturbance, deadline, weighed.weights, "disturbed")
            task = self._under(calm.task, lambda ids: [weighed.original[i] for i in calm.back(ids)])
        self.task = protected(task, options, len(original.facts))

    def _under(self, task: Task, back: Callable[[Sequence[int]], Sequence[int]]) -> Task:
        self.original = [self.original[i] for i in back(range(len(task.actions)))]
        return task

    def goal(self, goal: Condition, most: Fraction | None) -> Condition:
        """A goal with which they have paid no more than so much."""
        return goal if self._paid is None or most is None else self._paid.goal(goal, most)
