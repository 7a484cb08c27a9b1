"""The helpers of docs/howto/league.md, as strangers have them, answer as they should."""

import sys
from pathlib import Path

import pytest

from serendipity_testing.league import league

EXAMPLES = Path(__file__).parents[3] / "docs" / "examples" / "league"


STRANGERS = {
    "nearest": (f"command:{sys.executable} {EXAMPLES / 'nearest.py'}", "json"),
    "tree": ("python:tree:helper", "py_trees"),
    "learner": ("pettingzoo:learner:train", "pettingzoo"),
}


def helper_of(name: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name by which the league knows it; its learner does not learn for long."""
    helper, needs = STRANGERS[name]
    pytest.importorskip(needs)
    monkeypatch.syspath_prepend(EXAMPLES)
    if name == "learner":
        import learner

        monkeypatch.setattr(learner, "EPISODES", 40)
    return helper


@pytest.mark.long
@pytest.mark.parametrize("name", STRANGERS)
def test_helpers_of_the_documentation_play(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    helper = helper_of(name, monkeypatch)
    found = league("spring", [helper], families=["buildings", "competition"], cases=1, deadline=5)
    (one,) = found.standings()
    assert (one.cases, one.bad, one.in_time) == (2, 0, 1)


@pytest.mark.long
@pytest.mark.parametrize("name", STRANGERS)
def test_the_same_seeds_give_them_the_same_rows(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the learner knew depended on how fast it was."""
    helper = helper_of(name, monkeypatch)
    one, other = (
        league("spring", [helper], families=["homes", "competition"], cases=2, deadline=None)
        for _ in range(2)
    )
    assert one.rows == other.rows
    assert len(one.rows) == 4
