"""The helpers of docs/howto/league.md, as strangers have them, answer as they should."""

import sys
from pathlib import Path

import pytest

from serendipity.testing.league import league

EXAMPLES = Path(__file__).parents[3] / "docs" / "examples" / "league"


@pytest.mark.long
@pytest.mark.parametrize(
    ("helper", "needs"),
    [
        (f"command:{sys.executable} {EXAMPLES / 'nearest.py'}", "json"),
        ("python:tree:helper", "py_trees"),
        ("pettingzoo:learner:train", "pettingzoo"),
    ],
    ids=["nearest", "tree", "learner"],
)
def test_helpers_of_the_documentation_play(helper: str, needs: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip(needs)
    monkeypatch.syspath_prepend(EXAMPLES)
    if needs == "pettingzoo":
        import learner

        monkeypatch.setattr(learner, "SECONDS", 0.5)
    found = league("spring", [helper], families=["buildings", "competition"], cases=1, deadline=5)
    (one,) = found.standings()
    assert (one.cases, one.bad, one.in_time) == (2, 0, 1)
