"""What a robot does, with names: a way that is told up to exchanging things, made for chosen things."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

from search.short_windows.independent.alike.robot import Edge, Place, Robot
from search.packed.operators import Operator


class _Step(NamedTuple):
    op: Operator
    place: Place
    fresh: frozenset[int]
    """The counted fields that have been set by it."""


def lifted(robot: Robot, edges: Sequence[Edge], chosen: Collection[int]) -> list[Operator] | None:
    """Operators along edges that set the chosen fields; None where it does not work out.

    Args:
        robot: the robot.
        edges: from the start on.
        chosen: counted fields.
    """
    left, place, found = set(chosen), robot.start, list[Operator]()
    for edge in edges:
        step = _step(robot, place, edge, left)
        if step is None:
            return None
        left -= step.fresh
        place = step.place
        found.append(step.op)
    return None if left else found


def _step(robot: Robot, place: Place, edge: Edge, left: Collection[int]) -> _Step | None:
    """What is worth most of what leads along an edge."""
    steps = []
    for op, amount in robot.able(place.state):
        after, counts = robot.after(place, op)
        if amount == edge.amount and counts == edge.counts:
            steps.append(_Step(op, after, after.seen_to - place.seen_to))
    steps.sort(key=lambda step: _worth(robot, step, left), reverse=True)
    return next((step for step in steps if robot.block(step.place) == edge.target), None)


def _worth(robot: Robot, step: _Step, left: Collection[int]) -> tuple[int, int]:
    """How many chosen fields a step sets, and how many are of things that one comes to."""
    return len(step.fresh.intersection(left)), len(robot.counted_in(step.place.state) & set(left))
