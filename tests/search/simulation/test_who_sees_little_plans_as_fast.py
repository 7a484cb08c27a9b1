"""A local human's plan alone is found as fast as anybody's, though every fact is one by itself for them."""

from itertools import pairwise, permutations

import pytest

from search import PreparedTask
from search.human.individual_planner import canonical
from search.kernel.library import library
from search.modes.simulation.human import Human
from serendipity.model import Options, Task
from serendipity.testing.builders import task as build
from serendipity.testing.countdown import Countdown

BLOCKS = "abcdef"


def _blocks() -> Task:
    """A tower to be turned over, by a hand of the human's or of the robot's."""
    actions = {}
    for hand in "hr":
        for x in BLOCKS:
            actions[f"lift {hand} {x}"] = f"clear_{x} table_{x} {_grip(hand, x)} !table_{x}"
            actions[f"drop {hand} {x}"] = (
                f"held_{hand}_{x} -> !held_{hand}_{x} free_{hand} clear_{x} table_{x}"
            )
        for x, y in permutations(BLOCKS, 2):
            actions[f"take {hand} {x} {y}"] = f"clear_{x} on_{x}_{y} {_grip(hand, x)} !on_{x}_{y} clear_{y}"
            actions[f"put {hand} {x} {y}"] = (
                f"held_{hand}_{x} clear_{y} -> !held_{hand}_{x} free_{hand} clear_{x} on_{x}_{y} !clear_{y}"
            )
    tower = [f"on_{x}_{y}" for x, y in pairwise(BLOCKS)]
    turned = [f"on_{y}_{x}" for x, y in pairwise(BLOCKS)]
    init = ["free_h", "free_r", f"clear_{BLOCKS[0]}", f"table_{BLOCKS[-1]}", *tower]
    return build(init=" ".join(init), goal=" ".join(turned), actions=actions)


def _grip(hand: str, x: str) -> str:
    return f"free_{hand} -> !clear_{x} held_{hand}_{x} !free_{hand}"


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize("model", ["observant", "local"])
def test_a_tower_that_is_turned_over(model: str) -> None:
    task, looks = _blocks(), Countdown(10**6)
    human = Human(PreparedTask(task), Options(), looks, human_model=model)
    looks.left_over[0] = 1000  # whoever looks at every fact by itself asks for ten times as much
    plan = canonical(human.alone, human.packed.init)
    assert task.cost_of(plan) == 2 * len(BLOCKS)
