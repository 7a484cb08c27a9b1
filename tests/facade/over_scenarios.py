"""Answers over scenarios under rules of help, held against brute force."""

import pytest

import serendipity
from search.modes.scenarios import Candidate
from serendipity import Options, Result, Task, UsageError
from serendipity.testing.oracle.scenarios import best_policy
from tests.search.modes.scenarios.test_in_time import library


def as_brute_force_has_it(
    task: Task, options: Options, candidates: list[Candidate], horizon: int
) -> Result | None:
    """The answer; None where the one without the rule comes first, beside plans that are not optimal."""
    expected = best_policy(task, options, candidates, horizon)
    given_options = {name: getattr(options, name) for name in options.__dataclass_fields__}
    try:
        answer = serendipity.plan(task, plans=library(task, candidates), **given_options)
    except UsageError as error:
        assert "where several ask for a fact to be false" in str(error)
        return None
    assert answer.status == "optimal"
    if answer.saving_alone and not answer.statistics.get("rule_binds"):
        return None
    assert (answer.objective, answer.cost) == pytest.approx((float(expected.objective), float(expected.cost)))
    assert answer.opportunity == expected.opportunity
    return answer
