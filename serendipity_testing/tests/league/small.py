"""A person at a door, whom a robot may let in or lock out, and helpers of a few words."""

import time
from typing import Any

from serendipity_testing import task
from serendipity_testing.league import Score, league

DOOR = task(
    agents="ann robot",
    human="ann",
    init="outside",
    goal="inside",
    actions={
        "come ann": "outside -> there !outside",
        "open ann": "there -> open @ 3",
        "enter ann": "there open !barred -> inside",
        "climb ann": "there -> inside @ 9",
        "wave ann": "outside -> waved @ 7",
        "unlock robot": "-> open",
        "bar robot": "-> barred",
    },
    name="door",
)
"""She pays 5 alone, in three epochs, and 2 if the robot has unlocked the door by then."""

ALONE, LEAST = 5, 2


def at_the_door(helper: Any, **asked: Any) -> Score:
    (row,) = league("small", [helper], tasks=[DOOR], **asked).rows
    return row


def does(action: str) -> Any:
    """A helper that does one thing whenever it can."""

    def helper(seen: dict[str, Any]) -> Any:
        return {"actions": {"robot": action if action in seen["legal"]["robot"] else None}}

    return helper


def dozes(_: dict[str, Any]) -> None:
    time.sleep(0.1)
