"""``plan_anytime``: objectives never rise but where the first window begins to count, bounds never fall."""

from itertools import pairwise

import serendipity
from serendipity import Result, UsageError
from serendipity.evaluation.crosscheck import random_call

CALLS = 150


def better_or_closer(before: Result, after: Result) -> bool:
    """Whether an answer is as good as the one before it, and known at least as well."""
    assert before.objective is not None and after.objective is not None
    assert before.lower_bound is not None and after.lower_bound is not None
    assert before.cost is not None and after.cost is not None
    if before.window is None and after.window is not None:
        return after.cost < before.cost and after.lower_bound >= before.lower_bound
    return after.objective <= before.objective and after.lower_bound >= before.lower_bound


def test_answers_to_random_calls_get_better() -> None:
    improved = opened = 0
    for seed in range(CALLS):
        call = random_call(seed)
        try:
            given = serendipity.plan_anytime(call.task, human_plan=call.human_plan, **call.keywords())
            answers = [answer for answer in given if answer.plan is not None]
        except UsageError:
            continue  # a call that has to name a horizon
        for before, after in pairwise(answers):
            assert better_or_closer(before, after), f"seed {seed}"
            improved += before.cost != after.cost
            opened += before.window is None and after.window is not None
    assert improved >= 20 and opened >= 10


def test_the_first_window_raises_the_objective_by_its_weight() -> None:
    answers = list(serendipity.plan_anytime(serendipity.example("room2"), discount=0.6))
    told = dict.fromkeys((answer.objective, answer.cost) for answer in answers)
    assert list(told) == [(13.0, 13.0), (1012.6, 12.6)]
