"""The game of semantics 7 for the checker: states are bit sets of the facts that matter to the goal."""

from fractions import Fraction
from functools import cached_property, reduce
from math import lcm
from operator import or_
from typing import NamedTuple

from serendipity.model import Deadline, GroundAction, Options, StateDelta, Task
from verify.base.bit_distances import BitDistances
from verify.base.fact_bits import BitCondition, BitOperator, BitOperators, FactBits
from verify.base.relevance import closure
from verify.base.shortest_paths import PathSearch

Costs = tuple[Fraction, Fraction]
NOTHING: Costs = (Fraction(0), Fraction(0))

_MOST_MOVES = 1 << 40
"""More moves than anybody looks at, one after the other."""

_MOST_ALONE = 1_000_000
_MOST_TOGETHER = 150_000
_MOST_PRIVATE = 10_000
_MOST_LOOKED_AT = 20_000


class Reply(NamedTuple):
    """One of the human's optimal actions: what it costs them, the state after it."""

    cost: Fraction
    state: int
    name: str | None
    """None for waiting."""


class Board:
    """States, moves and the human's own optimum.

    Args:
        task: one human, one robot.
        options: how the human's choices count, and whether a move may take their last plan away.

    Attributes:
        replies_are_dear: the robot changes what they need and can't change themselves, so their
            optimum is another search after each of its moves.
        far: stands for infinite in bounds, which may be too low but not too high.
    """

    def __init__(self, task: Task, options: Options, deadline: Deadline) -> None:
        self.task = task
        self.deadline = deadline
        self.ties = options.ties
        self._no_block = bool(options.no_block)
        self._facts = FactBits(range(len(task.facts)))
        self._bits = self._facts.of
        humans = self._of(task.human)
        robots = self._of(task.robots[0])
        self._scale = lcm(1, *(task.actions[i].cost.denominator for i in (*humans, *robots)))
        dearest = [max((task.actions[i].cost for i in ids), default=Fraction(0)) for ids in (humans, robots)]
        # weights are the human's cost in units, plus their moves (alone) or what the robot pays (together)
        self.far: Costs = ((dearest[0] + 1) * _MOST_MOVES, Fraction(0))
        self._unit = int((dearest[1] + 1) * self._scale) * _MOST_MOVES
        every, goal_facts = set(range(len(task.facts))), {*task.goal.positive, *task.goal.negative}
        self._relevant = self._bits(closure(task, (*humans, *robots), goal_facts, every, deadline)[1])
        self._human = [e for i in deadline.each(humans) if (e := self._edge(i, self._unit, 1)) is not None]
        self._robot = [e for i in deadline.each(robots) if (e := self._edge(i, 1, 0)) is not None]
        self.goal = BitCondition(self._bits(task.goal.positive), self._bits(task.goal.negative))
        self.start = self._bits(task.init) & self._relevant
        self._replies: dict[int, tuple[Reply, ...]] = {}
        changed = reduce(or_, (edge.add | edge.delete for edge in deadline.each(self._robot)), 0)
        his_changes = reduce(or_, (edge.add | edge.delete for edge in deadline.each(self._human)), 0)
        his_needs = reduce(or_, (edge.pre | edge.neg for edge in deadline.each(self._human)), 0)
        self._his = self.goal.pre | self.goal.neg | his_needs | his_changes
        self._alone = BitDistances(self._human, self.goal, _MOST_ALONE, deadline)
        together = [
            edge._replace(weight=edge.weight // self._unit * self._unit)
            for edge in deadline.each(self._human)
        ]
        self._joint_moves = BitOperators([*together, *self._robot], deadline)
        self._together = BitDistances([*together, *self._robot], self.goal, _MOST_TOGETHER, deadline)
        self.replies_are_dear = bool(changed & self._his & ~his_changes)
        self._private = BitDistances(together, self.goal, _MOST_PRIVATE, deadline, self._his & ~changed)
        self._ids = {name: i for i, name in enumerate(task.facts)}

    def _of(self, agent: int) -> list[int]:
        """Actions that an agent does alone."""
        actions = enumerate(self.deadline.each(self.task.actions))
        return [i for i, action in actions if action.participants == (agent,)]

    def at_least(self, state: int, value: Costs, *, most: int = _MOST_LOOKED_AT) -> bool:
        """Whether both together, without turns, pay at least ``value``, as far as can be told.

        Args:
            value: the pair (human's total, supporter's total), compared lexicographically.
            most: how many states may be looked at where there is no table of all of them.
        """
        if value <= self.count(state):
            return True
        known, key = self._together.tabled(state)
        if known:
            return key is None or value <= self._costs(key)
        cheaper = PathSearch(state, self._joint_moves, self._least, self.deadline, self._weight(value))
        return not any(self.goal.holds(here) or n >= most for n, (here, _) in enumerate(cheaper))

    def bound(self, state: int) -> Costs:
        """What both together pay at least from a state; a weaker bound where that takes too long."""
        known, key = self._together.tabled(state)
        if known:
            return self.far if key is None else self._costs(key)
        return self.count(state)

    def count(self, state: int) -> Costs:
        """A bound that needs few states: what the human pays for what only they can bring about."""
        return self._costs(self._least(state))

    def _least(self, state: int) -> int:
        facts = sum(cost for bit, cost in self._countable if not state & bit)
        return max(self._unit * facts, self._by_himself(state))

    def _by_himself(self, state: int) -> int:
        """What the human pays at least if whatever the robot can change is as they want it."""
        known, least = self._private.tabled(state)
        if known and least is None:
            return int(self.far[0] * self._scale) * self._unit
        return least or 0

    def _weight(self, value: Costs) -> int:
        """The least weight that is worth ``value`` or more."""
        prime, supporter = value[0] * self._scale, value[1] * self._scale
        if prime.denominator > 1:
            return (prime.numerator // prime.denominator + 1) * self._unit
        return prime.numerator * self._unit - (-supporter.numerator // supporter.denominator)

    @cached_property
    def _countable(self) -> list[tuple[int, int]]:
        setters = [edge for edge in self.deadline.each(self._robot) if edge.add & self.goal.pre]
        if setters or any((edge.add & self.goal.pre).bit_count() > 1 for edge in self._human):
            return []
        cheapest: dict[int, int] = {}
        for edge in self.deadline.each(self._human):
            bit = edge.add & self.goal.pre
            if bit:
                cheapest[bit] = min(cheapest.get(bit, edge.weight // self._unit), edge.weight // self._unit)
        return list(cheapest.items())

    def state(self, delta: StateDelta) -> int:
        """The bits of a state that a result writes down, or raise a KeyError for a fact that there is not."""
        true = self._bits(self._ids[name] for name in delta.true)
        false = self._bits(self._ids[name] for name in delta.false)
        return (self.start & ~false | true) & self._relevant

    def moves(self, state: int) -> list[tuple[Fraction, int, str]]:
        """What the robot may do, waiting included: cost, state after it, name."""
        found = [(Fraction(0), state, "noop")]
        for edge in self.deadline.each(self._robot):
            if edge.applicable(state):
                action = self.task.actions[edge.label]
                found.append((action.cost, edge.after(state), action.name))
        return found

    def blocks(self, name: str, state: int, after: int) -> bool:
        """Whether a move takes the human's last plan away, and must not."""
        if not self._no_block or name == "noop":
            return False
        return self.alone(after) is None and self.alone(state) is not None

    def useless(self, name: str, state: int) -> Fraction | None:
        """Cost of a robot's action by that name that changes nothing that matters; None if none."""
        for i in self.task.named.get(name, ()):
            action = self.task.actions[i]
            if action.participants == (self.task.robots[0],) and self._edge(i, 1, 0) is None:
                pre, neg = self._bits(action.pre) & self._relevant, self._bits(action.neg) & self._relevant
                if BitCondition(pre, neg).holds(state):
                    return action.cost
        return None

    def alone(self, state: int) -> Fraction | None:
        """The human's optimal cost with an idle robot; None if they have no plan."""
        key = self._key(state)
        return None if key is None else Fraction(key // self._unit, self._scale)

    def replies(self, state: int) -> tuple[Reply, ...]:
        """What the human may optimally do; waiting where they have no plan."""
        replies = self._replies.get(state)
        if replies is None:
            replies = self._replies[state] = tuple(self._optimal(state)) or (Reply(Fraction(0), state, None),)
        return replies

    def _optimal(self, state: int) -> list[Reply]:
        key = self._key(state)
        found: list[Reply] = []
        seen: set[tuple[str, int]] = set()
        if key is None:
            return found
        for edge in self.deadline.each(self._human):  # ascending, as the task's actions are
            if edge.applicable(state):
                after = edge.after(state)
                rest = self._key(after)
                action = self.task.actions[edge.label]
                if rest is not None and rest + edge.weight == key and (action.name, after) not in seen:
                    seen.add((action.name, after))
                    found.append(Reply(action.cost, after, action.name))
        return found[:1] if self.ties == "fixed" else found

    def _key(self, state: int) -> int | None:
        """The human's (cost, length) in one number, by the facts that concern them alone."""
        return self._alone(state & self._his)

    def _costs(self, together: int) -> Costs:
        prime, supporter = divmod(together, self._unit)
        return Fraction(prime, self._scale), Fraction(supporter, self._scale)

    def _edge(self, i: int, unit: int, length: int) -> BitOperator | None:
        """An action as an edge; None where it changes nothing that matters."""
        action: GroundAction = self.task.actions[i]
        edge = self._facts.operator(action, int(action.cost * self._scale) * unit + length, i)
        edge = edge._replace(add=edge.add & self._relevant, delete=edge.delete & self._relevant)
        return edge if edge.add or edge.delete else None
