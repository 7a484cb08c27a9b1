"""Times of a plan's actions where there are no epochs: PDDL 2.1 as unified-planning reads it.

There nothing may rely at one time on what changes at that time, so a little time passes between an effect and
what needs it.  When actions begin is a simple temporal network (Dechter, Meiri and Pearl 1991) over what has
to come before what; each begins as early as it can, and not before its epoch does.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Final

from unified_planning.model.delta_stn import DeltaSimpleTemporalNetwork

from serendipity.model import GroundAction, PlanError, PlanStep, Task
from serendipity.model.task.actions import State, disables
from serendipity.model.task.course import BrokenPlanError, PlayedPlan

_Facts = frozenset[int]

_ZERO: Final = "zero"
"""The time at which the first epoch begins; other times are those of steps, by their indices."""


@dataclass(frozen=True, slots=True)
class Event:
    """A start or an end of an action of a plan.

    Attributes:
        offset: the time from its start.
        epoch: with which it comes.
        action: what takes effect, with what has to hold before it.
        asked: the facts that have to be as they are, before or from now on.
        missing: facts that are not yet as they have to be from now on.
    """

    step: int
    offset: Fraction
    epoch: int
    action: GroundAction
    asked: _Facts
    missing: _Facts = frozenset()

    @property
    def changed(self) -> _Facts:
        """The facts that it makes true or false."""
        return frozenset((*self.action.add, *self.action.delete))


def start_times(task: Task, steps: Sequence[PlanStep], lasting: Sequence[bool]) -> list[Fraction]:
    """The time at which each action of a plan begins, from 0, in the unit of durations.

    Args:
        lasting: of each step, whether it takes time, or is done at once.

    Raises:
        PlanError: it is no plan, or one in epochs only, where all effects of an epoch come together.
    """
    events = _played(task, steps, lasting)
    pause = task.epoch / 10 ** len(str(100 * (len(steps) + 1)))
    network: DeltaSimpleTemporalNetwork[Fraction] = DeltaSimpleTemporalNetwork()
    for number, step in enumerate(steps):
        network.insert_interval(_ZERO, number, left_bound=(step.epoch - 1) * task.epoch)
    for fact in task.script.facts:
        at = fact.epoch * task.epoch
        for event in events:
            if fact.fact in event.asked | event.changed:
                if event.epoch > fact.epoch:
                    network.insert_interval(_ZERO, event.step, left_bound=at + pause - event.offset)
                elif fact.fact in event.missing and event.epoch == fact.epoch:
                    network.insert_interval(_ZERO, event.step, left_bound=at - event.offset)
                else:
                    apart = pause * (fact.fact in event.changed)
                    network.insert_interval(_ZERO, event.step, right_bound=at - event.offset - apart)
    for first, second, is_apart in _orders(events):
        gap = first.offset - second.offset + pause * is_apart
        network.insert_interval(first.step, second.step, left_bound=gap)
    if not network.check_stn():
        words = ", ".join(f"'{step.action}'" for step in steps[:3]) + ", ..." * (len(steps) > 3)
        raise PlanError(f"{words}: can be done in epochs only, and no plan of unified-planning says so")
    return [network.get_stn_model(number) for number in range(len(steps))]


def _played(task: Task, steps: Sequence[PlanStep], lasting: Sequence[bool]) -> list[Event]:
    """The starts and ends of a plan that reaches the goals, which last."""
    course = PlayedPlan(task.facts, task.init, task.script)
    events: list[Event] = []
    by_epoch: dict[int, list[int]] = {}
    for number, step in enumerate(steps):
        by_epoch.setdefault(step.epoch, []).append(number)
    last = max(task.script.last, *by_epoch, 0)
    while course.epoch < last or any(course.under_way()):
        epoch, begun = course.epoch + 1, []
        for number in by_epoch.pop(epoch, ()):
            action = variant_in(task, steps[number], course.state)
            begun.append(action)
            takes = action.duration * task.epoch if lasting[number] else Fraction(0)
            events += _events(number, epoch, action, takes, course.state)
        try:
            course.begin(begun)
        except BrokenPlanError as error:
            raise PlanError(f"epoch {epoch}: {error}") from None
    if not (task.goal.holds(course.state) and task.robot_goal.holds(course.state)):
        raise PlanError("the goal does not hold once all timed effects have come")
    return events


def variant_in(task: Task, step: PlanStep, state: State) -> GroundAction:
    """The first applicable action that a step means in a state, or a PlanError."""
    ids = task.named.get(step.action, ())
    for i in ids:
        if task.actions[i].applicable(state):
            return task.actions[i]
    what = "applicable" if ids else "an action of the problem"
    raise PlanError(f"epoch {step.epoch}: '{step.action}' is not {what}")


def _events(step: int, epoch: int, action: GroundAction, takes: Fraction, state: State) -> Iterator[Event]:
    asked = frozenset((*action.pre, *action.neg))
    timing = action.timing
    if timing is None:  # of what takes one epoch some effects may come at its start, and some at its end
        for offset in {Fraction(0), takes}:
            yield Event(step, offset, epoch, action, asked)
        return
    start, end = action.moments
    inside = timing.over_all
    missing = {f for f in inside.positive if f not in state and f not in timing.start_add}
    missing |= {f for f in inside.negative if f in state and f not in timing.start_delete}
    asked |= {*inside.positive, *inside.negative}
    yield Event(step, Fraction(0), epoch, start, asked, frozenset(missing))
    last = epoch + action.duration - 1
    yield Event(step, takes, last, end, frozenset((*end.pre, *end.neg)))


def _orders(events: Sequence[Event]) -> Iterator[tuple[Event, Event, bool]]:
    """Events that come one before the other; False where they may come at the same time."""
    for a, b in combinations(sorted(events, key=lambda event: (event.epoch, event.offset, event.step)), 2):
        if a.step == b.step:
            continue
        both = a.changed & b.changed
        if a.epoch < b.epoch:
            shared = set(a.action.participants).intersection(b.action.participants)
            if shared or both or a.changed & b.asked or b.changed & a.asked:
                yield a, b, True
            continue
        for one, other in ((a, b), (b, a)):
            if one.changed & other.missing:
                yield one, other, True
            elif disables(one.action, other.action):  # which is asked before the epoch
                yield other, one, False
        if both:
            yield a, b, True
