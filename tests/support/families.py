"""Tasks of the families that ``crosscheck`` draws from, in any size: what heuristics are tried on."""

from random import Random

from serendipity.evaluation.crosscheck.families import AGENTS, FAMILIES
from serendipity.model import Task


def family_task(name: str, seed: int, size: int, agents: int = 2) -> Task:
    """A task whose goals are on what all agents change; equal arguments give equal tasks.

    Args:
        name: ``blocks``, ``logistics`` or ``switches``.
        seed: decides all that the others leave open.
        size: how many blocks (at least 2), parcels (1) or switches (3).
        agents: how many, the human included; at most 3.
    """
    return FAMILIES[name](Random(f"{name} {seed}"), size, AGENTS[:agents])
