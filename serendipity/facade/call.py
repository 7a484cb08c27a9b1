"""One planning call: what is asked, checked in one place before anything is planned."""

import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from search import PreparedTask, WarmStart
from serendipity.model import Deadline, HumanPlan, Options, Task, UsageError, Visible
from serendipity.model.answers.answer import Answer
from serendipity.model.resources.limits import limits_from

if TYPE_CHECKING:  # only who asks again remembers
    from serendipity.facade.memory import RememberedQuestion

_ANSWER_SHARE: Final = 0.05
"""The share of the time limit that is kept for the end: dropping what the search has made takes time, too."""


class Request(NamedTuple):
    """One planning call, its options checked.

    Attributes:
        prepared: the task.
        options: in force.
        given: ``pi_H`` where the caller gave it; None predicts it.
        predicts: False: the human is known to have no plan alone, where none is given.
        optimum: what a given plan costs that is not to be improved on; None for what an optimal one costs.
        original: the task as it was given, where that of the call is in single epochs.
        visible: what a human of ``human_model="local"`` sees; None for the default.
        limits: of the whole call.
        deadline: of the search: the same without the time that is kept for the end.
        question: what it asks, where somebody remembers answers; or None.
        start: a plan and a bound that its search begins with, instead of those that are remembered.
    """

    prepared: PreparedTask
    options: Options
    given: HumanPlan | None
    visible: Visible | None
    limits: Deadline
    deadline: Deadline
    question: "RememberedQuestion | None" = None
    predicts: bool = True
    optimum: Fraction | None = None
    original: Task | None = None
    start: WarmStart | None = None

    @property
    def task(self) -> Task:
        """The task."""
        return self.prepared.task

    @property
    def known(self) -> Answer | None:
        """The answer, where it is known and proved."""
        return None if self.question is None else self.question.proved

    @property
    def warm(self) -> WarmStart | None:
        """The warm start of its search, or None."""
        return self.start or (None if self.question is None else self.question.warm)


Given = Callable[[int], HumanPlan] | None
"""The plan of the human, replayed when it is asked for behind a head start; None to predict it."""

Solver = Callable[[Request], Iterator[Answer]]
"""Answers to a call, each better than the one before or better proved; the last one is the best known."""


def options_from(given: Mapping[str, Any]) -> Options:
    """Options from keyword arguments.

    Raises:
        UsageError: an option is unknown or has no legal value.
    """
    known = [field.name for field in fields(Options)]
    for name in given:
        if name not in known:
            raise UsageError(f"unknown option '{name}': expected one of {', '.join(known)}")
    return Options(**given)


def checked_call(
    prepared: PreparedTask,
    options: Options,
    given: Given,
    visible: Visible | None,
    cancelled: threading.Event | None,
    outer: Deadline | None,
) -> Request:
    """The call that keyword arguments of :func:`serendipity.plan` ask for; its time starts now.

    Raises:
        UsageError: something that plays no part in the mode, or a task that the mode is not for.
        PlanError: the human's plan can't be executed, or misses the goal.
    """
    if visible is not None and options.human_model != "local":
        raise UsageError(f"visible: is for human_model 'local' only, not for '{options.human_model}'")
    limits = limits_from(options.time_limit, options.memory_limit, outer, cancelled)
    human_plan = None if given is None else given(options.head_start)
    if options.mode == "assistance":
        if human_plan is not None:
            raise UsageError("human_plan: in mode 'assistance' the human chooses anew in each round")
        robots = len(prepared.task.robots)
        if robots != 1:
            raise UsageError(f"mode: 'assistance' is for one robot, the task has {robots}")
    elif human_plan is not None:
        options = options.but(ties="fixed")  # there is but one plan
    return Request(prepared, options, human_plan, visible, limits, limits.sooner(_ANSWER_SHARE))
