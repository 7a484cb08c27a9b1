"""Proofs don't rest on the task's variables, which the model finds for search and verifier alike."""

from dataclasses import replace

import pytest

import serendipity
from serendipity import Task
from serendipity.model.task.variables import Variable
from serendipity_testing.builders import task as build

TASK = build(
    init="a k",
    goal="c d",
    actions={
        "go h": "a -> b !a @ 2",
        "on h": "b -> c @ 2",
        "make h": "k -> d !k @ 3",
        "help r": "k -> d @ 1",
    },
)


def with_groups(groups: str) -> Task:
    """The task with groups of facts, each of which is said to have exactly one true."""
    values = [tuple(sorted(map(TASK.facts.index, group))) for group in groups.split()]
    return replace(TASK, known_variables=tuple(map(Variable, sorted(values))))


@pytest.mark.parametrize("method", ["program", "exhaustive"])
@pytest.mark.parametrize("mode", ["individual", "serendipity", "composite"])
@pytest.mark.parametrize("groups", ["abc dk", "ab ck d", "abcd k", "ac bd k"])
def test_answers_are_judged_as_ever(groups: str, mode: str, method: str) -> None:
    result = serendipity.plan(TASK, mode=mode, discount="0.9")
    assert serendipity.verify(with_groups(groups), result, method=method).verdict == "proved"
    dearer = replace(TASK, actions=tuple(a for a in TASK.actions if a.name != "help r"))
    other = serendipity.plan(dearer, mode=mode, discount="0.9")
    expected = serendipity.verify(TASK, other, method=method).verdict
    assert expected == ("proved" if mode == "individual" else "refuted")
    assert serendipity.verify(with_groups(groups), other, method=method).verdict == expected
