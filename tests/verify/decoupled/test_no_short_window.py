"""That no window of one epoch helps is said only where brute force says so, too; and it is said often."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity.model import Condition, Options, Task
from serendipity_testing.builders import task as written
from serendipity_testing.generator.families import family_task
from serendipity_testing.oracle import best, optimal_human_plan
from serendipity_testing.strategies import family_tasks, tasks
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import Subproblem
from verify.calls.call import ExaminedCall
from verify.exhaustive.decoupled.short_windows import is_short, no_short_window


def without_joint_actions(task: Task) -> Task:
    """The same task where everybody acts alone, and robots want nothing."""
    alone = tuple(action for action in task.actions if len(action.participants) == 1)
    return replace(task, actions=alone, robot_goal=Condition())


def asked(task: Task, options: Options) -> tuple[Subproblem, int] | None:
    """The question of a call, and the least objective of a plan with a window, in units."""
    plan = optimal_human_plan(task)
    if not plan:
        return None
    call = ExaminedCall(task, options, plan, OptimalPlans(task, IndividualOptimum(task)))
    optimum = best(task, options)
    assert call.do_nothing is not None
    least = call.do_nothing[0]
    if optimum.opportunity:
        assert optimum.objective is not None
        least = int(optimum.objective * call.prices.scale)
    return call.question, least


def closed(task: Task, options: Options) -> bool | None:
    """Whether nothing below the optimum is proved; the optimum itself must not be denied."""
    found = asked(task, options)
    if found is None:
        return None
    question, least = found
    assert is_short(question.below(least)) == (least < 2 * question.prices.epoch)
    assert no_short_window(question.below(least)).status == "undecided"
    return no_short_window(question.below(least - 1)).status == "none"


@given(
    tasks().map(without_joint_actions),
    st.sampled_from([Fraction(0), Fraction(1, 2), Fraction(9, 10), Fraction(1)]),
    st.sampled_from(["paper", "strict"]),
)
def test_no_plan_is_denied_in_random_tasks(task: Task, discount: Fraction, interference: str) -> None:
    closed(task, Options(mode="serendipity", discount=discount, interference=interference))


@given(family_tasks().map(without_joint_actions), st.sampled_from([Fraction(1, 2), Fraction(9, 10)]))
def test_no_plan_is_denied_in_families(task: Task, discount: Fraction) -> None:
    closed(task, Options(mode="serendipity", discount=discount))


WAY = "a h: -> x @ 3; b h: x -> y @ 3; c h: y -> g @ 3; "

HELPED = {
    "in the epoch of the window": ("g", "a h: -> x @ 5; b h: x -> g @ 5; short h: q -> g; help r: -> q"),
    "in the last epoch": ("g m", WAY + "d h: g -> m @ 9; help r: g -> m"),
    "by one after the other": (
        "g",
        WAY + "short h: q -> g; look h: p -> g @ 20; help r: -> p; carry s: p -> q !p",
    ),
    "by one who makes room": ("g", WAY + "short h: q f -> g; help r: -> !f; carry s: !f -> q f"),
    "by both together": ("g", WAY + "short h: p q -> g; help r: -> p; carry s: -> q"),
    "where one mends what the other breaks": (
        "g",
        WAY + "short h: q f -> g; take r: -> q !f; mend s: !f -> f",
    ),
    "once the human has come so far": ("g", WAY + "short h: q -> g; help r: x -> q"),
    "at once with the human, and not before them": (
        "g m",
        "a h: -> x @ 3; b h: x -> y !x @ 3; c h: y -> m g @ 6; e h: y -> m; swap r: y !m -> g !y",
    ),
    "where one restores what pi_H needs": (
        "g",
        "a h: -> x; b h: -> w; c h: w -> v; d h: v x -> y; e h: y -> z; f h: z -> g @ 9; short h: p z -> g; "
        "take r: x !v -> q !x; mend s: -> x; late r: y q -> p",
    ),
}


@pytest.mark.parametrize("interference", ["paper", "strict"])
@pytest.mark.parametrize("name", HELPED)
def test_no_help_is_denied(name: str, interference: str) -> None:
    goal, texts = HELPED[name]
    actions = dict(text.split(": ") for text in texts.split("; "))
    task = written(agents="h r s", init="f", goal=goal, actions=actions)
    options = Options(mode="serendipity", discount=Fraction(9, 10), interference=interference)
    assert best(task, options).opportunity or (interference == "strict" and "at once" in name)
    assert closed(task, options) is not None


@pytest.mark.long
def test_robots_who_do_not_meet_are_looked_at_to_the_end() -> None:
    options = Options(mode="serendipity", discount=Fraction(9, 10))
    drawn = [without_joint_actions(family_task("logistics", seed, 2)) for seed in range(12)]
    said = [closed(task, options) for task in drawn]
    assert said.count(True) > 5
    assert said.count(False) == 0
