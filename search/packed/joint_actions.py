"""What agents do together in one epoch."""

from typing import NamedTuple

from search.packed.operators import Operator


class JointAction(NamedTuple):
    """One agent's applicable action, or several robots' at once, in some state."""

    weight: int
    keep: int
    put: int
    actions: tuple[int, ...]
    agents: int
    """Bit set of the agents that are busy with it."""
    due: tuple[tuple[int, int], ...] = ()
    """Where walks are folded (``search.robots.decoupled``): slots of robots, and for how long they have
    to have been idle."""


Idle = tuple[int, ...]
"""Per slot for how long a robot has been idle; empty where walks are not folded."""

NOTHING = JointAction(0, -1, 0, (), 0)
"""Everybody waits."""


def as_option(op: Operator, weight: int) -> JointAction:
    """One op as what an agent may do."""
    return JointAction(weight, op.keep, op.put, (op.action,), op.agents)


def together(a: JointAction, b: JointAction) -> JointAction:
    """Both in one epoch."""
    if a is NOTHING:
        return b
    return JointAction(
        a.weight + b.weight,
        a.keep & b.keep,
        a.put | b.put,
        a.actions + b.actions,
        a.agents | b.agents,
        a.due + b.due,
    )
