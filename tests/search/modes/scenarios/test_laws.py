"""Laws of semantics 11, on tasks of any size; windows of one epoch are the shortest, or length is free."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Condition, Options, Task
from serendipity.model.keywords import CHOICES, Risk
from serendipity_testing.strategies import Call, calls
from tests.search.modes.goals.strategies import literals
from tests.search.modes.scenarios.strategies import scenarios
from tests.search.modes.scenarios.test_policies_equal_brute_force import solved

_SCENARIOS = scenarios(predicted=True)
_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0", "0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["1000", "0"]),
    interference=st.sampled_from(["paper", "strict"]),
    policy=st.sampled_from(CHOICES["policy"]),
    risk=st.sampled_from(CHOICES["risk"]),
)
Given = tuple[Task, list[Candidate]]


def figures(task: Task, options: Options, candidates: list[Candidate]) -> tuple[object, ...]:
    answer = solved(task, options, candidates)
    return answer.objective, answer.cost, answer.baseline, answer.opportunity


@pytest.mark.long
@pytest.mark.parametrize("risk", CHOICES["risk"])
@given(_SCENARIOS, _OPTIONS)
@settings(max_examples=40)
def test_watching_is_no_worse_than_commitment(risk: Risk, asked: Given, options: Options) -> None:
    watching, fixed = (
        solved(asked[0], options.but(policy=policy, risk=risk), asked[1]) for policy in ("watching", "fixed")
    )
    assert watching.cost <= fixed.cost
    assert watching.baseline == fixed.baseline


@pytest.mark.long
@given(_SCENARIOS, _OPTIONS)
@settings(max_examples=60)
def test_knowing_is_no_worse_than_watching(asked: Given, options: Options) -> None:
    task, candidates = asked
    last = max(len(candidate.plan) for candidate in candidates)
    known = options.but(policy="watching", risk="mean", horizon=last)
    alone = [solved(task, known, [replace(one, weight=Fraction(1))]).cost for one in candidates]
    mean = sum((one.weight * cost for one, cost in zip(candidates, alone, strict=True)), Fraction(0))
    assert mean <= solved(task, known, candidates).cost
    assert max(alone) <= solved(task, known.but(risk="worst"), candidates).cost
    assert solved(task, known.but(risk="regret"), candidates).cost >= 0


@pytest.mark.long
@given(_SCENARIOS, _OPTIONS)
@settings(max_examples=60)
def test_parts_of_a_scenario_are_one(asked: Given, options: Options) -> None:
    task, (first, *others) = asked
    parts = [
        replace(first, weight=first.weight * share, name=str(share))
        for share in map(Fraction, ("1/3", "2/3"))
    ]
    assert figures(task, options, [*parts, *others]) == figures(task, options, [first, *others])


@given(_SCENARIOS, _OPTIONS)
@settings(max_examples=60)
def test_order_and_names_make_no_difference(asked: Given, options: Options) -> None:
    task, candidates = asked
    last = len(task.facts) - 1

    def there(facts: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(sorted(last - f for f in facts))

    def moved(goal: Condition) -> Condition:
        return Condition(there(goal.positive), there(goal.negative))

    names = {name: f"act{k:02}" for k, name in enumerate(dict.fromkeys(a.name for a in task.actions))}
    actions = (
        replace(
            a,
            name=names[a.name],
            pre=there(a.pre),
            neg=there(a.neg),
            add=there(a.add),
            delete=there(a.delete),
        )
        for a in task.actions
    )
    other = replace(
        task,
        facts=tuple(f"fact{f}" for f in range(last + 1)),
        init=frozenset(there(tuple(task.init))),
        goal=moved(task.goal),
        actions=tuple(actions),
    )
    turned = [replace(c, goal=moved(c.goal), name=f"other {c.name}") for c in reversed(candidates)]
    assert figures(other, options, turned) == figures(task, options, candidates)


@given(calls(modes=("serendipity",), ties=False))
def test_one_goal_is_section_3(call: Call) -> None:
    named = [{"name": "it", "goal": literals(call.task, call.task.goal)}]
    options = call.options.to_dict()
    plain = serendipity.plan(call.task, **options)
    answer = serendipity.plan(call.task, goals=named, **options)
    expected, got = plain.to_dict(), answer.to_dict()
    expected.pop("statistics"), got.pop("statistics")
    if plain.reason == "no-human-plan":
        assert (answer.status, answer.reason) == ("infeasible", "no-human-plan")
    else:
        assert got == expected
