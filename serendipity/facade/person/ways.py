"""What the person pays alone from where things stand, in time; kept, as moments are looked at often."""

from collections.abc import Hashable
from fractions import Fraction
from itertools import islice
from random import Random
from typing import Final, NamedTuple

from search import PreparedTask, optimal_plans_in_time
from serendipity.facade.planning import planned
from serendipity.model import Condition, Deadline, HumanPlan, Options, Task
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.actions import NOOP
from serendipity.model.task.plans_in_time import cost_alone, times_of
from serendipity.model.task.script import Deed, TimedFact
from serendipity.model.task.unit_steps import unit_steps

_MOST: Final = 4_096
"""Moments that are remembered."""

_DRAWN: Final = 100
"""Of so many optimal plans one is drawn."""


Entries = tuple[tuple[int, str], ...]
"""What somebody means to begin, and in which epochs from now: by names, which hold where ids are others.

A last ``noop`` says until when they wait for what comes by itself.
"""


class Way(NamedTuple):
    """What the person begins alone, and in which epochs from now, and what it costs."""

    plan: Entries
    cost: Fraction


def entries_of(task: Task, plan: HumanPlan) -> Entries:
    """A plan by names, with its epochs."""
    names = [task.actions[i].name for i in plan]
    return tuple(times_of(task, plan).timed(names))


def begun_in(entries: Entries) -> Entries:
    """The same without waiting."""
    return tuple((epoch, name) for epoch, name in entries if name != NOOP)


class Ways:
    """The person's optimal plans alone, beside what goes on and the script.

    Args:
        options: which actions may share an epoch, and what waiting costs.
    """

    def __init__(self, options: Options) -> None:
        self._options = Options(
            mode="individual", interference=options.interference, waiting_cost=options.waiting_cost
        )
        self._known: dict[Hashable, Way | None] = {}

    def of(self, now: Task, deadline: Deadline) -> Way | None:
        """The canonical one; None where they have no plan.

        Raises:
            LimitReachedError: the deadline came first.
        """
        key: tuple[frozenset[int], tuple[TimedFact, ...], tuple[Deed, ...]]
        key = now.init, now.script.facts, now.script.deeds
        if key not in self._known:
            found = self._found(now, deadline)
            if len(self._known) >= _MOST:
                self._known.clear()
            self._known[key] = found
        return self._known[key]

    def _found(self, now: Task, deadline: Deadline) -> Way | None:
        asked = PreparedTask(now.with_goal(now.goal, Condition()))  # robots' own goals are theirs
        answer = planned(
            asked,
            None,
            None,
            mode="individual",
            interference=self._options.interference,
            waiting_cost=self._options.waiting_cost,
            deadline=deadline,
        )
        if answer.status not in ("optimal", "infeasible"):
            raise LimitReachedError("time-limit")
        if answer.human_plan is None or answer.human_entries is None:
            return None
        plan = now.plan_from_names(answer.human_entries)
        return Way(entries_of(now, plan), self.price(now, plan))

    def price(self, now: Task, plan: HumanPlan) -> Fraction:
        """What a plan costs from where things stand, the waiting that is still to come included."""
        return cost_alone(now, plan, self._options.waiting_cost)

    def drawn(self, now: Task, dice: Random) -> HumanPlan:
        """One of their optimal plans, of which there are some."""
        units = unit_steps(now)
        found = optimal_plans_in_time(PreparedTask(units.task), Deadline(), self._options)
        return dice.choice([units.begun(plan) for plan in islice(found, _DRAWN)])
