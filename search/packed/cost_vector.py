"""Order of answers as one integer: additive, and compared lexicographically.

semantics 3.1 orders answers by objective, cost, window length, later start, number of
actions.  Every component is a sum over the steps of a plan, so all five are bit
fields of a single int: adding keys adds components, comparing keys compares the
components in that order.

Costs are scaled to integers by the least common denominator, so ties are exact.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Final

from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from serendipity.model.errors import UsageError
from serendipity.model.options import MAX_EPOCH, Options
from serendipity.model.task.task import HumanPlan

ACTIONS_BITS: Final = 32
"""For a number of actions below a cost: a plan of so many has more states than any memory."""

_ACTIONS: Final = (1 << ACTIONS_BITS) - 1

_EPOCH_BITS: Final = MAX_EPOCH.bit_length()

_MOST_BITS: Final = 1 << 14

INFINITE_KEY: Final = 1 << _MOST_BITS
"""No plan: above every key and every amount, as :func:`require_room` sees to."""

FAR: Final = 1 << 60
"""No way, in tables of machine words: what can be had costs less, as those who make them see to."""

NEVER: Final = 1 << 40
"""After every epoch, all of which are at most :data:`.MAX_EPOCH`."""


def require_room(bits: int) -> None:
    """Refuse numbers of so many bits if they, or sums of many of them, may reach :data:`INFINITE_KEY`."""
    if bits + 64 > _MOST_BITS:
        raise UsageError(
            f"costs, discount and weights: expected a common denominator that keeps sums within {_MOST_BITS} "
            f"bits, got {bits}"
        )


@dataclass(frozen=True)
class CostLayout:
    """Widths of the fields, low to high: announced, actions, start, length, cost, objective.

    ``action_shift`` is the lowest bit of the number of actions, ``epoch_weight`` the increment of one
    more epoch of the window.  ``announced`` holds the communication cost of a suffix, which ranks below
    the human's own preferences while they replan and is moved into the objective afterwards.
    """

    scale: int
    action_shift: int
    cost_bits: int
    epoch_weight: int

    @cached_property
    def start_shift(self) -> int:
        """Lowest bit of the start field (horizon + 1 - xi1)."""
        return self.action_shift + ACTIONS_BITS

    @cached_property
    def length_shift(self) -> int:
        """Lowest bit of the window's length."""
        return self.start_shift + _EPOCH_BITS

    @cached_property
    def cost_shift(self) -> int:
        """Lowest bit of the scaled cost."""
        return self.length_shift + _EPOCH_BITS

    @cached_property
    def objective_shift(self) -> int:
        """Lowest bit of the scaled objective."""
        return self.cost_shift + self.cost_bits

    def actions(self, key: int) -> int:
        """Number of actions in a key."""
        return (key >> self.action_shift) & _ACTIONS

    def start_field(self, key: int) -> int:
        """``horizon + 1 - xi1`` in a key: smaller for a later start."""
        return (key >> self.start_shift) & ((1 << _EPOCH_BITS) - 1)

    def length(self, key: int) -> int:
        """Length of the window in a key, in epochs."""
        return (key >> self.length_shift) & ((1 << _EPOCH_BITS) - 1)

    def scaled_cost(self, key: int) -> int:
        """Cost in a key, times ``scale``."""
        return (key >> self.cost_shift) & ((1 << self.cost_bits) - 1)

    def most_cost(self, limit: Fraction | str | None, human: int) -> int | None:
        """The largest scaled cost that a limit allows, rounded down; None where it allows any.

        Args:
            limit: ``max_cost`` of the options.
            human: key of what the human does alone, which is what the limit ``human`` means.
        """
        if limit is None or (limit == "human" and human >= INFINITE_KEY):
            return None
        return self.scaled_cost(human) if limit == "human" else int(Fraction(limit) * self.scale)

    def exceeds(self, key: int, most_cost: int | None) -> bool:
        """Whether the scaled cost in a key is above a limit (None: there is none)."""
        return most_cost is not None and self.scaled_cost(key) > most_cost

    def cost(self, key: int) -> Fraction:
        """Cost in a key, in the domain's unit."""
        return Fraction(self.scaled_cost(key), self.scale)

    def objective(self, key: int) -> Fraction:
        """Objective in a key (for a bound: at least this much)."""
        return Fraction(key >> self.objective_shift, self.scale)

    def of_cost(self, cost: Fraction) -> int:
        """Key increment of an amount of cost."""
        scaled = cost * self.scale
        assert scaled.denominator == 1, "the scale covers every cost of the task"
        return self.of_scaled(scaled.numerator)

    def of_scaled(self, cost: int) -> int:
        """Key increment of a scaled cost."""
        return (cost << self.cost_shift) + (cost << self.objective_shift)

    def of_objective(self, objective: Fraction) -> int:
        """Key that no plan of at least such an objective is below."""
        return int(objective * self.scale) << self.objective_shift

    def of_action(self, cost: Fraction) -> int:
        """Key increment of one action with the given team cost."""
        return self.of_cost(cost) + (1 << self.action_shift)

    def of_start(self, start: int, horizon: int) -> int:
        """Key increment of opening a window at epoch ``start`` of ``horizon``."""
        return (horizon + 1 - start) << self.start_shift

    def announce(self, key: int) -> int:
        """Moves the low ``announced`` field of a suffix's key into the objective."""
        low = key & ((1 << self.action_shift) - 1)
        return key - low + (low << self.objective_shift)


