"""Families of random tasks as in planning competitions: all work on the same things, which goals are about.

Equal dice give equal tasks, of any size.
"""

from collections.abc import Callable, Mapping
from random import Random
from typing import Final

from serendipity.evaluation.crosscheck.families.blocks import blocks
from serendipity.evaluation.crosscheck.families.logistics import logistics
from serendipity.evaluation.crosscheck.families.switches import switches
from serendipity.model import Task

__all__ = ["AGENTS", "FAMILIES", "SMALL"]

AGENTS: Final = ("hum", "rob", "bot")

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
