"""Bugs where robots' walks are folded into what they walk to."""

from typing import Any

from search.call.context import SearchContext
from search.robots.decoupled import Decoupled, DecoupledSuccessors
from tests.verify.planted.bug import Bug, returning, wrapped


def _short_cut(ways: Any) -> Any:
    def shorter(way: Any) -> Any:
        return way._replace(epochs=way.epochs - 1, cost=way.cost - way.cost // way.epochs)

    return {place: [shorter(w) if w.epochs > 1 else w for w in found] for place, found in ways.items()}


def _take_no_time(original: Any, self: Any, idle: Any, joint_action: Any, state: int) -> Any:
    return original(self, idle, joint_action._replace(agents=0), state)


BUGS = (
    Bug(Decoupled, "ways", "a step shorter", returning(_short_cut)),
    Bug(Decoupled, "ways", "nothing is in reach", returning(lambda ways: dict([*ways.items()][:1]))),
    Bug(DecoupledSuccessors, "rested", "what they do takes no time", wrapped(_take_no_time)),
    Bug(
        SearchContext,
        "walks",
        "whatever the human touches",
        wrapped(lambda walks, self, *_: walks(self, ())),
    ),
    Bug(Decoupled, "steps", "a walk is left out", returning(lambda steps: list(steps)[1:])),
)
