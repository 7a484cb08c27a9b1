"""That no window of one epoch helps: robots one by one, and then the human alone.

Where one more epoch of the window costs more than is asked about, windows have one epoch.  Before it the
human follows ``pi_H``, after it they are alone; so robots can only leave something behind.  What each of
them can have made of the world by then, at what cost, its own :class:`.timeline.RobotTimeline` says; put
together, this is all that robots can leave behind, and more.  What the human does in the window they can as
well do after it, once robots have done what they do in it: none of that takes away what the human's action
needs, which is looked at first.  So the human pays from there on at least what they have to pay alone,
without epochs.  If that and what was paid before is never within the limit, there is no such plan.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from serendipity.model import Deadline
from serendipity.model.errors import LIMITS
from verify.base.execution import conflicting, states_along
from verify.base.relevance import Relevant, closure, relevant_part
from verify.base.subproblem import Subproblem
from verify.base.undecided import during, why
from verify.exhaustive.decoupled.leavings import differences, together
from verify.exhaustive.decoupled.timeline import RobotTimeline, parts
from verify.exhaustive.team_problem import all_disabled, as_operator, team_space
from verify.limits import limits
from verify.packed.cheapest_path import TooManyPackedStatesError
from verify.packed.layout import Ints, PackedLayout, Words
from verify.packed.problem import PackedProblem, StateSpace, TooLargeError
from verify.programs.effort import Minimum


def is_short(question: Subproblem) -> bool:
    """Whether plans within the limits have a window of one epoch, after which the human replans."""
    most = question.most
    return (
        question.has_plain_windows
        and question.robots
        and most is not None
        and most < 2 * question.prices.epoch
        and not any(question.prices.talk)
        and all(len(action.participants) == 1 for action in question.deadline.each(question.task.actions))
    )


def no_short_window(question: Subproblem) -> Minimum:
    """Whether no plan is within the question's limits.

    Args:
        question: one of :func:`is_short`.

    Returns:
        ``none``, or ``undecided``: this method finds no plans.
    """
    search = _Search(question)
    try:
        with during("looking at robots one by one"):
            reason = search.run()
    except LIMITS as limit:
        reason = why(limit)
    except (TooManyPackedStatesError, TooLargeError):
        reason = "robots one by one have too many states, or costs too large to be added up in machine words"
    return Minimum("undecided" if reason else "none", reason=reason, states=search.states)


@dataclass(frozen=True, slots=True)
class _Alone:
    """The human's own problem, and how to pack for it what stands in another layout."""

    problem: PackedProblem
    layout: PackedLayout

    def packed(self, rows: Words, deadline: Deadline) -> tuple[Words, Ints]:
        """States of the other layout in this one's, and their rows; none where facts exclude each other."""
        own = self.problem.layout
        found = np.zeros((len(rows), own.words), np.uint64)
        fits = np.ones(len(rows), bool)
        for fact, at in own.place.items():
            deadline.check()
            field, here = own.fields[at.field], self.layout.fields[self.layout.place[fact].field]
            true = (rows[:, here.word] & np.uint64(here.mask)) != 0
            fits[true] &= (found[true, field.word] & np.uint64(field.mask)) == 0
            found[true, field.word] |= np.uint64(at.value << field.shift)
        chosen = np.flatnonzero(fits)
        return found[chosen], chosen


class _Search:
    """One question.

    Attributes:
        states: how many were looked at.
    """

    def __init__(self, question: Subproblem) -> None:
        self._question = question
        self._deadline = question.deadline
        self.states = 0

    def run(self) -> str:
        """Why it is undecided; nothing: there is no plan."""
        question, task = self._question, self._question.task
        relevant = relevant_part(question)
        if relevant is None:
            return ""
        if question.horizon * question.an_epoch > limits().weight:
            raise TooLargeError
        space, _ = team_space(question, relevant)
        if self._in_the_way(relevant, space):
            return "robots may disable what the human does in the same epoch"
        own = [i for i in relevant.actions if task.human in task.actions[i].participants]
        goal = {*task.goal.positive, *task.goal.negative} & relevant.facts
        kept, matters = closure(task, own, goal, set(relevant.facts), self._deadline)
        robots = parts(question, relevant, frozenset(matters))
        if not robots:
            return "there are no robots"
        followed = frozenset(matters).union(*(part.facts for part in robots))
        layout = PackedLayout(followed, (), ())
        operators = [as_operator((task.actions[i],), question.prices.team[i]) for i in sorted(kept)]
        wanted = list(task.goal.positive), list(task.goal.negative)
        alone = _Alone(PackedProblem(space, matters, operators, wanted, self._deadline), layout)
        return self._ends(alone, [RobotTimeline(question, relevant, part, layout) for part in robots])

    def _in_the_way(self, relevant: Relevant, space: StateSpace) -> bool:
        """Whether a robot may disable an action of the human's in the epoch in which that is done."""
        task = self._question.task
        if self._question.options.strict:
            return False
        by_id = {i: task.actions[i] for i in relevant.actions}
        for i, disabled in all_disabled([*by_id.items()], self._deadline).items():
            robots = by_id[i]
            for own in (by_id[j] for j in disabled if task.human not in robots.participants):
                beside = task.human in own.participants and not conflicting(own, robots, strict=False)
                if beside and space.pairs.possible({*own.pre, *robots.pre}):
                    return True
        return False

    def _ends(self, alone: _Alone, timelines: list[RobotTimeline]) -> str:
        ends = list(self._windows(alone, timelines))
        if not ends:
            return ""
        states = np.concatenate([states for states, _ in ends])
        paid = np.concatenate([paid for _, paid in ends])
        search, found = alone.problem.search(states, paid, self._most() + 1)
        self.states += search.states
        return "" if found is None else "robots one by one may help enough"

    def _most(self) -> int:
        """What a plan may cost."""
        question = self._question
        assert question.most is not None
        most = question.most - question.prices.epoch
        return most if question.most_cost is None else min(most, question.most_cost)

    def _windows(self, alone: _Alone, timelines: list[RobotTimeline]) -> Iterator[tuple[Words, Ints]]:
        """By window, the states that it may end with and that are worth looking at, with what was paid."""
        question, task, layout = self._question, self._question.task, alone.layout
        states = states_along(task, ((i,) for i in question.human_plan), strict=question.options.strict)
        assert states is not None, "pi_H can be executed"
        spent = 0
        for state, step in zip(states, question.human_plan, strict=False):
            most = self._most() - spent
            if most < 0:
                return
            base = layout.pack([state])
            apart = [self._left_by(timeline, base, state) for timeline in timelines]
            rows, paid = together(apart, most, self._deadline)
            self.states += len(rows)
            packed, chosen = alone.packed(rows ^ base, self._deadline)
            paid = paid[chosen]
            hopeful = paid + alone.problem.bounds(packed) <= most
            yield packed[hopeful], paid[hopeful] + spent
            for timeline in timelines:
                timeline.follow(step)
            spent += question.prices.team[step]

    def _left_by(self, timeline: RobotTimeline, base: Words, state: frozenset[int]) -> tuple[Words, Ints]:
        """What a robot may leave behind after the next epoch."""
        part, layout = timeline.part, timeline.layout
        layer = timeline.ends()
        undoing = [f for f in part.changed if f in (part.added if f in state else part.deleted)]
        bits = [layout.pack([frozenset({fact})]) for fact in sorted(undoing)]
        return differences(layer.rows, layer.paid, base, layout.pack([part.changed]), bits, self._deadline)
