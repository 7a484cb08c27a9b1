"""Posteriors: hand-checked numbers, and laws that hold for any task."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Condition, Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import Alone, Moment, optimal_human_plan
from serendipity_testing.strategies import tasks
from tests.search.modes.goals.strategies import literals, reachable_goals


def fork() -> Task:
    """From a to b directly (1) or by x (3); from x on to y (1); a trap behind b."""
    return build(
        init="a",
        goal="b",
        actions={
            "walk h a b": "a -> b !a",
            "walk h a x": "a -> x !a",
            "walk h x b": "x -> b !x @ 2",
            "walk h x y": "x -> y !x",
            "walk h b trap": "b -> trap !b",
            "help r": "-> helped",
        },
    )


def goals(**priors: float) -> list[dict[str, object]]:
    return [{"name": name, "goal": [name], "prior": prior} for name, prior in priors.items()]


def test_the_formula_by_hand() -> None:
    known = serendipity.recognise(fork(), goals(b=1, y=1, trap=1), ["walk h a b"])
    b, y, trap = known.goals
    assert (b.with_observed, b.without_observed) == (1, 3)
    assert b.likelihood == pytest.approx(1 / (1 + math.exp(-2)))
    assert (y.with_observed, y.without_observed, y.likelihood, y.posterior) == (None, 2, 0.0, 0.0)
    assert (trap.with_observed, trap.without_observed) == (2, 4)
    assert b.posterior == pytest.approx(trap.posterior) == pytest.approx(0.5)
    assert known.explained
    assert b.plan == ("walk h a b",)


def test_beta_scales_the_gain() -> None:
    likelihoods = [
        serendipity.recognise(fork(), goals(b=1), ["walk h a b"], beta).goals[0].likelihood
        for beta in (0, "0.5", 1, 1000)
    ]
    assert likelihoods == pytest.approx([1 / (1 + math.exp(-2 * beta)) for beta in (0, 0.5, 1, 1000)])


def test_a_detour_speaks_against_a_goal() -> None:
    known = serendipity.recognise(fork(), goals(b=1, y=1), ["walk h a x"])
    b, y = known.goals
    assert (b.with_observed, b.without_observed) == (3, 1)
    assert b.likelihood == pytest.approx(1 / (1 + math.exp(2)))
    assert (y.with_observed, y.without_observed, y.likelihood) == (2, None, 1.0)
    assert y.posterior == pytest.approx(1 / (1 + b.likelihood))
    assert known.most_likely is y


def test_observations_may_have_gaps_but_not_another_order() -> None:
    """What nothing explains leaves the priors."""
    by_gap = serendipity.recognise(fork(), goals(y=1), ["walk h x y"])
    assert by_gap.goals[0].likelihood == 1
    assert not serendipity.recognise(fork(), goals(y=1), ["walk h x y", "walk h a x"]).explained
    known = serendipity.recognise(fork(), goals(b=1, y=3), ["walk h a b", "walk h a x"])
    assert (known.explained, known.to_dict()["explained"]) == (False, False)
    assert [(goal.posterior, goal.likelihood) for goal in known.goals] == [(0.25, 0), (0.75, 0)]


def test_unlikely_is_not_impossible() -> None:
    """A gain so negative that its exponential is 0 in floats still explains."""
    known = serendipity.recognise(fork(), goals(b=1), ["walk h a x"], beta=10_000)
    assert known.explained
    assert known.goals[0].posterior == 1
    beside = serendipity.recognise(fork(), goals(b=1, y=0), ["walk h a x"], beta=10_000)
    assert [goal.posterior for goal in beside.goals] == [1, 0]


def test_a_goal_that_nobody_reaches_alone_is_impossible() -> None:
    known = serendipity.recognise(fork(), goals(helped=1, b=1))
    assert (known.goals[0].likelihood, known.goals[0].posterior) == (None, 0)


def test_negative_literals_and_brackets() -> None:
    forms = [{"goal": ["(y)", form], "name": form} for form in ("!a", "(not (a))", "not a", "! (a)")]
    known = serendipity.recognise(fork(), forms)
    assert {goal.goal for goal in known.goals} == {("y", "!a")}
    assert {goal.plan for goal in known.goals} == {("walk h a x", "walk h x y")}


@pytest.mark.parametrize("beta", [-1, "nan", "much"])
def test_beta_has_to_be_a_number(beta: object) -> None:
    with pytest.raises(UsageError, match="beta: expected"):
        serendipity.recognise(fork(), goals(b=1), (), beta)  # type: ignore[arg-type]


@st.composite
def watched(draw: st.DrawFn) -> tuple[Task, list[Condition], list[str]]:
    """Candidate goals, and what the human did on a walk."""
    task = replace(draw(tasks()), robot_goal=Condition())
    wanted = [draw(reachable_goals(task)) for _ in range(draw(st.integers(1, 3)))]
    alone, now, names = Alone(task), Moment(task.init), []
    for _ in range(draw(st.integers(0, 4))):
        ways = list(alone.ways(now))
        if not ways:
            break
        action, _, now, _ = draw(st.sampled_from(ways))
        if draw(st.integers(0, 3)):
            names.append(task.actions[action].name)
    return task, wanted, names


def as_given(task: Task, wanted: list[Condition]) -> list[dict[str, object]]:
    return [{"name": str(i), "goal": literals(task, goal)} for i, goal in enumerate(wanted)]


@given(watched())
def test_posteriors_are_probabilities(case: tuple[Task, list[Condition], list[str]]) -> None:
    task, wanted, names = case
    known = serendipity.recognise(task, as_given(task, wanted), names)
    assert math.isclose(math.fsum(goal.posterior for goal in known.goals), 1)
    assert all(0 <= goal.posterior <= 1 for goal in known.goals)
    gains = sorted(known.goals, key=lambda goal: goal.likelihood or 0)
    if known.explained:  # equal priors: the order is that of the likelihoods
        assert [g.posterior for g in gains] == sorted(g.posterior for g in gains)


@given(watched())
def test_costs_equal_brute_force(case: tuple[Task, list[Condition], list[str]]) -> None:
    task, wanted, names = case
    known = serendipity.recognise(task, as_given(task, wanted), names)
    for goal, answer in zip(wanted, known.goals, strict=True):
        product = _with_memory(task, goal, names)
        for memory, cost in ((True, answer.with_observed), (False, answer.without_observed)):
            remembering = replace(product, goal=_remembers(product, goal, names, all_of=memory))
            worth = Alone(remembering).worth(Moment(product.init))
            assert cost == (None if worth is None else worth[0])
        if not names:
            plan = optimal_human_plan(replace(task, goal=goal))
            assert answer.plan == tuple(task.actions[i].name for i in plan)


def _with_memory(task: Task, goal: Condition, names: list[str]) -> Task:
    """The task compiled: a fact per number of observations that were matched (Ramirez and Geffner)."""
    first = len(task.facts)
    facts = (*task.facts, *(f"matched {n}" for n in range(len(names) + 1)))
    actions = []
    for action in (task.actions[i] for i in task.human_actions):
        for n in range(len(names) + 1):
            after = n + (n < len(names) and names[n] == action.name)
            change = {"add": (*action.add, first + after), "delete": (*action.delete, first + n)}
            if after == n:
                change = {}
            actions.append(replace(action, pre=(*action.pre, first + n), **change))
    init = task.init | {first}
    return replace(task, facts=facts, actions=tuple(actions), init=init, goal=goal)


def _remembers(product: Task, goal: Condition, names: list[str], *, all_of: bool) -> Condition:
    done = len(product.facts) - 1
    if all_of:
        return Condition((*goal.positive, done), goal.negative)
    return Condition(goal.positive, (*goal.negative, done))
