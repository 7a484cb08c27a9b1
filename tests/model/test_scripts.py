"""Scripts by name: what tasks make of them, and what is wrong with others."""

import pytest

from serendipity.model import Script, Task, TimedFact, UsageError
from serendipity.testing.builders import task


def street() -> Task:
    """A human, a robot, and Carol, who walks and shops."""
    return task(
        agents="h r carol",
        init="open",
        goal="done",
        actions={
            "do h": "open -> done",
            "help r": " -> done",
            "walk carol": " -> there @ 1 [2]",
            "shop carol": "there -> bought",
            "carry h carol": "there -> done",
        },
    )


def test_bystanders_are_neither_robots_nor_anybody_whose_actions_can_be_chosen() -> None:
    with_carol = street().with_script(Script(people={"Carol": ["walk carol", "shop carol"]}))
    assert (with_carol.agents, with_carol.robots) == (("h", "r", "carol"), (1,))
    assert [action.name for action in with_carol.actions] == ["do h", "help r"]
    assert [(deed.epoch, deed.end, deed.name) for deed in with_carol.script.deeds] == [
        (1, 2, "walk carol"),
        (3, 3, "shop carol"),
    ]
    assert with_carol.needs_time


def test_tasks_tell_of_time() -> None:
    plans = {"carol": ["walk carol", "shop carol"]}
    timed = street().with_script(Script(facts=[(9, "!open")], people=plans))
    assert "actions of one epoch; a script of 1 facts and the plans of carol, until epoch 9" in str(timed)


def test_a_bystander_who_does_nothing_is_one() -> None:
    idle = street().with_script(Script(people={"carol": []}))
    assert (idle.robots, idle.needs_time) == ((1,), False)


def test_scripts_add_up() -> None:
    first = street().with_script(Script(facts=[(5, "!open"), (2, "there")]))
    both = first.with_script(Script(facts=[(5, "!open"), (7, "open")]))
    open_, there = street().facts.index("open"), street().facts.index("there")
    facts = [TimedFact(2, there, True), TimedFact(5, open_, False), TimedFact(7, open_, True)]
    assert (list(both.script.facts), both.script.last) == (facts, 7)
    assert both.script.changes(5) == (frozenset(), frozenset({open_}))


def test_facts_that_the_script_changes_are_in_no_group() -> None:
    moved = task(init="a", goal="b", actions={"go h": "a -> b !a", "back h": "b -> a !b"})
    assert [variable.boolean for variable in moved.variables] == [False]
    assert [v.boolean for v in moved.with_script(Script(facts=[(3, "!a")])).variables] == [True, True]


@pytest.mark.parametrize(
    ("script", "message"),
    [
        ({"facts": [(0, "open")]}, "script: expected an epoch from 1 to 1000000, got 0"),
        ({"facts": [(1_000_001, "open")]}, "script: expected an epoch from 1 to 1000000, got 1000001"),
        ({"facts": [(3, "opened")]}, "script: there is no fact 'opened' in the task"),
        ({"facts": [(3, "open"), (3, "!open")]}, "script: a fact becomes true and false with epoch 3"),
        ({"facts": [("3", "open")]}, "script: facts: expected a whole epoch, got '3'"),
        ({"facts": "open"}, "script: facts: expected pairs of an epoch and a fact, got 'open'"),
        ({"people": ["carol"]}, "script: people: expected plans by name, got ['carol']"),
        ({"people": {"dave": []}}, "script: expected one of h, r, carol, got 'dave'"),
        ({"people": {"h": []}}, "script: 'h' is the human, whose plan is no part of it"),
        ({"people": {"carol": ["do h"]}}, "script: 'do h' is not an action that carol can do alone"),
        ({"people": {"carol": ["carry h carol"]}}, "script: 'carry h carol' is not an action that carol can"),
        (
            {"people": {"carol": [(1, "walk carol"), (2, "shop carol")]}},
            "script: 'shop carol' begins in epoch 2, but 'walk carol' takes until the end of epoch 2",
        ),
        ({"people": {"carol": [(-1, "walk carol")]}}, "script: expected an epoch from 1 to 1000000, got -1"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(script: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError) as caught:
        street().with_script(Script(**script))  # type: ignore[arg-type]
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_nobody_has_two_plans() -> None:
    with_carol = street().with_script(Script(people={"carol": ["walk carol"]}))
    with pytest.raises(UsageError, match="has a plan already"):
        with_carol.with_script(Script(people={"carol": ["shop carol"]}))
    with pytest.raises(UsageError, match="'carol' is the human"):
        with_carol.with_human("carol")
