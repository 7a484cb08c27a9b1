"""Candidate goals for the small tasks of ``serendipity_testing.strategies``; everything by construction."""

from dataclasses import replace
from fractions import Fraction

from hypothesis import strategies as st

from search.modes.scenarios import Candidate
from serendipity.model import Condition, Options, Task
from serendipity_testing.oracle import optimal_human_plan
from serendipity_testing.strategies import tasks
from serendipity_testing.strategies.tasks import walks

FIXED_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0", "0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["1000", "0", "0.25", "1"]),
    interference=st.sampled_from(["paper", "strict"]),
    policy=st.just("fixed"),
)
"""Of robots that commit themselves."""

WEIGHTS = (Fraction(1, 2), Fraction(1, 4), Fraction(9, 10))


@st.composite
def reachable_goals(draw: st.DrawFn, task: Task) -> Condition:
    """One literal that holds after a random walk of the human."""
    state = draw(walks(task, 4))
    changed = sorted(state ^ task.init) or sorted(range(len(task.facts)))
    fact = draw(st.sampled_from(changed))
    return Condition((fact,), ()) if fact in state else Condition((), (fact,))


@st.composite
def rivals(draw: st.DrawFn) -> tuple[Task, list[Candidate]]:
    """A task without goals of the robots' own, and two goals that the human can reach alone.

    The first is the task's own where the human can reach it, since robots are most often of use there.
    """
    task = replace(draw(tasks()), robot_goal=Condition())
    weight = draw(st.sampled_from(WEIGHTS))
    first = task.goal if optimal_human_plan(task) is not None else draw(reachable_goals(task))
    found = []
    for share, goal in ((weight, first), (1 - weight, draw(reachable_goals(task)))):
        plan = optimal_human_plan(replace(task, goal=goal))
        assert plan is not None, "a walk of his leads there"
        found.append(Candidate(goal, plan, share))
    return task, found


def literals(task: Task, goal: Condition) -> list[str]:
    return [task.facts[f] for f in goal.positive] + [f"!{task.facts[f]}" for f in goal.negative]