class Weights:
    """Key increments of ops.

    Attributes:
        keys: layout of the keys.
        announces: whether off-plan actions cost communication.
        human: increment of an action of the human by the index of its cost,
            communication left out.
        robots: increment of an action without the human by the index of its cost.

    Args:
        scaling: its costs as integers, by options.
        options: discount, window weight and communication weight.
        plan: ``pi_H``, or None to leave communication costs out.
    """

    def __init__(
        self, packed: PackedTask, scaling: "Scaling", options: Options, plan: HumanPlan | None
    ) -> None:
        announces = options.mode == "communication" and plan is not None
        announced = options.communication_weight if announces else Fraction(0)
        scaled = scaling(options.discount, options.window_weight, announced)
        self.keys = scaled.keys
        self.announces = bool(announced)
        self.human = scaled.human
        self.robots = scaled.robots
        self._announced = scaled.announced
        self._per_cost = scaled.per_cost
        self._human_bit = packed.human_bit
        self._actions = packed.task.actions
        # By name: a human who does another variant of what they planned did not change their mind.
        self._planned = packed.task.names(plan or ()) if announces else frozenset()
        self._robots_share = (1 - options.discount) / _own_scale(packed.costs)
        self._walks: dict[tuple[int, int], int] = {}

    def team(self, op: Operator) -> int:
        """Increment of an op inside a composite plan, communication included."""
        if not op.agents & self._human_bit:
            return self.robots[op.cost]
        weight = self.alone(op)
        return self.keys.announce(weight) if self.announces else weight

    def scaled_cost(self, op: Operator) -> int:
        """What an op costs the team, communication left out, times the scale."""
        weight = (self.human if op.agents & self._human_bit else self.robots)[op.cost]
        return self.keys.scaled_cost(weight)

    def key_of(self, amount: int) -> int:
        """Key of a scaled cost and a number of actions, put together as by :func:`own_weights`."""
        return self._key(amount, self.keys.of_scaled(1))

    def amount_from(self, limit: int, most: int) -> int:
        """The least amount of which :meth:`key_of` is not below a limit; ``most`` at most."""
        cost, rest = divmod(max(limit, 0), self.keys.of_scaled(1))
        actions = -(-rest >> self.keys.action_shift)
        return min(most, (cost << ACTIONS_BITS) + min(actions, 1 << ACTIONS_BITS))

    def of_own(self, cost: int) -> int:
        """Key increment of a cost in the unit of :func:`own_weights`."""
        return self._key(cost, self._per_cost)

    def _key(self, amount: int, per_cost: int) -> int:
        if amount >= INFINITE_KEY:
            return INFINITE_KEY
        return (amount >> ACTIONS_BITS) * per_cost + ((amount & _ACTIONS) << self.keys.action_shift)

    def of_walk(self, cost: int, ops: int) -> int:
        """Increment of a robot's walk: its cost in the unit of :func:`own_costs`, its number of ops."""
        found = self._walks.get((cost, ops))
        if found is None:
            keys = self.keys
            found = keys.of_cost(cost * self._robots_share) + (ops << keys.action_shift)
            self._walks[cost, ops] = found
        return found

    def own_limit(self, limit: int) -> int:
        """A cost in the unit of :func:`own_weights` from which on no key is below a limit."""
        return limit // self._per_cost + 1 << ACTIONS_BITS

    def alone(self, op: Operator) -> int:
        """Increment of an op for the human's own preferences; communication ranks last."""
        weight = self.human[op.cost]
        if self.announces and self._actions[op.action].name not in self._planned:
            weight += self._announced[op.cost]
        return weight


