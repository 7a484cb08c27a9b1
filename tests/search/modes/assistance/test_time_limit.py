"""When the time is up: bounds that hold, and a policy that is worth its upper one (semantics 7)."""

from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from search import PreparedTask
from search.modes.assistance import assist
from search.modes.assistance.bounds import bound
from search.modes.assistance.bounds import relaxed_provision as provision
from search.modes.assistance.distances import closure
from search.modes.assistance.distances import perimeter as ball
from search.modes.assistance.solvers import lao_star
from serendipity.model import Options, Task
from serendipity.model.answers.answer import Answer
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task
from serendipity_testing.cases import case_5, case_6
from serendipity_testing.countdown import Countdown
from tests.search.modes.assistance.strategies import games

TIES = ("optimistic", "fixed", "robust", "expected")


@pytest.mark.parametrize("ties", TIES)
@given(game=games(), questions=st.integers(0, 60), tables=st.booleans())
def test_bounds_hold_whenever_the_time_is_up(ties: str, game: Task, questions: int, tables: bool) -> None:
    """Also where it is up while the first bound is worked out."""
    options = Options(mode="assistance", ties=ties)
    *_, full = assist(PreparedTask(game), options, Deadline())
    with pytest.MonkeyPatch.context() as patch:
        for module in (closure, provision, lao_star):
            for name in ("_CHECK_EVERY", "SMALL"):
                if hasattr(module, name):
                    patch.setattr(module, name, 1)
        if not tables:
            patch.setattr(ball, "MAX_BITS", -1)
            patch.setattr(bound, "SMALL", 0)
        *_, answer = assist(PreparedTask(game), options, Countdown(questions))
    if answer.status in ("optimal", "infeasible"):
        assert (answer.status, answer.bounds.upper) == (full.status, full.bounds.upper)
    elif full.bounds.upper is not None:
        assert answer.bounds.lower <= full.bounds.upper
        assert answer.bounds.upper is None or full.bounds.upper <= answer.bounds.upper


@pytest.mark.long
@pytest.mark.parametrize("ties", TIES)
@pytest.mark.parametrize("case", [case_5, case_6])
def test_doing_nothing_is_an_answer_as_soon_as_his_own_plan_is_known(case, ties: str) -> None:
    options = Options(mode="assistance", ties=ties)
    *_, full = assist(PreparedTask(case()), options, Deadline())
    answers = [last(assist(PreparedTask(case()), options, Countdown(questions))) for questions in range(400)]
    known = [answer for answer in answers if answer.status != "unknown"]
    assert (answers[0].status, answers[-1].status) == ("unknown", "optimal")
    assert answers[-len(known) :] == known  # more time never leaves less
    assert known[0].bounds.upper == (2, 0)
    for answer in known:
        assert answer.bounds.lower <= full.bounds.upper <= answer.bounds.upper
        assert (answer.bounds.lower == answer.bounds.upper) == (answer.status == "optimal")


def last(answers: Iterable[Answer]) -> Answer:
    *_, answer = answers
    return answer


def test_no_time_and_no_plan_alone_is_unknown() -> None:
    helpless = task(goal="g", actions={"open r": "-> x @ 2", "finish r": "x -> g @ 3"})
    result = serendipity.plan(helpless, mode="assistance", time_limit=0)
    assert (result.status, result.policy, result.cost) == ("unknown", None, None)


def test_a_goal_out_of_reach_has_no_bound() -> None:
    """The bound on it was taken for a cost, and was too large to be written down."""
    steps = {f"do{i} h": f"-> f{i}" for i in range(6)} | {"help r": "-> f0"}
    game = task(goal="never", actions={**steps, "give up h": "never -> f1"})
    statuses = set()
    for looks in range(300):
        answer = serendipity.plan(game, mode="assistance", deadline=Countdown(looks, once=True))
        assert answer.cost is None
        statuses.add((answer.status, answer.reason, answer.lower_bound))
    assert statuses == {("unknown", "time-limit", 0.0), ("infeasible", "no-plan", None)}
