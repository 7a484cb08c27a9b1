"""Bugs where robots' walks are folded into what they walk to."""

from typing import Any

from search.packed.successor_generator import Idle, JointAction, in_time
from search.robots.decoupled import Decoupled, DecoupledSuccessors
from tests.verify.planted.bug import Bug, always, everywhere, replaced, wrapped


def _short_cut(original: Any, self: Decoupled, slot: int, here: int, there: int) -> int:
    steps: int = original(self, slot, here, there)
    return steps - 1 if steps > 1 else steps


def _deeds_take_no_time(
    original: Any, self: DecoupledSuccessors, idle: Idle, option: JointAction, state: int
) -> Idle:
    found: Idle = original(self, idle, option._replace(due=()), state)
    return found


def _stays(original: Any, self: Decoupled, node: Any) -> Any:
    return list(original(self, node))[1:]


BUGS = (
    Bug("walks: in_time", "robots need no time to walk", everywhere(in_time, always(True))),
    Bug("walks: distance", "a step shorter", wrapped(Decoupled, "distance", _short_cut)),
    Bug("walks: distance", "nothing is in reach", replaced(Decoupled, "distance", always(-1))),
    Bug("walks: rested", "deeds take no time", wrapped(DecoupledSuccessors, "rested", _deeds_take_no_time)),
    Bug(
        "walks: touched_by", "nobody minds where robots are", replaced(Decoupled, "touched_by", always(False))
    ),
    Bug("walks: steps", "a walk is not written down", wrapped(Decoupled, "steps", _stays)),
)
