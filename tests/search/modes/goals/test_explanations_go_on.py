"""An explainer that is asked again after each action says what one that is asked for the first time says."""

from collections.abc import Iterator
from random import Random

from hypothesis import given
from hypothesis import strategies as st

from search import PreparedTask
from search.modes.goals import Explainer
from serendipity.model import Condition, Task
from serendipity.model.task.actions import apply
from serendipity_testing.strategies import tasks, usar_tasks


def _walk(task: Task, dice: Random, epochs: int) -> Iterator[tuple[list[str], frozenset[int]]]:
    """What was observed of a human who does anything, and the state, action by action."""
    observed, state = list[str](), task.init
    for _ in range(epochs):
        possible = [i for i in task.human_actions if task.actions[i].applicable(state)]
        if not possible:
            return
        action = task.actions[dice.choice(possible)]
        observed.append(action.name)
        state = apply(state, action)
        yield observed, state


@given(st.one_of(tasks(), usar_tasks()), st.integers(0, 2**32))
def test_action_by_action(task: Task, seed: int) -> None:
    dice = Random(seed)
    goals = [task.goal, *(Condition((fact,)) for fact in dice.choices(range(len(task.facts)), k=2))]
    asked, quick = (Explainer(PreparedTask(task), goals) for _ in range(2))
    for epoch, (observed, _) in enumerate(_walk(task, dice, 5)):
        if epoch != 2:
            fresh = Explainer(PreparedTask(task), goals).explain(observed)
            assert asked.explain(observed) == fresh
            told = [
                (one.with_observed, one.without_observed) for one in quick.explain(observed, canonical=False)
            ]
            assert told == [(one.with_observed, one.without_observed) for one in fresh]


@given(st.one_of(tasks(), usar_tasks()), st.integers(0, 2**32))
def test_costs_from_here_are_bounds(task: Task, seed: int) -> None:
    """What was done, and the best from there on, is a plan that embeds it."""
    dice = Random(seed)
    goals = [task.goal, *(Condition((fact,)) for fact in dice.choices(range(len(task.facts)), k=2))]
    explainer = Explainer(PreparedTask(task), goals)
    for observed, state in _walk(task, dice, 4):
        exact = explainer.explain(observed, canonical=False)
        for known, bound in zip(exact, explainer.from_here(observed, state), strict=True):
            assert bound.with_observed is None or (known.with_observed or 0) <= bound.with_observed
            if known.without_observed is not None:
                assert bound.without_observed is not None
                assert bound.without_observed <= known.without_observed
