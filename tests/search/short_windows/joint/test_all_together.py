"""All agents at once beside the human's timetable: the best window of one epoch, against brute force."""

from contextlib import suppress
from fractions import Fraction
from math import lcm
from random import Random

import pytest

import serendipity
from benchmarks.techniques import without
from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.classical import planner
from search.engine.best_first import Incumbent, Progress
from search.kernel.library import library
from search.packed.cost_vector import INFINITE_KEY
from search.short_windows.joint import epochs
from search.short_windows.joint.all_together import AllTogether
from search.short_windows.question import ShortWindowQuestion
from serendipity.model import Options, Task
from serendipity.model.errors import LimitReachedError
from serendipity.model.numbers import as_written
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import conflicting
from serendipity_testing.builders import task as build
from serendipity_testing.generator.calls import random_call
from serendipity_testing.generator.families import AGENTS, FAMILIES
from serendipity_testing.oracle import best
from tests.search.small_tasks import ONE_EPOCH, beside_the_plan, fetching, of_a_family

pytestmark = pytest.mark.skipif(library() is None, reason="the kernel is not compiled here")


def _of_family(seed: int) -> tuple[Task, Options]:
    dice = Random(seed)
    task = of_a_family(dice)
    rules = {
        "discount": dice.choice(["0", "1/2", "9/10", "1"]),
        "interference": dice.choice(["paper", "strict"]),
    }
    return task, ONE_EPOCH.but(**rules)


def _drawn(seed: int) -> tuple[Task, Options]:
    """With joint actions, negative preconditions and costs of all kinds."""
    call = random_call(seed)
    rules = {name: call.options[name] for name in ("discount", "interference") if name in call.options}
    return call.task, ONE_EPOCH.but(**rules)


def _largest_cost(task: Task, options: Options) -> int:
    """In whole units: the kernel's layers are for those that are not too many."""
    costs = [task.team_cost(action, options.discount) for action in task.actions]
    return int(max(costs) * lcm(*(cost.denominator for cost in costs)))


def _looked_at(
    task: Task, options: Options, most: tuple[int, ...] = (300_000,)
) -> tuple[SearchContext, Incumbent, Progress] | None:
    """What is found from ``pi_H`` as the incumbent; None where the human has no plan, or needs none."""
    found = beside_the_plan(task, options)
    if found is None:
        return None
    context, incumbent, question = found
    progress = Progress()
    together = AllTogether(question, progress, INFINITE_KEY)
    for states in most:
        for _ in together.windows(states, context.deadline):
            pass
    return context, incumbent, progress


@pytest.mark.long
@pytest.mark.parametrize("most", [(300_000,), (3, 12, 300_000)])
@pytest.mark.parametrize("draw", [_of_family, _drawn])
def test_the_best_window_of_one_epoch_is_found(draw: object, most: tuple[int, ...]) -> None:
    """In one go, and where the first looks end after a few states."""
    better = 0
    for seed in range(250):
        task, options = draw(seed)  # type: ignore[operator]
        asked = not task.robot_goal and _largest_cost(task, options) < 1 << 20
        found = _looked_at(task, options, most) if asked else None
        if found is None:
            continue
        context, incumbent, progress = found
        optimum = best(task, options)
        assert context.keys.cost(incumbent.key) == optimum.cost, seed
        assert progress.bound == incumbent.key, seed
        if incumbent.node is not None:
            better += 1
            assert incumbent.node.start == optimum.window.start, seed
    assert better > 30


@pytest.mark.parametrize("seed", [15, 17, 61, 75, 80, 85])
def test_like_things_that_the_plan_is_about_are_told_apart(seed: int) -> None:
    """Where they were not, too dear an answer was the best."""
    dice = Random(seed)
    task, options = fetching(dice), ONE_EPOCH.but(discount=dice.choice(["1/2", "9/10"]))
    with without("like fields"):
        context, expected, _ = _looked_at(task, options)
    _, found, progress = _looked_at(task, options)
    assert context.keys.cost(found.key) == context.keys.cost(expected.key)
    assert progress.bound == found.key


def test_a_call_that_it_settles() -> None:
    """Two robots who hand things to each other, so that neither does any good by itself."""
    others = "-few-nodes,-robots-apart"
    for seed in range(40):
        task, options = _of_family(seed)
        asked = {"discount": options.discount, "interference": options.interference}
        answer = serendipity.plan(task, strategies=others, **asked)
        if answer.status == "optimal":
            assert as_written(answer.objective or 0.0) == best(task, answer.options).objective
            assert serendipity.check(task, answer).verdict != "refuted"


