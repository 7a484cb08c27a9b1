"""A local human's plan alone is found as fast as anybody's, though every fact is one by itself for them."""

import pytest

from search import PreparedTask
from search.human.individual_planner import canonical
from search.kernel.library import library
from search.modes.simulation.human import Human
from serendipity.model import Options
from serendipity.testing.countdown import Countdown
from tests.search.small_tasks import tower

BLOCKS = "abcdef"


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize("model", ["observant", "local"])
def test_a_tower_that_is_turned_over(model: str) -> None:
    task, looks = tower(BLOCKS, "hr"), Countdown(10**6)
    human = Human(PreparedTask(task), Options(), looks, human_model=model)
    looks.left_over[0] = 1000  # whoever looks at every fact by itself asks for ten times as much
    plan = canonical(human.alone, human.packed.init)
    assert task.cost_of(plan) == 2 * len(BLOCKS)
