"""Windows of one epoch, all agents at once: every state beside the human's timetable, epoch by epoch.

Where robots take from one another all the time, what each can do by itself says little.  But as long as
the human follows ``pi_H`` robots are in their way, and there may be few enough states to look at all.
"""

from collections.abc import Iterable, Iterator
from itertools import accumulate
from typing import Final

from search.call.context import SearchContext
from search.classical.problem import MOST_WEIGHT, ClassicalProblem
from search.engine.best_first import Progress
from search.human.whole_actions import alone_planner
from search.kernel.library import library
from search.packed.cost_vector import ACTIONS_BITS, own_costs
from search.packed.operators import Operator, union
from search.short_windows.joint.epochs import Epochs, Leaving
from search.short_windows.question import ShortWindowQuestion, lost_values
from search.spaces.factory import suffix_rule
from serendipity.model.resources.deadline import Deadline

_HOPEFUL: Final = 3
"""One part in so many of the epochs has to be behind it to be worth going on at once: states multiply at
first, and are fewer where goals have been reached."""

_MOST_ACTIONS: Final = 2_000
"""Every pair of them is told apart."""

_MOST_AGENTS: Final = 63

_MOST_COST_BITS: Final = 24
"""Of an action, and of the unit of what follows: so that what all agents do in an epoch can be added up."""


class AllTogether:
    """Windows of one epoch, the earliest first, looked at in one go or in several.

    Args:
        progress: what is known so far, which is brought up to date.
        longer: no plan with a longer window has a smaller key.
    """

    def __init__(self, question: ShortWindowQuestion, progress: Progress, longer: int) -> None:
        self._question = question
        self._context = question.context
        self._steps = question.steps()
        self._best = question.best
        self._progress = progress
        self._longer = longer
        self._suffix = suffix_rule(question.context, question.plan)
        self._epochs: Epochs | None = None
        self._epoch = 1
        self._left: list[Leaving] | None = None
        """What can be left behind in that epoch and was not looked at yet, the least total last."""
        self._is_over = False

    @property
    def is_hopeful(self) -> bool:
        """Whether a good part of the epochs is behind it."""
        return _HOPEFUL * self._epoch >= len(self._steps)

    def windows(self, most: int, deadline: Deadline) -> Iterator[None]:
        """Yield whenever the incumbent has become better; raise the bound after all epochs.

        It goes on from where it ended the last time.

        Args:
            most: so many states, and it ends.
        """
        if self._is_over:
            return
        fits = self._amount(self._best.key) < MOST_WEIGHT
        epochs = self._epochs or (epochs_of(self._context, self._steps, deadline) if fits else None)
        self._epochs, self._is_over = epochs, epochs is None
        if epochs is None:
            return
        while self._epoch <= len(self._steps):
            if self._left is None:
                left = epochs.leave(
                    self._amount(self._best.key - self._question.start(self._epoch)), most, deadline
                )
                if left is None:
                    break
                self._left = left[::-1]
            yield from self._look(epochs, self._left)
            if self._epoch < len(self._steps):
                op = self._steps[self._epoch - 1]
                limit = self._amount(self._best.key - self._context.keys.epoch_weight)
                if not epochs.advance(op, self._later(limit), limit, most, deadline):
                    break
            self._epoch, self._left = self._epoch + 1, None
        else:
            self._is_over = True
            self._progress.bound = max(self._progress.bound, min(self._longer, self._best.key))
        self._is_over = self._is_over or epochs.is_hopeless

    def _look(self, epochs: Epochs, left: list[Leaving]) -> Iterator[None]:
        """Whether things that can be left behind make the incumbent better."""
        context, best, start = self._context, self._best, self._question.start(self._epoch)
        while left and start + context.weights.key_of(left[-1].total) < best.key:
            limit = best.key - start - context.weights.key_of(left[-1].paid)
            state, epochs_left = epochs.end(left[-1]), self._question.horizon - self._epoch
            if self._suffix.key(state, epochs_left, self._epoch, limit) < limit:
                better = self._question.suggestions().exactly(epochs.ways(left[-1]))
                yield from self._question.accept(better)
            left.pop()
        left.clear()

    def _later(self, limit: int) -> int:
        """The fields that the human's later steps are about, but the last one and those too dear."""
        packed, costs = self._context.packed, map(self._context.weights.scaled_cost, self._steps)
        spent = [cost << ACTIONS_BITS for cost in accumulate(costs)]
        later = range(self._epoch, len(self._steps) - 1)
        return union(packed.mentioned(self._steps[i]) for i in later if spent[i] < limit)

    def _amount(self, limit: int) -> int:
        """The least amount of which the key is not below a limit; ``MOST_WEIGHT``: too much."""
        return self._context.weights.amount_from(limit, MOST_WEIGHT)


def epochs_of(context: SearchContext, steps: Iterable[Operator], deadline: Deadline) -> Epochs | None:
    """The kernel's layers of states; None where it can't."""
    packed, kernel = context.packed, library()
    waiting = {op for op in steps if not packed.is_useful(op.action)}
    operators = (*packed.own, *packed.joint, *packed.others, *waiting)
    if kernel is None or len(operators) > _MOST_ACTIONS or len(context.task.agents) > _MOST_AGENTS:
        return None
    human = context.tables.human.memory(strict=context.options.strict)
    alone = human.classical or alone_planner(packed, packed.goal, deadline)
    costs = [context.weights.scaled_cost(op) for op in operators]
    if alone is None or max(costs).bit_length() > _MOST_COST_BITS:
        return None
    fields = tuple((field, len(packed.values(field))) for field in packed.fields)
    weights = tuple((cost << ACTIONS_BITS) + 1 for cost in costs)
    problem = ClassicalProblem(fields, operators, weights, packed.goal, 1)
    own = own_costs(packed)
    ratio = next((context.weights.scaled_cost(op) // own[op.cost] for op in packed.own if own[op.cost]), 1)
    unit = alone.planner.problem.unit * ratio
    if unit.bit_length() > _MOST_COST_BITS:
        return None
    after = alone.planner.anew(deadline)  # what was learnt would decide between plans of equal rank
    return Epochs(kernel, context, problem, after, lost_values(packed), unit, deadline)
