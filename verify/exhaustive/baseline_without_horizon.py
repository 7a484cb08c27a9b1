"""What doing nothing for the human costs without a horizon, where robots have goals (semantics 3.1).

They execute ``pi_H`` exactly, an action an epoch; robots, without the human, reach ``G_R`` at the
same time or after its end.  A clock that stops at that end is part of the state.
"""

from collections.abc import Iterator

from verify.base.execution import State, sets_beside
from verify.base.relevance import relevant_part
from verify.base.subproblem import Subproblem
from verify.base.undecided import during
from verify.exhaustive.uniform_cost import Bundle, JointSearch
from verify.programs.minimise import Minimum


def cheapest_following(question: Subproblem) -> Minimum:
    """The least cost of a plan in which the human executes ``pi_H`` epoch by epoch and is then idle.

    Args:
        question: its horizon is not looked at.

    Raises:
        LimitReachedError: the deadline came before the search began.
    """
    with during("preparing the search for the robots' own plans"):
        part = relevant_part(question)
        if part is None:
            return Minimum("none")
        search = _Following(question, part)
    return search.run()


def _clock(epoch: int) -> int:
    """The clock's value as a fact that no task has."""
    return -2 - epoch


class _Following(JointSearch):
    """Joint search under a timetable for the human."""

    @property
    def start(self) -> State:
        return super().start | {_clock(0)}

    def is_goal(self, state: State) -> bool:
        return _clock(len(self.question.human_plan)) in state and super().is_goal(state)

    def estimate(self, state: State) -> int:
        rest = self.question.human_plan[self._epoch(state) :]
        return sum(self.question.prices.team[i] for i in rest)

    def applicable(self, state: State) -> Iterator[Bundle]:
        epoch, plan = self._epoch(state), self.question.human_plan
        human = self.task.human
        if epoch == len(plan):
            for bundle in super().applicable(state):
                if all(human not in self.task.actions[i].participants for i in bundle.actions):
                    yield bundle
            return
        if not self._fits(plan[epoch], state):
            return
        robots = [
            i
            for i in self.deadline.each(self.part.actions)
            if human not in self.task.actions[i].participants and self._fits(i, state)
        ]
        strict = self.question.options.strict
        for chosen in sets_beside(self.task, (plan[epoch],), robots, self.deadline, strict=strict):
            bundle = self.bundle(chosen)
            tick, tock = frozenset((_clock(epoch),)), frozenset((_clock(epoch + 1),))
            yield Bundle(chosen, bundle.pre, bundle.neg, bundle.add | tock, bundle.delete | tick, bundle.cost)

    def _epoch(self, state: State) -> int:
        return -2 - min(state)

    def _fits(self, i: int, state: State) -> bool:
        return state.issuperset(self.part.pre[i]) and state.isdisjoint(self.part.neg[i])
