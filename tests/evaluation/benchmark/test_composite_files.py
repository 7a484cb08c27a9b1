"""The composite task as one problem: its optimum is composite mode's without a horizon."""

import tempfile
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from search import PreparedTask
from serendipity import Task, example, load_agents, plan
from serendipity.classical import fast_downward
from serendipity.evaluation.benchmark.side_by_side import CONTENDERS
from serendipity.model import Options
from serendipity.pddl.write import composite_files
from serendipity.testing.strategies import tasks

DISCOUNTS = ("0", "0.5", "0.9")


def read_back(task: Task, discount: Fraction) -> tuple[Task, int]:
    """The task of one agent that the files describe, and the scale of its costs."""
    files = composite_files(task, discount)
    with tempfile.TemporaryDirectory() as folder:
        pair = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        for path, text in zip(pair, (files.domain, files.problem), strict=True):
            path.write_text(text)
        return load_agents({"everybody": pair}, human="everybody"), files.scale


@given(tasks(), st.sampled_from(DISCOUNTS))
@settings(max_examples=60)
def test_one_agent_pays_what_the_team_pays(task: Task, discount: str) -> None:
    """With strict interference every epoch's actions can be done one after another."""
    team = plan(task, mode="composite", horizon="inf", discount=discount, interference="strict")
    alone, scale = read_back(task, Fraction(discount))
    answer = plan(alone, mode="individual")
    assert (answer.status == "infeasible") == (team.status == "infeasible")
    if team.cost is not None:
        assert answer.cost == pytest.approx(team.cost * scale)
    assert all(action.cost.denominator == 1 for action in alone.actions)


@pytest.mark.skipif(fast_downward.absent() is not None, reason=fast_downward.absent() or "")
@pytest.mark.parametrize("name", ["room2", "room5", "room7"])
def test_fast_downward_finds_the_same_cost(name: str) -> None:
    task = example(name)
    options = Options(mode="composite", horizon="inf", discount=Fraction("0.9"))
    answer = CONTENDERS["fast-downward"].answer(PreparedTask(task), options)
    assert answer.status == "optimal"
    assert answer.cost == plan(task, mode="composite", horizon="inf", discount="0.9").cost
    assert answer.process_seconds is not None and answer.process_seconds > answer.seconds > 0
    assert answer.memory is not None and answer.memory > 1
