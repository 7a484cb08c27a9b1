"""A task in which it pays to watch: the first epoch shows what the human wants."""

from typing import Any, Final

import serendipity
from serendipity.model import Result, Task
from serendipity_testing.builders import task as build


def studio() -> Task:
    """p costs 6, or 4 if the robot fetches, with power since epoch 1; z costs 6, or 4 with joint help."""
    return build(
        goal="p",
        actions={
            "begin_p h": "-> sp @ 1",
            "begin_z h": "-> sz @ 1",
            "do_p h": "sp -> p @ 5",
            "do_z h": "sz -> z @ 5",
            "use_p h": "sp qp -> p @ 1",
            "wield_p h": "sp qp -> p @ 1",
            "power r": "-> on @ 1",
            "fetch r": "on -> qp @ 1",
            "together h r": "sz -> z @ 3",
        },
    )


def helped(**options: Any) -> Result:
    """The answer over both goals, in which there is an epoch more than the human needs alone."""
    goals = [{"name": name, "goal": [name]} for name in ("p", "z")]
    return serendipity.plan(studio(), goals=goals, horizon=3, **options)


TWO_ROADS: Final = (
    {"name": "a", "probability": "1/3", "plan": ["go_a h", "rest h", "end_a h"]},
    {"name": "b", "probability": "2/3", "plan": ["go_b h", "rest h", "end_b h"]},
)
"""A library of plans for :func:`two_roads`."""


def two_roads() -> Task:
    """Two optimal plans, over a or over b; where the human has gone the robot can shorten the way."""
    return build(
        goal="p",
        actions={
            "go_a h": "-> a @ 1",
            "go_b h": "-> b @ 1",
            "rest h": "-> rested @ 1",
            "end_a h": "a rested -> p @ 4",
            "end_b h": "b rested -> p @ 4",
            "short_a h": "a rested la -> p @ 1",
            "short_b h": "b rested lb -> p @ 1",
            "lift_a r": "-> la @ 1",
            "lift_b r": "-> lb @ 1",
        },
    )
