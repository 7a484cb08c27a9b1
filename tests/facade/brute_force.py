"""Answers under rules of help, held against brute force."""

from typing import Any

import pytest
from hypothesis import assume
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity import Options, Result, Task, UsageError
from serendipity.testing.oracle import best
from serendipity.testing.oracle.scenarios import best_policy
from tests.search.modes.scenarios.test_in_time import library

_FREE = st.sampled_from([None, None, "at *"])
_SILENT = {"suffix": st.just("replan"), "preservation": st.just("kernel")}
RULES: dict[str, st.SearchStrategy[dict[str, Any]]] = {
    "nobody pays": st.fixed_dictionaries(
        {
            "nobody_pays": st.sampled_from([None, True]),
            "leave_free": st.sampled_from([None, "nothing", "at *", "*0*"]),
            **_SILENT,
        }
    ),
    "noticed": st.fixed_dictionaries({"noticed": st.just(True), "leave_free": _FREE, **_SILENT}),
    "disturbance": st.fixed_dictionaries(
        {
            "max_disturbance": st.sampled_from([0, "0.5", 1, 2, 3]),
            "disturbance": st.sampled_from([None, "ask=2", "sight=1", "meet=1, ask=0.5"]),
            "leave_free": _FREE,
        }
    ),
    "leftovers": st.fixed_dictionaries(
        {
            "leave_price": st.sampled_from(["*=0.31", "at *=0.17, lit *=0.53, *=2.9", "*0*=0.07, *=1.13"]),
            "leave_free": st.sampled_from([None, "at r*"]),
        }
    ),
}
"""Options of each rule of help (semantics 12 to 14)."""

_UNSAID = "where several ask for a fact to be false"
"""What effects can't say of strict interference is refused."""


def _keywords(options: Options) -> dict[str, Any]:
    return {name: getattr(options, name) for name in options.__dataclass_fields__}


def proved_as_brute_force_has_it(task: Task, options: Options) -> Result:
    """The answer, which is proved; no example where effects can't say what is asked for."""
    expected = best(task, options)
    try:
        answer = serendipity.plan(task, **_keywords(options))
    except UsageError as error:
        assume(_UNSAID not in str(error))
        raise
    if expected.cost is None or expected.objective is None:
        assert answer.status == expected.status
        return answer
    found = (answer.status, answer.cost, answer.objective, answer.opportunity)
    assert found == (expected.status, float(expected.cost), float(expected.objective), expected.opportunity)
    assert serendipity.verify(task, answer).verdict == "proved"
    return answer


def policy_as_brute_force_has_it(
    task: Task, options: Options, candidates: list[Candidate], horizon: int
) -> Result | None:
    """The answer; None where the one without the rule comes first, beside plans that are not optimal."""
    expected = best_policy(task, options, candidates, horizon)
    try:
        answer = serendipity.plan(task, plans=library(task, candidates), **_keywords(options))
    except UsageError as error:
        assert _UNSAID in str(error)
        return None
    assert answer.status == "optimal"
    if answer.saving_alone and not answer.statistics.get("rule_binds"):
        return None
    assert (answer.objective, answer.cost) == pytest.approx((float(expected.objective), float(expected.cost)))
    assert answer.opportunity == expected.opportunity
    return answer
