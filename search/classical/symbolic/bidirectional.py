"""Symbolic bidirectional search: layers of states by what they cost, from the state and from the goal.

Torralba, Alcázar, Kissmann and Edelkamp, Efficient symbolic search for cost-optimal planning (Artificial
Intelligence 242, 2017): uniform-cost search in both directions, each step where the last one was shorter.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import reduce
from operator import or_
from time import process_time

from oxidd.bcdd import BCDDFunction as Diagram

from search.classical.problem import INFINITE_WEIGHT, ClassicalProblem
from search.classical.symbolic.state_sets import StateSets
from search.packed.operators import applicable


class _Side:
    """One direction.

    Attributes:
        layers: the states by their distance, all of them up to ``least``.
        least: the distance of the next layer, or ``INFINITE_WEIGHT`` if there is none.
        seen: all states with a distance so far.
        took: seconds of the last step.
    """

    def __init__(self, start: Diagram, none: Diagram, step: Callable[[Diagram, int], Diagram]) -> None:
        self.step = step
        self.layers: defaultdict[int, Diagram] = defaultdict(lambda: none, {0: start})
        self.seen, self.least, self.took = start, 0, 0.0
        self._closed = none
        self._open = {0}
        self.next()

    def next(self) -> None:
        """Go on to the next layer, without states that were closer."""
        while self._open:
            self.least = min(self._open)
            self.layers[self.least] &= ~self._closed
            if self.layers[self.least].satisfiable():
                return
            self._open.remove(self.least)
        self.least = INFINITE_WEIGHT

    def close(self) -> Diagram:
        """The next layer, which is done with now."""
        layer = self.layers[self.least]
        self._closed |= layer
        self._open.remove(self.least)
        return layer

    def add(self, states: Diagram, distance: int) -> None:
        """Note that states have at most a distance."""
        self.layers[distance] |= states & ~self._closed
        self.seen |= states
        self._open.add(distance)


class Bidirectional:
    """The search for the cheapest plans of a problem from a state.

    Args:
        limit: a weight; plans that weigh as much do not matter.

    Attributes:
        best: what the cheapest plans known weigh, or the limit.

    Raises:
        MemoryError: the diagrams have too many nodes; so do all methods.
    """

    def __init__(self, problem: ClassicalProblem, state: int, limit: int) -> None:
        self._problem, self._state = problem, state
        self._sets = sets = StateSets(problem)
        self._forth = _Side(sets.state(state), sets.none, sets.image)
        self._back = _Side(sets.goal(problem.goal), sets.none, sets.preimage)
        self.best = limit
        self._meet(self._back, sets.state(state), 0)

    def bounds(self) -> Iterator[int]:
        """Search; say after each layer what no plan is below.  ``best`` is the optimum after the last."""
        forth, back, least_step = self._forth, self._back, min(self._sets.weights, default=INFINITE_WEIGHT)
        while (bound := min(forth.least + back.least + least_step, self.best)) < self.best:
            yield bound
            self._expand(*((forth, back) if forth.took <= back.took else (back, forth)))
        yield bound

    def _expand(self, side: _Side, other: _Side) -> None:
        distance, started = side.least, process_time()
        layer = side.close()
        for weight in self._sets.weights:
            if distance + weight < self.best:
                states = side.step(layer, weight)
                side.add(states, distance + weight)
                self._meet(other, states, distance + weight)
        side.next()
        side.took = process_time() - started

    def _meet(self, other: _Side, states: Diagram, distance: int) -> None:
        """Look whether states at a distance in one direction have one in the other."""
        met = states & other.seen
        if met.satisfiable():
            for rest in sorted(other.layers):
                if distance + rest >= self.best:
                    return
                if (met & other.layers[rest]).satisfiable():
                    self.best = distance + rest

    def plan(self) -> list[int]:
        """Of the cheapest plans the one with the smallest operator at each step, by their numbers.

        To be asked after the search, if it has found one.
        """
        state, rest = self._state, self.best
        ends, found = self._optimal_states(), list[int]()
        rows = list(zip(self._problem.operators, self._problem.weights, strict=True))
        while rest:
            number, state, rest = next(
                (number, after, rest - weight)
                for number, (op, weight) in enumerate(rows)
                if rest - weight in ends
                and applicable(op, state)
                and self._sets.contains(ends[rest - weight], after := state & op.keep | op.put)
            )
            found.append(number)
        return found

    def _optimal_states(self) -> dict[int, Diagram]:
        """By what is left to the goal states with so much left: all of those on cheapest plans."""
        forth, back, sets = self._forth, self._back, self._sets
        found = {rest: layer for rest, layer in back.layers.items() if rest <= back.least}
        for rest in sorted(self.best - distance for distance in forth.layers):
            if back.least < rest <= self.best:
                before = (sets.preimage(found[rest - w], w) for w in sets.weights if rest - w in found)
                found[rest] = forth.layers[self.best - rest] & reduce(or_, before, sets.none)
        return found
