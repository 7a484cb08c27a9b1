"""What doing nothing for the human costs without a horizon, where robots have goals (semantics 3.1).

They execute ``pi_H`` exactly, an action an epoch; robots, without the human, reach ``G_R`` at the
same time or after its end.  A clock that stops at that end is part of the state.
"""

from collections.abc import Iterator

from verify.base.execution import sets_beside
from verify.base.fact_bits import BitOperator
from verify.base.relevance import Relevant, relevant_part
from verify.base.subproblem import Subproblem
from verify.base.undecided import during
from verify.exhaustive.uniform_cost import JointSearch
from verify.programs.effort import Minimum


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


class _Following(JointSearch):
    """Joint search under a timetable for the human; the bits above those of facts are the clock."""

    def __init__(self, question: Subproblem, part: Relevant) -> None:
        super().__init__(question, part)
        self._facts = self.bits.all
        self._single = {i: self.bundle((i,)) for i in self.deadline.each(part.actions)}

    def _epoch(self, state: int) -> int:
        return state >> self._facts.bit_length()

    def _clock(self, epoch: int) -> int:
        return epoch << self._facts.bit_length()

    def is_goal(self, state: int) -> bool:
        return self._epoch(state) == len(self.question.human_plan) and super().is_goal(state)

    def estimate(self, state: int) -> int:
        rest = self.question.human_plan[self._epoch(state) :]
        return sum(self.question.prices.team[i] for i in rest)

    def applicable(self, state: int) -> Iterator[BitOperator]:
        epoch, plan = self._epoch(state), self.question.human_plan
        human = self.task.human
        facts = state & self._facts
        if epoch == len(plan):
            for bundle in super().applicable(facts):
                if all(human not in self.task.actions[i].participants for i in bundle.label):
                    yield bundle
            return
        if not self._fits(plan[epoch], facts):
            return
        robots = [
            i
            for i in self.deadline.each(self.part.actions)
            if human not in self.task.actions[i].participants and self._fits(i, facts)
        ]
        strict = self.question.options.strict
        for chosen in sets_beside(self.task, (plan[epoch],), robots, self.deadline, strict=strict):
            bundle, tick, tock = self.bundle(chosen), self._clock(epoch), self._clock(epoch + 1)
            yield bundle._replace(add=bundle.add | tock, delete=bundle.delete | tick)

    def _fits(self, i: int, facts: int) -> bool:
        return self._single[i].applicable(facts)
