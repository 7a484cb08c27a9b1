"""Tables of the states beside a human's plan bound what the ordinary call tells from each of them."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from search import PreparedTask
from search.call.context import SearchContext
from search.kernel.library import library
from search.modes.scenarios import Candidate
from search.modes.scenarios.lines import Line, Moves
from search.modes.scenarios.measure import FOLLOWING, Worths
from search.modes.scenarios.remainder import Scenario
from search.modes.scenarios.variants import Variants
from search.packed.joint_actions import NOTHING
from serendipity.model import Deadline, Options, Task
from tests.search.modes.scenarios.strategies import scenarios
from tests.search.modes.scenarios.test_policies_equal_brute_force import lifted


def _line(task: Task, candidate: Candidate, horizon: int) -> Line:
    options = Options(horizon=horizon, window_weight=Fraction(1000), discount=Fraction(1, 2))
    prepared = PreparedTask(task).with_goal(candidate.goal)
    context = SearchContext(prepared, options, Deadline()).for_plan(candidate.plan)
    scenario = Scenario(prepared, context, candidate.plan, horizon, Variants(context, (), None))
    worths = Worths(context.keys, 1)
    return Line(scenario, 0, Moves(context.successors(), worths), worths)


def _twice(given_: tuple[Task, list[Candidate]], more: int) -> tuple[Line, Line, int]:
    """Two lines of the first scenario, and the horizon: so many epochs beyond its plan."""
    task, (candidate, *_) = given_
    horizon = len(candidate.plan) + more
    return _line(task, candidate, horizon), _line(task, candidate, horizon), horizon


def _alone(line: Line) -> int:
    return line.certain.alone(line.first().state, 0)


@given(scenarios(), st.integers(0, 2), st.integers(0, 3))
@settings(max_examples=60)
def test_they_are_never_above_what_is_left(
    given_: tuple[Task, list[Candidate]], more: int, halves: int
) -> None:
    """After each epoch, whatever robots have done by then: of the whole as of any lower limit."""
    line, exact, horizon = _twice(given_, more)
    start, least, worth = line.first(), exact.least(line.first(), 0), _alone(exact)
    line.tabulate(least, least + (worth - least >> halves), Deadline())
    reached = {start}
    for epoch in range(horizon):
        for at in sorted(reached)[:20]:
            least, _ = exact.certainly(at, epoch, Deadline())
            assert line.least(at, epoch) <= least
        begun = [(at, robots) for at in reached for robots in line.begun(at.state)]
        ways = [way for at, robots in begun for way in line.ways(at, epoch + 1, robots)]
        reached = {way.after for way in ways if way.after.phase == FOLLOWING}


@given(scenarios(), st.integers(0, 2), st.fractions(0, 1))
@settings(max_examples=60)
def test_what_they_leave_out_is_not_worth_less(
    given_: tuple[Task, list[Candidate]], more: int, share: Fraction
) -> None:
    """Windows that open in an epoch are not looked at where none can be worth so little: a part of all."""
    line, exact, horizon = _twice(given_, more)
    start, least, worth = line.first(), exact.least(line.first(), 0), _alone(exact)
    most = least + int((worth - least) * share)
    line.tabulate(least, worth, Deadline())
    reached = {start}
    for epoch in range(1, horizon + 1):
        following = set()
        for at in sorted(reached)[:10]:
            for robots in exact.begun(at.state):
                ways = [*exact.ways(at, epoch, robots)]
                few = {*line.ways(at, epoch, robots, most)}
                assert few <= {*ways}
                for way in ways:
                    rest, _ = exact.certainly(way.after, epoch, Deadline())
                    assert way in few or way.paid + rest >= most
                following |= {way.after for way in ways if way.after.phase == FOLLOWING}
        reached = following


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
def test_one_says_what_comes_too_late() -> None:
    """A robot lifts a thing before the last epoch, or in vain; private distances know no epochs."""
    task, candidates = lifted()
    line, fresh = (_line(task, candidates[0], 2) for _ in range(2))
    first = line.first()
    line.tabulate(line.least(first, 0), line.certain.alone(first.state, 0), Deadline())
    assert line.is_tabulated(wholly=False)
    ways = line.ways(first, 1, NOTHING)
    idle = next(way.after for way in ways if way.after.phase == FOLLOWING)
    exact, _ = fresh.certainly(idle, 1, Deadline())
    assert fresh.least(idle, 0) < line.least(idle, 1) <= exact