def test_too_many_states_are_given_up() -> None:
    task = FAMILIES["blocks"](Random(1), 3, AGENTS[:2])
    found = _looked_at(task, ONE_EPOCH, (0, 0))
    assert found[2].bound == 0


def test_the_kernel_goes_on_where_memory_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    """It asks for more, bit by bit."""
    monkeypatch.setattr(planner, "ROOM", 1 << 10)
    robots, places = 2, 5
    actions = {f"work_h_{i} h": f"-> done_{i} @ 3" for i in range(places)}
    for robot in range(robots):
        for place in range(places):
            actions[f"turn_{robot}_{place} r{robot}"] = f"-> on_{robot}_{place} @ 1"
        needed = " ".join(f"on_{robot}_{place}" for place in range(3))
        actions[f"work_{robot} r{robot}"] = f"{needed} -> done_{places - 1 - robot} @ 1"
    goal = " ".join(f"done_{place}" for place in range(places))
    agents = " ".join(["h", *(f"r{i}" for i in range(robots))])
    task = build(agents=agents, goal=goal, actions=actions)
    options = ONE_EPOCH.but(discount="9/10")
    found = _looked_at(task, options)
    assert found[0].keys.cost(found[1].key) == Fraction(3 * places - 6) + Fraction("0.8")


@pytest.mark.parametrize("strict", [False, True])
def test_what_may_not_share_an_epoch(strict: bool) -> None:
    for seed in range(60):
        task = random_call(seed).task
        packed = PreparedTask(task).plain(Deadline()).packed
        operators = [*packed.own, *packed.joint, *packed.others]
        found = epochs.conflicts(task, operators, Deadline(), strict=strict)
        for row, one in enumerate(operators):
            for column, other in enumerate(operators):
                if not one.agents & other.agents:
                    actions = task.actions[one.action], task.actions[other.action]
                    assert found[row] >> column & 1 == conflicting(*actions, strict=strict)


def test_a_state_of_many_sets_is_left_when_the_time_for_it_is_up() -> None:
    """One state may have thousands of ways to act, each with a bound to be found."""
    robots, choices = 3, 26
    actions = {f"work_h_{i} h": f"-> done_{i} @ 3" for i in range(8)}
    for robot in range(robots):
        for choice in range(choices):
            actions[f"turn_{robot}_{choice} r{robot}"] = f"!on_{robot}_{choice} -> on_{robot}_{choice} @ 1"
            actions[f"use_{robot}_{choice} h"] = f"on_{robot}_{choice} -> done_{choice % 8} @ 1"
    agents = " ".join(["h", *(f"r{i}" for i in range(robots))])
    task = build(agents=agents, goal=" ".join(f"done_{i}" for i in range(8)), actions=actions)
    prepared, options = PreparedTask(task), ONE_EPOCH.but(discount="9/10")
    optimal = SearchContext(prepared, options, Deadline()).canonical_plan()
    context = SearchContext(prepared, options, Deadline(0.3))
    incumbent = Incumbent(INFINITE_KEY - 1)
    progress = Progress()
    with suppress(LimitReachedError):
        question = ShortWindowQuestion(context, optimal.actions, 8, incumbent)
        for _ in AllTogether(question, progress, INFINITE_KEY).windows(10_000_000, context.deadline):
            pass
    assert progress.bound == 0, "there was not enough time for all"
    assert context.deadline.elapsed() < 0.5


def test_nobody_may_act_in_a_window() -> None:
    """Beside a dearer plan the human may be there already: the epoch was left out, the window began in 0."""
    ways = {"go h": "f -> g !f", "back h": "g -> f !g", "help r": " -> x"}
    context = SearchContext(PreparedTask(build(init="f", goal="f", actions=ways)), ONE_EPOCH, Deadline())
    plan = tuple(context.task.named[name][0] for name in ("go h", "back h"))
    followed = sum(option.weight for _, option in context.followed(plan))
    found = Incumbent(followed + context.keys.epoch_weight + context.keys.of_start(2, 2))
    question = ShortWindowQuestion(context, plan, 2, found)
    for _ in AllTogether(question, Progress(), INFINITE_KEY).windows(1_000, Deadline()):
        pass
    assert found.node is not None
    assert (found.node.start, found.end, found.tail) == (1, 2, ())
