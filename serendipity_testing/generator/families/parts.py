"""Parts that the families share: pairs of agents, prices, goals."""

from collections.abc import Callable, Sequence
from itertools import combinations
from random import Random
from typing import Final

from serendipity.model import Task
from serendipity_testing.builders import Builder

_COSTS: Final = ("1", "1", "2", "3", "0", "0.5", "0.1", "2.5")


def pairs(agents: Sequence[str]) -> list[tuple[int, int]]:
    """The pairs of agents."""
    return list(combinations(range(len(agents)), 2))


def prices(dice: Random) -> Callable[[], str]:
    """Prices of actions: all the same, which makes for ties, or anything."""
    return (lambda: "1") if dice.random() < 0.5 else lambda: dice.choice(_COSTS)


def negated(literals: str) -> str:
    """Each literal's negation."""
    return " ".join(word[1:] if word[0] == "!" else f"!{word}" for word in literals.split())


def with_goals(
    dice: Random, builder: Builder, start: Sequence[str], goal: Sequence[str], wishes: Sequence[str]
) -> Task:
    """The task; now and then robots have a goal of their own, which is one of the wishes."""
    theirs = dice.choice(wishes) if wishes and dice.random() < 0.15 else ""
    return builder.task(" ".join(start), " ".join(goal), theirs)
