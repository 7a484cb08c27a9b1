"""Rules for the suffix: the human alone after the window (semantics 3.1 rule 3, 3.3)."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Protocol

from search.human.individual_planner import IndividualPlanner, canonical
from search.packed.cost_vector import INFINITE_KEY, CostLayout
from search.packed.due import Due
from search.packed.joint_actions import JointAction
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline

PlannedSteps = Sequence[tuple[Operator, JointAction]]
"""The packed actions of ``pi_H`` and what they do, in order."""

_Rest = tuple[int, int, int]
"""The first step of ``pi_H`` that is left, a packed state, and how many epochs are left."""


class Suffix(Protocol):
    """A rule for the epochs from ``xi2`` on."""

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """Key increment of the best suffix that fits ``epochs``; ``INFINITE_KEY`` if none does.

        Args:
            state: packed state at the end of the window.
            epochs: how many are left.
            start: ``xi1`` of the window.
            limit: values at or above it are not told apart.
        """

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """The actions of that suffix."""


@dataclass(eq=False)
class Replan:
    """An optimal plan of the human's own, without regard to the horizon (Def. 2.0a).

    Attributes:
        alone: their optimal keys to ``G_H``.
        both: their optimal keys to ``G_H`` and the robots' goal, or None where they can't
            affect that goal.
        robot_goal: the robots' goal.
        at_rest: what holds where no robot is at anything.
        keys: layout of keys.
    """

    alone: IndividualPlanner
    both: IndividualPlanner | None
    robot_goal: PackedGoal
    at_rest: PackedGoal
    keys: CostLayout

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`Suffix`."""
        if self.both is None and not self.robot_goal.holds(state):
            return INFINITE_KEY
        if self.at_rest.mask and not self.at_rest.holds(state):
            return INFINITE_KEY
        own = self.alone.key(state, limit)
        if own >= limit or self.keys.actions(own) > epochs:
            return INFINITE_KEY
        if self.both is not None:
            # The human's plan must be optimal for G_H alone and happen to leave G_R true.
            kept = self.both.key(state)
            shift = self.keys.action_shift
            if kept >> shift != own >> shift:
                return INFINITE_KEY
            own = kept
        return self.keys.announce(own)

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`Suffix`."""
        return canonical(self.both or self.alone, state)


@dataclass(eq=False)
class Lasting:
    """An optimal plan of the human's own in time: what happens anyway may undo its end before the last epoch.

    Where waiting costs, the human may have begun to rest for good: then only resting may be what is optimal.

    Attributes:
        replan: the rule without time.
        goals: what holds in the end.
        due: what happens anyway.
        packed: the packed task.
    """

    replan: Replan
    goals: Sequence[PackedGoal]
    due: Due
    packed: PackedTask

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`Suffix`."""
        found = self.replan.key(state | self.packed.awake, epochs, start, limit)
        return INFINITE_KEY if found < limit and self._lasting(state, epochs) is None else found

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`Suffix`."""
        found = self._lasting(state, epochs)
        assert found is not None, "asked for after its key"
        return found

    def _lasting(self, state: int, epochs: int) -> tuple[int, ...] | None:
        """An optimal plan from a state whose end lasts."""
        alone, both = self.replan.alone, self.replan.both
        awake = state | self.packed.awake
        planner = both or alone
        graph, others = planner.plans(awake), awake & ~planner.mask
        if graph is None:
            return None
        size = self.packed.counted
        if awake != state and graph.size(size):
            return None
        if both is not None:
            least = alone.plans(awake)
            if least is None or least.size(size) < graph.size(size):
                return None
        left = epochs - len(graph.canonical())

        def holds(end: int) -> bool:
            return all(goal.holds(end) for goal in self.goals)

        return graph.ending(lambda end: self.due.lasting(end | others, left, holds))


class Subplan:
    """A subsequence of ``pi_H`` in its order, between noops (Def. 2.0, eq. 9)."""

    def __init__(self, steps: PlannedSteps, goals: Sequence[PackedGoal], deadline: Deadline) -> None:
        self._steps = [(op, option.weight) for op, option in steps]
        self._goals = goals
        self._deadline = deadline
        self._known: dict[_Rest, tuple[int, bool]] = {}

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`Suffix`."""
        return self._best((0, state, min(epochs, len(self._steps))))[0]

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`Suffix`."""
        chosen = []
        left = min(epochs, len(self._steps))
        for index, (op, _) in enumerate(self._steps):
            if self._best((index, state, left))[1]:
                chosen.append(op.action)
                state = state & op.keep | op.put
                left -= 1
        return tuple(chosen)

    def _best(self, wanted: _Rest) -> tuple[int, bool]:
        """Best key of a rest, and whether it takes its first step."""
        known = self._known
        pending = [wanted]  # plans may be longer than Python's stack is deep
        while pending:
            self._deadline.tick()
            at = pending[-1]
            missing = [] if at in known else [rest for rest, _ in self._choices(at) if rest not in known]
            if missing:
                pending += missing
            else:
                known[at] = self._cheapest(pending.pop())
        return known[wanted]

    def _cheapest(self, at: _Rest) -> tuple[int, bool]:
        index, state, _ = at
        if index == len(self._steps):
            return (0 if all(goal.holds(state) for goal in self._goals) else INFINITE_KEY), False
        keys = [weight + self._known[rest][0] for rest, weight in self._choices(at)]
        return min(keys), keys[-1] < keys[0]

    def _choices(self, at: _Rest) -> list[tuple[_Rest, int]]:
        """What is left after a step is skipped, and after it is taken if it can be; its weight."""
        index, state, left = at
        if index == len(self._steps):
            return []
        choices = [((index + 1, state, left), 0)]
        op, weight = self._steps[index]
        if left and applicable(op, state):
            choices.append(((index + 1, state & op.keep | op.put, left - 1), weight))
        return choices


class Preserved:
    """The rest ``pi_H[j+1..]``, from a state that still contains what ``pi_H[1..j]`` made
    true of the human's own facts (Def. 3.1, read literally).
    """

    def __init__(
        self, steps: PlannedSteps, goals: Sequence[PackedGoal], expected: Sequence[PackedGoal]
    ) -> None:
        self._ops = [op for op, _ in steps]
        self._goals = goals
        self._expected = expected
        weights = (option.weight for _, option in reversed(steps))
        self._rest = list(accumulate(weights, initial=0))[::-1]

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`Suffix`."""
        return min((self._rest[j] for j in self._fitting(state, epochs, start)), default=INFINITE_KEY)

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`Suffix`."""
        best = min(self._fitting(state, epochs, start), key=lambda j: self._rest[j])
        return tuple(op.action for op in self._ops[best:])

    def _fitting(self, state: int, epochs: int, start: int) -> list[int]:
        first = max(start - 1, len(self._ops) - epochs)
        return [
            j
            for j in range(first, len(self._ops) + 1)
            if self._expected[j].holds(state) and self._works(state, j)
        ]

    def _works(self, state: int, index: int) -> bool:
        for op in self._ops[index:]:
            if not applicable(op, state):
                return False
            state = state & op.keep | op.put
        return all(goal.holds(state) for goal in self._goals)
