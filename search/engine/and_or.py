"""Least values in an AND-OR graph, by Knuth's generalisation of Dijkstra's algorithm (1977)."""

from collections.abc import Callable, Collection, Hashable, Iterable, Mapping, Sequence
from heapq import heapify, heappop, heappush
from typing import Generic, NamedTuple, TypeVar

from serendipity.model.resources.deadline import Deadline

State = TypeVar("State", bound=Hashable)


class Rule(NamedTuple, Generic[State]):
    """It gives each of its ``heads`` once all of its ``tails`` are there; of these none stands twice."""

    tails: Collection[State]
    heads: Collection[State]


class AndOrGraph(Generic[State]):
    """States that are had by one of several rules (OR), each of which needs several of them (AND)."""

    def __init__(self, rules: Sequence[Rule[State]], deadline: Deadline) -> None:
        self._rules = rules
        self._deadline = deadline
        self._needing: dict[State, list[int]] = {}
        self._free: list[int] = []
        for k, rule in enumerate(rules):
            deadline.tick()
            for state in rule.tails:
                self._needing.setdefault(state, []).append(k)
            if not rule.tails:
                self._free.append(k)

    def settle(
        self, given: Iterable[State], value: Callable[[int, Mapping[State, int]], int], limit: int
    ) -> tuple[dict[State, int], dict[State, int]]:
        """Least values, settled in the order of their size.

        Args:
            given: states that are there for nothing.
            value: what a rule's heads cost, by its index and the values of its tails; not less than any
                of these, and not less where one of these grows.
            limit: what costs as much or more does not count.

        Returns:
            The value of each state that can be had, and, but for those that are given, the index of the
            rule by which it was; of several that cost the same the one that was complete first.
        """
        values: dict[State, int] = {}
        offered: dict[State, int] = dict.fromkeys(given, 0)
        chosen: dict[State, int] = {}
        missing = [len(rule.tails) for rule in self._rules]
        queue = [(0, state) for state in offered]
        heapify(queue)

        def offer(k: int) -> None:
            cost = value(k, values)
            for state in self._rules[k].heads:
                if cost < offered.get(state, limit):
                    offered[state] = cost
                    chosen[state] = k
                    heappush(queue, (cost, state))

        for k in self._free:
            offer(k)
        while queue:
            self._deadline.tick()
            cost, state = heappop(queue)
            if state in values:
                continue
            values[state] = cost
            for k in self._needing.get(state, ()):
                missing[k] -= 1
                if not missing[k]:
                    offer(k)
        return values, {state: k for state, k in chosen.items() if state in values}
