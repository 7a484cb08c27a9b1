"""Achiever costs: the least for robots to provide one need, by where they are.

Distances come from :mod:`search.bounds.achiever_automaton`, whose glossary holds here, too.
"""

from typing import TYPE_CHECKING, NamedTuple

from search.packed.cost_vector import INFINITE_KEY

if TYPE_CHECKING:
    from search.bounds.achiever_automaton import AchieverAutomaton

Spot = tuple[int, int, int, int]
"""Value of the field, team of the last op on it, tracked robot's bit, its place.
Robot 0 stands for "any robot that did not take part in the last op"."""

Label = tuple[int, int, int]
"""A spot wherever the robot is."""

Teams = tuple[tuple[int, tuple[int, ...], bool], ...]
"""Teams, robots that may be tracked after them by their order among all, and whether any one of
those will do (team 0 stands for no team)."""


class AutomatonNode:
    """A spot that was met.

    Attributes:
        spot: which one.
        cost: its least cost from the initial state, -1 until it has been settled.
        edges: what leads to it, backward: weight, and from where.
    """

    __slots__ = ("cost", "edges", "spot")

    def __init__(self, spot: Spot) -> None:
        self.spot = spot
        self.cost = -1
        self.edges: list[tuple[int, AutomatonNode]] = []


class _Robot(NamedTuple):
    """A robot's part of :class:`AchieverCosts`: bit, place, fields it depends on, what is known."""

    bit: int
    place: int
    mask: int
    known: dict[int, tuple[tuple[int, ...], int]]


class AchieverCosts:
    """Least robots' weight from a packed state to provide one need.

    What was not explored is too dear for a state in which robots
    have paid for getting there.  Where it stopped walking, since all that can happen to the
    field is within reach, the least of what it knows stands for the rest.

    Args:
        automaton: what was explored.
        found: distance by spot, a key increment.
        elsewhere: the least one by label, where walking stopped.
    """

    def __init__(
        self, automaton: "AchieverAutomaton", found: dict[AutomatonNode, int], elsewhere: dict[Label, int]
    ) -> None:
        places, self._field = automaton.places.items(), automaton.field
        self._automaton, self._found, self._elsewhere = automaton, found, elsewhere
        self._alone = len(places) == 1
        self._robots = [_Robot(robot, place, self._field | place, {}) for robot, place in places]

    def __call__(self, state: int) -> int:
        """The bound from a packed state."""
        value = state & self._field
        if self._alone or value == self._automaton.unchanged:
            best = INFINITE_KEY
            for robot in self._robots:
                _, least = self._at(robot, state)
                if least < best:
                    best = least
            return best
        best, rows = INFINITE_KEY, [self._at(robot, state)[0] for robot in self._robots]
        for i, (_, members, each) in enumerate(self._automaton.teams(value)):
            weights = [rows[j][i] for j in members]
            best = min(best, max(weights) if each else min(weights))
        return best

    def each(self, state: int) -> list[int]:
        """The same for each robot, if it is the first to act; in the order of ``task.robots``."""
        return [self._at(robot, state)[1] for robot in self._robots]

    def _at(self, robot: "_Robot", state: int) -> tuple[tuple[int, ...], int]:
        """The bounds if a robot is the first to act, after each team that may have acted; the least."""
        return robot.known.get(state & robot.mask) or self._look(robot, state)

    def _look(self, robot: "_Robot", state: int) -> tuple[tuple[int, ...], int]:
        value, place = state & self._field, state & robot.place
        teams = self._automaton.teams(value)
        row = tuple([self._after(value, team, robot.bit, place) for team, *_ in teams])
        found = robot.known[state & robot.mask] = row, min(row, default=INFINITE_KEY)
        return found

    def _after(self, value: int, team: int, robot: int, place: int) -> int:
        tracked = not team or bool(team & robot)
        node = self._automaton.settled((value, team, robot, place) if tracked else (value, team, 0, 0))
        if node is not None:
            return self._found.get(node, INFINITE_KEY)
        return self._elsewhere.get((value, team, robot), INFINITE_KEY) if tracked else INFINITE_KEY