@dataclass(frozen=True, slots=True)
class ScaledCosts:
    """Costs of a task as integers; see :class:`Weights`.

    Attributes:
        announced: communication cost of an action by the index of its cost.
        per_cost: key increment of one unit of cost.
    """

    keys: CostLayout
    human: list[int]
    robots: list[int]
    announced: list[int]
    per_cost: int


Scaling = Callable[[Fraction, Fraction, Fraction], ScaledCosts]
"""The costs of a task as integers under a discount, a window weight and a communication weight."""


def scaled_costs(
    costs: Sequence[Fraction], discount: Fraction, window: Fraction, announced: Fraction
) -> ScaledCosts:
    """Costs of a task as integers.

    Args:
        costs: the different undiscounted costs.
        discount: of what robots do without the human.
        window: weight of an epoch of the window.
        announced: weight of communication.

    Raises:
        UsageError: their common denominator is too large.
    """
    factors = (Fraction(1), 1 - discount, announced)
    scale = lcm(window.denominator, *((c * f).denominator for c in costs for f in factors))
    dearest = int(max(costs, default=Fraction(0)) * scale)
    announced_bits = int(dearest * announced).bit_length() + ACTIONS_BITS if announced else 0
    layout = CostLayout(scale, announced_bits, dearest.bit_length() + ACTIONS_BITS, 0)
    dearer = max(dearest, int(window * scale), int(dearest * announced))
    require_room(layout.objective_shift + dearer.bit_length() + ACTIONS_BITS)
    epoch = (int(window * scale) << layout.objective_shift) + (1 << layout.length_shift)
    keys = replace(layout, epoch_weight=epoch)
    return ScaledCosts(
        keys,
        human=[keys.of_action(cost) for cost in costs],
        robots=[keys.of_action(cost * (1 - discount)) for cost in costs],
        announced=[int(cost * announced * scale) for cost in costs],
        per_cost=keys.of_scaled(scale // _own_scale(costs)),
    )


def own_weights(packed: PackedTask) -> list[int]:
    """Undiscounted costs by their index, in a unit that no option changes.

    Cost (in the least unit of the task's costs) and number of actions are the two fields of
    an int: what the human prefers alone (semantics 1).  :meth:`Weights.of_own` makes keys of sums.
    """
    return [(cost << ACTIONS_BITS) + 1 for cost in own_costs(packed)]


def own_costs(packed: PackedTask) -> list[int]:
    """Undiscounted costs by their index, in the least unit of the task's costs."""
    scale = _own_scale(packed.costs)
    return [int(cost * scale) for cost in packed.costs]


def own_actions(cost: int) -> int:
    """The number of actions in a sum of :func:`own_weights`."""
    return cost & _ACTIONS


def _own_scale(costs: Sequence[Fraction]) -> int:
    return lcm(*(cost.denominator for cost in costs))
