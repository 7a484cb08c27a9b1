"""What the runs of one task have in common, so that it is worked out once."""

from collections.abc import Mapping
from random import Random
from typing import Any

from search import PreparedTask
from serendipity.execution.brain import Brain
from serendipity.execution.execution import Execution
from serendipity.execution.persons import Person
from serendipity.execution.policies import Policy
from serendipity.model.task.task import Task
from serendipity.robot import Adapter


class Again:
    """Executions of one task and people in them, one run after the other.

    Tables are kept: those of the person's, and those of the robots'.  Robots who have had time before the
    first epoch begin each run with the plan that they had then.  In another process it begins anew.

    Args:
        task: where each run begins.
        policy: who the person is.
        arguments: of :class:`Execution`.
    """

    def __init__(self, task: Task, policy: Policy, arguments: Mapping[str, Any]) -> None:
        self._task = task
        self._policy = policy
        self._arguments = dict(arguments)
        self._prepared = PreparedTask(task)
        self._ready: Brain | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        return Again, (self._task, self._policy, self._arguments)

    def person(self, dice: Random, *, drawn: bool) -> Person:
        """Somebody at the beginning; see :meth:`.policies.Policy.person`."""
        return self._policy.person(self._task, dice, drawn=drawn, prepared=self._prepared)

    def execution(self, adapter: Adapter | None) -> Execution:
        """An execution at the beginning."""
        if self._arguments.get("deadline") is None or self._arguments.get("goals") is not None:
            return Execution(self._task, adapter=adapter, **self._arguments)
        if self._ready is None:
            options = Execution(self._task, **{**self._arguments, "deadline": None}).options
            self._ready = Brain(
                self._task, options, None, 1, told=self._arguments["told"], surely=adapter is None
            )
            Execution(self._task, **{**self._arguments, "robots": self._ready})
        given = {**self._arguments, "setup": 0, "robots": self._ready.again()}
        return Execution(self._task, adapter=adapter, **given)
