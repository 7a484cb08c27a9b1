"""The question about windows of one epoch: plans with one that are better than the incumbent."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from search.call.context import SearchContext
from search.engine.best_first import Incumbent
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from search.spaces.from_composite import Suggestions
from serendipity.model.task.task import HumanPlan


class ShortWindowQuestion(NamedTuple):
    """Plans with a window of one epoch, after which the human replans, that beat the incumbent."""

    context: SearchContext
    plan: HumanPlan
    horizon: int
    best: Incumbent

    def steps(self) -> list[Operator]:
        """The human's plan."""
        return [self.context.packed.op(action) for action in self.plan]

    def start(self, epoch: int) -> int:
        """Key of a window in an epoch."""
        keys = self.context.keys
        return keys.epoch_weight + keys.of_start(epoch, self.horizon)

    def suggestions(self) -> Suggestions:
        """What makes plans of robots' actions."""
        return Suggestions(self.context, self.plan, self.horizon, None, self.best.key)

    def accept(self, better: Iterable[Incumbent]) -> Iterator[None]:
        """Make the incumbent better by each of some plans; yield after each."""
        best = self.best
        for found in better:
            best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail
            yield


def lost_values(packed: PackedTask) -> dict[int, set[int]]:
    """Dead ends: by field of the human's goal values from which they alone never get to what it asks for."""
    lost = {}
    for field in packed.fields:
        if packed.goal.need_mask & field:
            moves = [op for op in packed.own if field & ~op.keep]
            good, known = {packed.goal.need & field}, 0
            while len(good) > known:
                known = len(good)
                for op in moves:
                    if op.put & field in good:
                        good.update([op.need & field] if op.need_mask & field else packed.values(field))
            lost[field] = set(packed.values(field)) - good
    return lost
