"""What is known of a scenario that goes on for certain: handed on with its epochs, as far as it matters."""

from fractions import Fraction

import pytest

import serendipity
from search import PreparedTask
from search.call.context import SearchContext
from search.modes.scenarios.lines import Line, Moves
from search.modes.scenarios.measure import FOLLOWING, INFINITE_WORTH, INSIDE, Member, Worths
from search.modes.scenarios.remainder import Certain, Remainder, Scenario
from search.modes.scenarios.variants import Variants
from search.spaces.windowed import Windowed
from serendipity.model import Deadline, Options
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.plans import Step, Window
from serendipity_testing.builders import task as build
from tests.search.modes.scenarios.test_policies_equal_brute_force import lifted


@pytest.mark.parametrize(
    ("window", "inside", "goes_on"),
    [
        (None, False, True),
        (None, True, False),
        (Window(2, 3), False, True),
        (Window(2, 3), True, False),
        (Window(1, 3), True, True),
        (Window(1, 3), False, False),
        (Window(1, 2), True, False),  # a limit came, and then another plan was found: its window is over
    ],
)
def test_only_a_window_that_is_where_the_scenario_is_goes_on(
    window: Window | None, inside: bool, goes_on: bool
) -> None:
    found = Remainder(5, 5, (Step(1, 0), Step(2, 1)), window)
    assert found.goes_on(1, inside=inside) == goes_on
    if goes_on:
        assert found.after(2) == Remainder(3, 3, found.steps, window)


def _certain() -> tuple[Certain, Member, Worths]:
    """The first of the two scenarios of :func:`lifted` by itself, from the start."""
    task, candidates = lifted()
    options = Options(horizon=3, window_weight=Fraction(1))
    prepared = PreparedTask(task).with_goal(candidates[0].goal)
    context = SearchContext(prepared, options, Deadline())
    worths = Worths(context.keys, 1)
    scenario = Scenario(prepared, context, candidates[0].plan, 3, Variants(context, (), None))
    certain = Certain(scenario, worths)
    return certain, Member(0, context.packed.init, FOLLOWING, 0, None, 0), worths


def test_what_is_worth_too_much_is_not_told_apart() -> None:
    whole, start, worths = _certain()
    best = whole.remainder(start, 0, Deadline())
    assert best.least == best.worth
    certain, start, _ = _certain()
    most = best.worth - worths.epoch
    dearer = certain.remainder(start, 0, Deadline(), most)
    assert most <= dearer.least < best.worth < dearer.worth
    assert certain.remainder(start, 0, Deadline(), dearer.least) is dearer
    assert certain.remainder(start, 0, Deadline()) == best


def test_the_limit_of_a_part_is_no_end_of_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is made before a space is searched came to its end there, and so did the whole call."""

    def ended(*_: object) -> Windowed:
        raise LimitReachedError("time-limit")

    monkeypatch.setattr(Certain, "_space", ended)
    certain, start, _ = _certain()
    inside = start._replace(phase=INSIDE, start=1)
    assert certain.remainder(inside, 1, Deadline()) == Remainder(0, INFINITE_WORTH)


def test_at_the_horizon_no_bound_is_handed_on() -> None:
    """After a limit it was taken for what is left, and a policy for better than it was."""
    certain, start, worths = _certain()
    context = certain._scenario.context
    moves = Moves(context.successors(), worths)
    line, task = Line(certain._scenario, 0, moves, worths), context.task
    done = start._replace(state=context.packed.pack(task.init.union(task.goal.positive)))
    line.certain.learn(done, 3, Remainder(0, 2 * worths.epoch))
    assert line.least(done, 3) == worths.epoch


def test_a_key_is_not_worth_less_than_it_is_asked_for() -> None:
    """The key of a cost that is beyond all costs was worth less."""
    _, _, worths = _certain()
    for worth in (0, 7, 1 << 40, 1 << 70, worths.epoch + (1 << 70)):
        assert worths.of_key(worths.key(worth)) >= worth


def test_several_robots_act_in_the_window_of_who_has_to_keep_something() -> None:
    actions = {"out h": "!o -> o", "in h": "o -> !o", "fix r": "-> d"}
    task = build(goal="g", actions=actions)
    plans = [
        {"probability": 1, "plan": ["out h"], "goal": ["o"]},
        {"probability": 1, "plan": ["out h", "in h"], "goal": ["!o"]},
    ]
    for risk in ("mean", "worst", "regret"):
        answer = serendipity.plan(task, plans=plans, risk=risk, leave_free="d")
        assert (answer.status, serendipity.verify(task, answer).verdict) == ("optimal", "proved")
