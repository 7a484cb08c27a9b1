"""What the agents can do in one epoch, all of them at once (SPEC 2).

Ops are looked up under their leader by the value of one field, the one that most
of the leader's actions ask for (a position, as a rule).
"""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from search.encoding import Encoding, Op
from serendipity.model.actions import disables


class Option(NamedTuple):
    """One agent's applicable action, or several robots' at once, in some state."""

    weight: int
    keep: int
    put: int
    actions: tuple[int, ...]
    agents: int
    """Bit set of the agents that are busy with it."""


NOTHING = Option(0, -1, 0, (), 0)
"""Everybody waits."""


class Lookup:
    """Weighted ops of one leader, found by the value of one field."""

    def __init__(self, encoding: Encoding, actions: Iterable[int], weight: Callable[[int], int]) -> None:
        ops = [encoding.op(i) for i in actions]
        counts = {field: 0 for field in encoding.fields}
        for op in ops:
            for field in encoding.fields:
                if op.need_mask & field:
                    counts[field] += 1
        self.field = max(counts, key=lambda field: counts[field], default=0)
        self._weight = weight
        self._by_value: dict[int, list[Op]] = {}
        self._always: list[Op] = []
        for op in ops:
            if op.need_mask & self.field:
                self._by_value.setdefault(op.need & self.field, []).append(op)
            else:
                self._always.append(op)
        self._weighted: dict[int, list[tuple[Op, Option]]] = {}

    def _candidates(self, state: int) -> list[tuple[Op, Option]]:
        """Ops whose condition on the field holds, each with what it would do."""
        value = state & self.field
        found = self._weighted.get(value)
        if found is None:
            ops = [*self._by_value.get(value, ()), *self._always]
            found = [
                (op, Option(self._weight(op.action), op.keep, op.put, (op.action,), op.agents)) for op in ops
            ]
            found.sort(key=lambda pair: (pair[1].weight, pair[0].action))
            self._weighted[value] = found
        return found

    def options(self, state: int) -> list[Option]:
        """What is applicable in a packed state, cheapest first."""
        return [
            option
            for op, option in self._candidates(state)
            if state & op.need_mask == op.need
            and (not op.forbidden or all(state & m != value for m, value in op.forbidden))
        ]


class Successors:
    """Applicable action sets of a task.

    Args:
        encoding: the packed task.
        weight: key increment of an action.
        strict: strict interference (SPEC 2).
        idle: robots do nothing.
    """

    def __init__(
        self, encoding: Encoding, weight: Callable[[int], int], *, strict: bool, idle: bool = False
    ) -> None:
        task = encoding.task
        self._encoding = encoding
        self._strict = strict
        self._human_bit = 1 << task.human
        own: list[int] = []
        shared: list[int] = []
        led: dict[int, list[int]] = {robot: [] for robot in task.robots}
        for i in encoding.useful:
            participants = task.actions[i].participants
            if participants == (task.human,):
                own.append(i)
            elif idle:
                continue
            elif task.human in participants:
                shared.append(i)
            else:
                led[participants[0]].append(i)
        self._own = Lookup(encoding, own, weight)
        self._shared = Lookup(encoding, shared, weight) if shared else None
        self._led = [(1 << robot, Lookup(encoding, ids, weight)) for robot, ids in led.items() if ids]
        self._busy: dict[int, list[Option]] = {}

    def human(self, state: int) -> list[Option]:
        """What the human can do alone in a packed state, cheapest first (not: wait)."""
        return self._own.options(state)

    def joint(self, state: int) -> list[Option]:
        """Joint actions with the human that are applicable."""
        return self._shared.options(state) if self._shared is not None else []

    def robots(self, state: int) -> list[Option]:
        """Every applicable set of actions of the robots without the human, cheapest first."""
        found = self._busy.get(state)
        if found is None:
            found = [NOTHING]
            for _, lookup in self._led:
                found += list(self._extend(found, lookup.options(state)))
            found.sort(key=lambda option: option.weight)
            self._busy[state] = found
        return found

    def with_robots(self, first: Option, state: int) -> Iterator[Option]:
        """``first`` (the human's part) alone and with each set of robots' actions that fits it."""
        return self._combine(first, self.robots(state))

    def sequential(self, actions: tuple[int, ...]) -> bool:
        """Whether a compatible set has the same effect one action after another, in some order.

        It does not where actions disable each other in a circle: then it needs one epoch.
        """
        left = [self._encoding.task.actions[i] for i in actions]
        while left:
            last = next((a for a in left if not any(b is not a and disables(b, a) for b in left)), None)
            if last is None:
                return False
            left.remove(last)
        return True

    def _extend(self, sets: list[Option], more: list[Option]) -> Iterator[Option]:
        for chosen in sets:
            for option in more:
                if not chosen.agents & option.agents and self._fits(option, chosen):
                    yield _together(chosen, option)

    def _combine(self, first: Option, sets: list[Option]) -> Iterator[Option]:
        for chosen in sets:
            if not chosen.actions:
                yield first
            elif not chosen.agents & first.agents and self._fits(first, chosen):
                yield _together(first, chosen)

    def _fits(self, single: Option, others: Option) -> bool:
        """Whether ``single`` (of at most one action) may share an epoch with ``others``."""
        if not single.actions:
            return True
        mine = single.actions[0]
        return all(self._encoding.compatible(mine, other, self._strict) for other in others.actions)


def _together(a: Option, b: Option) -> Option:
    return Option(a.weight + b.weight, a.keep & b.keep, a.put | b.put, a.actions + b.actions, a.agents | b.agents)
