"""Rules for the suffix: the human alone after the window (semantics 3.1 rule 3, 3.3)."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from search.human.individual_planner import IndividualPlanner, canonical
from search.human.plan_suffix import PlanSuffix
from search.packed.cost_vector import INFINITE_KEY, CostLayout
from search.packed.due import Due
from search.packed.packed_task import PackedGoal, PackedTask


@dataclass(eq=False)
class Replan:
    """An optimal plan of the human's own, without regard to the horizon (Def. 2.0a).

    Attributes:
        alone: their optimal keys to ``G_H``.
        both: their optimal keys to ``G_H`` and the robots' goal, or None where they can't
            affect that goal.
        robot_goal: the robots' goal.
        at_rest: what holds where no robot is at anything.
    """

    alone: IndividualPlanner
    both: IndividualPlanner | None
    robot_goal: PackedGoal
    at_rest: PackedGoal
    keys: CostLayout

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """Key increment of the best suffix that fits ``epochs``; ``INFINITE_KEY`` if none does.

        Args:
            state: packed state at the end of the window.
            epochs: how many are left.
            start: ``xi1`` of the window.
            limit: values at or above it are not told apart.
        """
        reached = self.both is not None or self.robot_goal.holds(state)
        if not reached or not self.at_rest.holds(state):
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
        """The actions of that suffix."""
        return canonical(self.both or self.alone, state)


@dataclass(eq=False)
class Lasting:
    """An optimal plan of the human's own in time: what happens anyway may undo its end before the last epoch.

    Where waiting costs, the human may have begun to rest for good: then only resting may be what is optimal.
    """

    replan: Replan
    goals: Sequence[PackedGoal]
    due: Due
    packed: PackedTask

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`Replan`."""
        found = self.replan.key(state | self.packed.awake, epochs, start, limit)
        return INFINITE_KEY if found < limit and self._lasting(state, epochs) is None else found

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`Replan`."""
        found = self._lasting(state, epochs)
        assert found is not None, "asked for after its key"
        return found

    def _lasting(self, state: int, epochs: int) -> tuple[int, ...] | None:
        """An optimal plan from a state whose end lasts."""
        alone, both = self.replan.alone, self.replan.both
        awake = state | self.packed.awake
        planner = both or alone

        def lasts(end: int, spent: int) -> bool:
            return self.due.lasting(end, epochs - spent, self.goals)

        if awake == state and both is None:  # of the plans that last the canonical one is the first
            found = planner.canonical(state)
            end = None if found is None else self.due.after_all(state, found.actions)
            if found is None or (end is not None and lasts(end, len(found.actions))):
                return None if found is None else found.actions
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
        spent = len(graph.canonical())
        return graph.ending(lambda end: lasts(end | others, spent))


@dataclass(eq=False)
class Asked:
    """A suffix chosen without regard to the robots' goal, which is asked at its end (semantics 11, 12)."""

    chosen: "Suffix"
    goals: Sequence[PackedGoal]
    due: Due
    _known: dict[tuple[int, int, int], bool] = field(default_factory=dict)

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`Replan`."""
        found, at = self.chosen.key(state, epochs, start, limit), (state, epochs, start)
        if found < limit and at not in self._known:
            self._known[at] = self._keeps(*at)
        return found if found >= limit or self._known[at] else INFINITE_KEY

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`Replan`."""
        return self.chosen.actions(state, epochs, start)

    def _keeps(self, state: int, epochs: int, start: int) -> bool:
        actions = self.actions(state, epochs, start)
        end = self.due.after_all(state, actions)
        return end is not None and self.due.lasting(end, epochs - len(actions), self.goals)


Suffix = Replan | Lasting | PlanSuffix | Asked
"""A rule for the epochs from ``xi2`` on."""
