"""Where the planner forgets what is due, some of its answers are refuted."""

from random import Random
from typing import Any

import pytest
from hypothesis import Phase, find, settings

import serendipity
from search.packed.due import Due
from search.packed.joint_actions import NOTHING
from serendipity.model import SerendipityError
from serendipity_testing.call import Call
from serendipity_testing.strategies.time import calls_in_time

BUGS: dict[str, tuple[str, Any, int]] = {
    "the human may leave what goes on": ("human", lambda *_: None, 12),
    "nobody else goes on, or is there": ("others", lambda *_: [NOTHING], 8),
    "all is over when the goal holds": ("may_end", lambda *_: True, 12),
}
"""What is forgotten, and a seed with which a call that shows it is drawn soon."""


def is_refuted(call: Call) -> bool:
    """Whether the planner answers a call, and the verifier refutes that."""
    try:
        found = serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
    except (SerendipityError, AssertionError, RecursionError):
        return False
    return serendipity.verify(call.task, found).verdict == "refuted"


@pytest.mark.long
@pytest.mark.parametrize("name", BUGS)
def test_a_planner_that_forgets_what_is_due_is_refuted(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    method, bug, seed = BUGS[name]
    calls = calls_in_time(modes=("serendipity", "composite"))
    monkeypatch.setattr(Due, method, bug)
    chosen = settings(max_examples=1000, database=None, phases=[Phase.generate], deadline=None)
    found = find(calls, is_refuted, settings=chosen, random=Random(seed))
    monkeypatch.undo()
    assert not is_refuted(found)
