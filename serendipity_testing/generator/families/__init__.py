"""Families of random tasks as in planning competitions: all work on the same things, which goals are about.

Equal dice give equal tasks, of any size.
"""

from collections.abc import Callable, Mapping
from random import Random
from typing import Final

from serendipity.model import Task
from serendipity_testing.generator.families.blocks import blocks
from serendipity_testing.generator.families.logistics import logistics
from serendipity_testing.generator.families.switches import switches

__all__ = ["AGENTS", "FAMILIES", "SMALL", "family_task"]

AGENTS: Final = ("hum", "rob", "bot", "pal")

FAMILIES: Final[Mapping[str, Callable[[Random, int, tuple[str, ...]], Task]]] = {
    "blocks": blocks,
    "logistics": logistics,
    "switches": switches,
}
"""Made of dice, a size (the number of blocks, parcels or switches) and agents, the human first."""

SMALL: Final[Mapping[str, tuple[tuple[int, int], ...]]] = {
    "blocks": ((2, 3), (3, 2), (3, 2), (3, 3)),
    "logistics": ((1, 2), (1, 3), (2, 2), (2, 2)),
    "switches": ((3, 2), (4, 2), (4, 3), (5, 2), (5, 3)),
}
"""Sizes and numbers of agents of tasks that brute force can answer."""


def family_task(name: str, seed: int, size: int, agents: int = 2) -> Task:
    """A task whose goals are on what all agents change; equal arguments give equal tasks.

    Args:
        name: ``blocks``, ``logistics`` or ``switches``.
        seed: decides all that the others leave open.
        size: how many blocks (at least 2), parcels (1) or switches (3).
        agents: how many, the human included; at most 4.
    """
    return FAMILIES[name](Random(f"{name} {seed}"), size, AGENTS[:agents])
