"""Writing a task and reading it back gives the same task, up to ids and names."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import given

from serendipity import Task, load, load_pddl
from serendipity.pddl.write import task_files, write_pddl
from serendipity_testing.builders import task as build
from serendipity_testing.strategies import tasks
from tests.pddl.texts import OFFICE, YARD


def again(task: Task) -> Task:
    with tempfile.TemporaryDirectory() as folder:
        write_pddl(task, folder)
        return load(folder, human=task.agents[task.human])


def written(task: Task, fact: int) -> str:
    return task.facts[fact].replace(" ", "_")


def joined(task: Task) -> list[object]:
    """The task by names, as they are written."""

    def words(ids: tuple[int, ...] | frozenset[int]) -> frozenset[str]:
        return frozenset(written(task, i) for i in ids)

    actions = sorted(
        (
            a.name.replace(" ", "_"),
            sorted(task.agents[i] for i in a.participants),
            *(sorted(words(ids)) for ids in (a.pre, a.neg, a.add, a.delete)),
            a.cost,
        )
        for a in task.actions
    )
    goals = [words(ids) for goal in (task.goal, task.robot_goal) for ids in (goal.positive, goal.negative)]
    return [task.agents[task.human], sorted(task.agents), words(task.init), goals, actions]


def moves(task: Task) -> set[tuple[object, ...]]:
    """What can happen: transitions between reachable states, as sets of the facts that change."""
    found = set()
    seen, pending = {task.init}, [task.init]
    while pending:
        state = pending.pop()
        for action in task.actions:
            if action.applicable(state):
                after = state.difference(action.delete).union(action.add)
                who = frozenset(task.agents[i] for i in action.participants)
                became = frozenset(written(task, f) for f in after - state)
                ceased = frozenset(written(task, f) for f in state - after)
                if after != state:  # an action that never changes anything is a noop
                    found.add((who, action.cost, became, ceased))
                if after not in seen:
                    seen.add(after)
                    pending.append(after)
    return found


def goals(task: Task) -> list[set[str]]:
    """The literals of the human's goal, and those that only the robots have."""
    own, others = task.goal, task.robot_goal
    return [
        {written(task, f) for f in own.positive},
        {written(task, f) for f in own.negative},
        {written(task, f) for f in others.positive if f not in own.positive},
        {written(task, f) for f in others.negative if f not in own.negative},
    ]


def test_loaded_tasks_come_back_equal() -> None:
    for task in (load(YARD), load_pddl(*OFFICE, human="ann", robots=["bot"])):
        assert joined(again(task)) == joined(task)


def test_published_tasks_come_back_equal(usar200: Path) -> None:
    task = load(usar200 / "test1")
    assert joined(again(task)) == joined(task)


@pytest.mark.long
@given(tasks())
def test_writing_keeps_what_can_happen(task: Task) -> None:
    back = again(task)
    assert back.agents[back.human] == task.agents[task.human]
    assert moves(back) == moves(task)
    assert goals(back) == goals(task)
    assert joined(again(back)) == joined(back)


def test_names_that_pddl_cannot_hold() -> None:
    task = build(
        agents="h r_1",
        init="not 4x a_b",
        goal="done",
        actions={
            "go a_b h": "a_b -> done @ 1/3",
            "go a b h": "not -> done !4x",
            "and r_1": "4x -> !a_b !not",
            "lift r_1 h": "a_b -> 4x",
        },
    )
    back = again(task)
    assert sorted(a.cost for a in back.actions) == sorted(a.cost for a in task.actions)
    assert sorted(a.participants for a in back.actions) == sorted(a.participants for a in task.actions)
    assert len(back.facts) == len(task.facts)
    assert set(task_files(task)) == {"h", "r_1", "superagent"}
