"""Composite plans, an epoch put together agent by agent, where the bound on the team is about sequences."""

from fractions import Fraction

import pytest

from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Progress, best_first
from search.packed.cost_vector import INFINITE_KEY
from search.call.prepared_task import PreparedTask
from search.spaces.factory import joint_space
from search.spaces.stepwise import Stepwise
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task

BOX = task(
    agents="hum rob",
    human="hum",
    init="free",
    goal="lid box",
    actions={
        "close hum": "free -> lid !free",
        "cover hum": "-> lid @ 2",
        "pack rob": "free -> box",
        "open rob": "lid -> !lid free @ 5",
    },
)


@pytest.mark.parametrize(("interference", "least"), [("paper", Fraction(3, 2)), ("strict", Fraction(5, 2))])
def test_what_one_takes_from_another_is_there_in_the_same_epoch(interference: str, least: Fraction) -> None:
    options = Options(mode="composite", horizon=1, discount="0.5", interference=interference)
    context = SearchContext(PreparedTask(BOX), options, Deadline())
    if context.team is None:
        pytest.skip("bounds on the team need the kernel")
    space, best = joint_space(context, 1, INFINITE_KEY), Incumbent(INFINITE_KEY)
    assert isinstance(space, Stepwise)
    for _ in best_first(space, best, Progress(), Deadline()):
        pass
    assert context.keys.cost(best.key) == least
