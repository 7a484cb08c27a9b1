"""Random calls of the families are not vacuous: robots have a part in the goals, and help often pays."""

from collections import Counter
from itertools import islice

import pytest

from serendipity import UsageError, plan
from serendipity_testing.generator.calls import PlanCall, random_call
from serendipity_testing.generator.families import FAMILIES
from serendipity_testing.oracle import human_plans


@pytest.fixture(scope="module")
def calls() -> list[PlanCall]:
    """Some of each family."""
    return [call for call in map(random_call, range(600)) if call.task.name in FAMILIES]


@pytest.mark.long
@pytest.mark.parametrize("family", FAMILIES)
def test_help_often_pays(calls: list[PlanCall], family: str) -> None:
    of_family = [call for call in calls if call.task.name == family]
    seen: Counter[str] = Counter()
    for call in of_family:
        try:
            answer = plan(call.task, human_plan=call.human_plan, **call.keywords())
        except UsageError:
            seen["refused"] += 1
            continue
        seen["opportunity" if answer.opportunity else answer.reason or answer.status] += 1
    assert len(of_family) >= 80
    assert seen["opportunity"] >= 0.15 * len(of_family)
    assert seen["optimal"] >= 0.15 * len(of_family)  # no opportunity, or the human alone
    assert seen["refused"] <= 0.1 * len(of_family)
    assert seen["no-human-plan"] >= 1


@pytest.mark.parametrize("family", FAMILIES)
def test_goals_are_shared(calls: list[PlanCall], family: str) -> None:
    tasks = [call.task for call in calls if call.task.name == family]
    kinds: Counter[str] = Counter()
    for task in tasks:
        wanted = {*task.goal.positive, *task.goal.negative}
        theirs = [a for a in task.actions if a.participants != (task.human,)]
        kinds["shared"] += any(wanted.intersection((*a.add, *a.delete)) for a in theirs)
        kinds["joint"] += any(a.joint for a in task.actions)
        kinds["negative"] += any(a.neg for a in task.actions)
        kinds["two robots"] += len(task.robots) == 2
        kinds["goals of robots"] += bool(task.robot_goal)
        kinds["free"] += any(a.cost == 0 for a in task.actions)
        kinds["several plans"] += len(list(islice(human_plans(task), 2))) == 2
    assert kinds["shared"] >= 0.75 * len(tasks)
    for kind, number in kinds.items():
        assert number >= 0.1 * len(tasks), kind


def test_all_that_is_asked_of_others_is_asked_of_families(calls: list[PlanCall]) -> None:
    others = [call for call in map(random_call, range(600)) if call.task.name not in FAMILIES]
    for name in {name for call in others for name in call.options}:
        assert any(name in call.options for call in calls), name
    assert {call.options["mode"] for call in calls} == {call.options["mode"] for call in others}
    assert any(call.options.get("horizon") == "inf" for call in calls)
    assert sum(call.human_plan is not None for call in calls) >= 0.1 * len(calls)
