"""Each reason of each epoch is true of the run that it stands in."""

import pytest

import serendipity
from serendipity_testing.generator import random_call
from tests.execution.reasons import untrue
from verify.base.optimal_plans import OptimalPlans

PEOPLE = ("observant", "local", "noisy:0.3", "omniscient")


@pytest.mark.parametrize(
    "seeds", [range(20), pytest.param(range(20, 100), marks=pytest.mark.slow)], ids=["some", "many"]
)
@pytest.mark.parametrize("human", PEOPLE)
@pytest.mark.parametrize("faults", [None, "fail=0.2,slow=0.2,drop=0.05"])
def test_in_random_runs(human: str, faults: str | None, seeds: range) -> None:
    kinds = set()
    for seed in seeds:
        task = random_call(seed).task
        oracle = OptimalPlans(task)
        discount = ("0.5", "0.9")[seed % 2]
        options = {"discount": discount, "faults": faults, "epochs": 30, "leave_free": "*"}
        runs = serendipity.execute(task, human, seed=seed, **options)
        assert not list(untrue(task, runs.logs[0], oracle.cost)), f"random_call({seed})"
        kinds |= {event["decision"]["because"]["kind"] for event in runs.logs[0][1:] if "decision" in event}
    assert kinds >= {"pays", "done", "no-help"}
