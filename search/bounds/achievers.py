"""Lower bounds on what robots pay, and take, to provide what the human's touches ask for."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, zip_longest

from search.bounds.achiever_automaton import AchieverAutomaton
from search.bounds.achiever_costs import AchieverCosts
from search.bounds.interactions import Interactions
from search.packed.cost_vector import INFINITE_KEY, NEVER
from search.packed.joint_actions import Idle
from search.packed.operators import Operator, set_by
from search.packed.packed_task import PackedTask
from search.robots.transition_graphs import PositionVariables, TransitionGraphs
from serendipity.model.resources.deadline import Deadline


@dataclass(eq=False)
class Provided:
    """Least key increment, and least number of epochs, for robots to provide a need.

    Attributes:
        need: its id.
        by_cost: what robots can do, weighed.
        by_step: the same, counting epochs; None where the weight tells them.
        unit: weight of an epoch, then.
        slack: if robots pay as much or more from the initial state on, it is too dear.
        latest: the last epoch by which robots must have provided it.
    """

    need: int
    by_cost: AchieverAutomaton
    by_step: AchieverAutomaton | None
    unit: int
    slack: int
    latest: int

    @cached_property
    def cost(self) -> AchieverCosts:
        """Least key increment from a packed state."""
        in_time = self.slack if self.by_step is not None else (self.latest + 1) * self.unit
        return self.by_cost.distances(self.need, min(self.slack, in_time))

    @cached_property
    def _steps(self) -> AchieverCosts:
        return self.cost if self.by_step is None else self.by_step.distances(self.need, self.latest + 1)

    def epochs(self, state: int, idle: Idle) -> int:
        """In how many epochs from now the need can be provided, from a packed state.

        Robots that have been idle may have walked meanwhile, where walks are folded.
        """
        return soonest(self.each(state), idle) if idle else self._steps(state) // self.unit

    def each(self, state: int) -> tuple[int, ...]:
        """The same without a rest, per robot that may act first."""
        each = self._steps.each(state)
        return tuple(NEVER if steps >= INFINITE_KEY else steps // self.unit for steps in each)


def soonest(epochs: Sequence[int], idle: Idle) -> int:
    """In how many epochs from now a robot can act, by how long each needs that has been idle for some."""
    each = zip_longest(epochs, idle, fillvalue=0)  # bystanders and the clock never rest
    return max(0, min(needed - rest for needed, rest in each))


@dataclass(eq=False)
class Achievers:
    """The robots' side.

    Args:
        transitions: what robots' ops do to each variable.
        interactions: what the human's ops mention.
        weights: key increment of a robots' op by the index of its cost.
        followed: the ops of ``pi_H``, in order, where the human follows it for a while.

    A need that is judged by a field that ``pi_H`` changes counts twice: before that
    happens, and, under the id ``-1 - need``, afterwards.
    """

    packed: PackedTask
    transitions: TransitionGraphs
    interactions: Interactions
    weights: Sequence[int]
    followed: Sequence[Operator]
    deadline: Deadline

    def __post_init__(self) -> None:
        packed, weights = self.packed, self.weights
        self._changes: dict[int, int] = {}
        self._judges: dict[int, int] = {}
        for epoch, op in enumerate(self.followed, start=1):
            for field in packed.split(packed.all_ones & ~op.keep):
                self._changes.setdefault(field, epoch)
        self._shared = shared_fields(packed, self.transitions.places)
        used = {weights[form.cost] for form in packed.other_forms}
        self._uniform = len(used) <= 1
        self._unit = max(used, default=1)
        self._by_cost: dict[tuple[int, bool], AchieverAutomaton] = {}
        self._by_step: dict[tuple[int, bool], AchieverAutomaton] = {}

    def at(self, need: int, epoch: int) -> int:
        """The id that a need goes by after ``epoch`` epochs of ``pi_H``."""
        changed = self._changes.get(self._judged_by(need))
        return need if changed is None or epoch < changed else -1 - need

    def phases(self, epochs: int) -> list[tuple[int, int]]:
        """Stretches of ``0 .. epochs - 1`` between which ``pi_H`` changes something outside."""
        shared = (change for field, change in self._changes.items() if field in self._shared)
        cuts = sorted({0, epochs, *(change for change in shared if change < epochs)})
        return list(pairwise(cuts))

    @staticmethod
    def touched(need: int) -> int:
        """The need behind an id of :meth:`at`."""
        return need if need >= 0 else -1 - need

    def costs(self, needs: Sequence[int], pays: Callable[[int], bool]) -> dict[int, int]:
        """Least cost from the initial state per need, as far as anything can pay that or more."""
        return self._explore(self._by_cost, needs, self.weights, pays)

    def epochs(self, cost: int) -> int:
        """At least so many epochs go into what costs robots a key increment."""
        return cost // self._unit if self._uniform else 0

    def provided(
        self, needs: Sequence[int], horizon: int, slack: Mapping[int, int], latest: Mapping[int, int]
    ) -> dict[int, Provided]:
        """Bounds from any packed state, for needs that :meth:`costs` found.

        Args:
            needs: their ids.
            horizon: number of epochs; beyond it steps are not told apart.
            slack: by need the cost from which on it is too dear.
            latest: by need the last epoch in which it can be provided.
        """
        unit = self._unit
        if not self._uniform:
            self._explore(self._by_step, needs, [1] * len(self.weights), horizon.__ge__)
            unit = 1
        found = {}
        for need in needs:
            group = self._group(need)
            by_cost, by_step = self._by_cost[group], self._by_step.get(group)
            found[need] = Provided(need, by_cost, by_step, unit, slack[need], latest[need])
        return found

    def _explore(
        self,
        provisions: dict[tuple[int, bool], AchieverAutomaton],
        needs: Sequence[int],
        weights: Sequence[int],
        pays: Callable[[int], bool],
    ) -> dict[int, int]:
        groups: dict[tuple[int, bool], list[int]] = {}
        for need in needs:
            groups.setdefault(self._group(need), []).append(need)
        costs: dict[int, int] = {}
        for (field, late), members in groups.items():
            listed = [(i, self.interactions.needs[self.touched(i)]) for i in members]
            flips = self.followed if late else ()
            self.deadline.check()
            provision = AchieverAutomaton(
                self.packed, self.transitions, field, listed, weights, flips, self.deadline
            )
            provision.explore(pays)
            provisions[field, late] = provision
            costs.update(provision.cost)
        return costs

    def _group(self, need: int) -> tuple[int, bool]:
        """The field that judges a need, and whether ``pi_H`` has changed it by then."""
        touched = self.touched(need)
        return self._judged_by(touched), touched != need

    def _judged_by(self, need: int) -> int:
        """The first shared field that the need asks for; 0: only places matter."""
        field = self._judges.get(need)
        if field is None:
            self.deadline.tick()
            mask = self.interactions.needs[need].mask
            field = self._judges[need] = next((f for f in self._shared if mask & f), 0)
        return field


def shared_fields(packed: PackedTask, positions: PositionVariables) -> list[int]:
    """Outside fields that robots alone change, and that are no robot's place, the largest first.

    What a script changes, too, may be provided for nothing.
    """
    places = set(positions.field.values())
    robots = sum(1 << robot for robot in packed.task.robots)
    scripted = set_by(form for form in packed.other_forms if form.agents & ~robots)
    outside = [f for f in packed.fields if f & packed.outside and f not in places and not f & scripted]
    return sorted(outside, key=lambda f: (-len(packed.values(f)), f))
