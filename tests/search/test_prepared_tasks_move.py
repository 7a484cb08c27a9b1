"""A prepared task answers in another state, or with another goal, what a new one answers there."""

from fractions import Fraction

import pytest
from hypothesis import given

from search import PreparedTask, prepare, solve
from serendipity.model import Condition, Deadline, Options, Task
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LimitReachedError
from serendipity_testing.cases import case_1, case_4
from serendipity_testing.strategies import tasks

OPTIONS = Options(mode="composite", horizon="inf", discount=Fraction(1, 2))


def answer(prepared: PreparedTask, options: Options = OPTIONS) -> Answer:
    *_, last = solve(prepared, options)
    return last


@given(tasks())
def test_in_another_state(task: Task) -> None:
    prepared = PreparedTask(task)
    answer(prepared)
    for action in [action for action in task.actions if action.applicable(task.init)][:3]:
        state = task.init.difference(action.delete).union(action.add)
        moved = prepared.at(state)
        assert answer(moved) == answer(PreparedTask(task.at(state)))
        assert answer(moved.at(task.init)) == answer(prepared)


@given(tasks())
def test_with_another_goal(task: Task) -> None:
    prepared = PreparedTask(task)
    before = answer(prepared)
    for fact in range(min(3, len(task.facts))):
        goal = Condition((fact,))
        assert answer(prepared.with_goal(goal)) == answer(PreparedTask(task.with_goal(goal)))
    assert answer(prepared) == before


@given(tasks())
def test_several_goals_over_one_packing(task: Task) -> None:
    wanted = [task.goal, *(Condition((fact,)) for fact in range(min(2, len(task.facts))))]
    theirs = [task.robot_goal, Condition((), (len(task.facts) - 1,)), Condition()]
    goals = list(zip(wanted, theirs, strict=False))
    found = PreparedTask(task).with_goals(goals, frozenset(), Deadline())
    assert len({id(own.plain(Deadline()).packed.own) for own in found}) == 1
    for pair, own in zip(goals, found, strict=True):
        assert own.task == task.with_goal(*pair)
        alone = answer(PreparedTask(task.with_goal(*pair)))
        assert (answer(own).status, answer(own).cost) == (alone.status, alone.cost)


def test_what_cannot_have_changed_is_kept() -> None:
    prepared = prepare(case_1())
    tables = prepared.plain(Deadline())
    moved = prepared.at(case_1().init).plain(Deadline(0))  # no time to pack anew
    assert moved.human is tables.human
    assert (moved.transitions, moved.decoupled) == (tables.transitions, tables.decoupled)
    assert moved.packed.others is tables.packed.others


def test_a_deadline_that_comes_first_leaves_nothing_half_made() -> None:
    prepared = PreparedTask(case_4())
    with pytest.raises(LimitReachedError):
        prepared.plain(Deadline(0))
    with pytest.raises(LimitReachedError):
        prepare(case_4(), Deadline(0))
    assert answer(prepared) == answer(PreparedTask(case_4()))
