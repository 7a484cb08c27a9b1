"""In each shipped domain somebody finds a thing done that they were about to do, and that is proved."""

import pytest

import serendipity

SAVED = {"parcels": (12, 10.5, 6), "flights": (20, 14, 4), "taxis": (14, 8.5, 6)}
SAVED |= {"morning": (40, 35, 15), "office": (34, 30, 13)}  # in time
"""What the human pays alone, what the team pays at discount 0.5, and when the window is."""


@pytest.mark.parametrize("name", SAVED)
def test_there_is_an_opportunity_and_a_certificate(name: str) -> None:
    task = serendipity.example(name)
    result = serendipity.plan(task, discount="0.5")
    assert result.status == "optimal" and result.opportunity
    assert result.window is not None and result.window.end == result.window.start + 1
    assert (result.human_cost, result.cost, result.window.start) == SAVED[name]
    assert result.realised == ({} if task.needs_time else {"observant": True})
    assert serendipity.verify(task, result).verdict == "proved"


@pytest.mark.parametrize("name", SAVED)
def test_every_action_is_its_agents_alone(name: str) -> None:
    assert not any(action.joint for action in serendipity.example(name).actions)


def test_all_three_taxis_act() -> None:
    result = serendipity.plan(serendipity.example("taxis"), discount="0.5")
    assert {agent for step in result.plan or () for agent in step.agents} == {"tom", "uno", "due"}
