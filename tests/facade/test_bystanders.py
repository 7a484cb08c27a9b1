"""Predicted bystanders, and whoever can be helped best: as brute force and single calls have it."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity import Condition, Options, Script, Task, UsageError
from serendipity_testing.builders import task
from serendipity_testing.oracle import best
from serendipity_testing.oracle.alone import with_predicted
from serendipity_testing.strategies.tasks import strips_tasks
from serendipity_testing.strategies.time import scripted_tasks, timed_tasks

SEVERAL = strips_tasks(facts=(3, 4), robots=(2, 2))
OPTIONS = {"discount": "0.5", "window_weight": "0.25"}


@st.composite
def people(draw: st.DrawFn) -> Task:
    """Tasks in which the human and others have goals of their own."""
    built = draw(st.one_of(timed_tasks(of=SEVERAL), scripted_tasks(of=SEVERAL)))
    some = st.lists(st.sampled_from(range(len(built.facts))), min_size=1, max_size=2, unique=True)
    persons = draw(st.lists(st.sampled_from([1, 2]), min_size=1, unique=True))
    goals = tuple((agent, Condition(tuple(sorted(draw(some))))) for agent in sorted(persons))
    return replace(built, own_goals=goals, robot_goal=Condition(), known_variables=built.variables)


@given(people())
def test_bystanders_do_what_brute_force_predicts(built: Task) -> None:
    goals = {built.agents[agent]: goal for agent, goal in reversed(built.own_goals)}
    try:
        expected = with_predicted(built, goals)
    except UsageError:
        with pytest.raises(UsageError, match="can't reach the goal alone, so a plan has to be given"):
            serendipity.with_bystanders(built, list(goals))
        return
    literals = {who: [built.facts[fact] for fact in goal.positive] for who, goal in goals.items()}
    for asked in (list(goals), literals):
        found = serendipity.with_bystanders(built, asked)
        assert found.script == expected.script
        assert (found.human, found.goal, found.actions) == (built.human, built.goal, expected.actions)


@given(people())
def test_whoever_is_helped_best_is_told(built: Task) -> None:
    goals = {**dict(built.own_goals), built.human: built.goal}
    saved: dict[str, float] = {}
    for person in sorted(goals):
        alone = replace(built, human=person, goal=goals[person], known_variables=built.variables)
        others = {built.agents[i]: goal for i, goal in sorted(goals.items()) if i != person}
        try:
            answer = best(with_predicted(alone, others), Options(**OPTIONS))
        except UsageError:
            assume(False)
        if answer.saving is not None:
            saved[built.agents[person]] = float(answer.saving)
    assume(saved)
    found = serendipity.plan(built, human="any", **OPTIONS)
    assert (found.status, found.saving) == ("optimal", max(saved.values()))
    assert saved[found.human] == found.saving
    assert {one.human: one.saving for one in found.humans or () if one.cost is not None} == saved
    again = [built.agents[i] for i in sorted(goals) if built.agents[i] != found.human]
    one = serendipity.with_bystanders(built, again, human=found.human)
    assert serendipity.plan(one, **OPTIONS).plan == found.plan


def corridor() -> Task:
    """Ann and Carol, who want to be somewhere, and a robot, which wants to be clean."""
    actions = {"go ann": "-> at_ann", "go carol": "-> at_carol", "wash r": "-> clean"}
    goals = {"goal": "at_ann", "robot_goal": "clean at_carol"}
    built = task(agents="ann r carol", human="ann", actions=actions, **goals)
    carol = Condition((built.facts.index("at_carol"),))
    return replace(built, own_goals=((2, carol),), known_variables=built.variables)


def test_nobody_else_is_asked_for_what_a_bystander_wants() -> None:
    clean = Condition((corridor().facts.index("clean"),))
    given = corridor().with_script(Script(people={"carol": ["go carol"]}))
    for built in (serendipity.with_bystanders(corridor(), ["carol"]), given):
        assert (built.robot_goal, built.robots) == (clean, (1,))
    swapped = serendipity.with_bystanders(corridor(), ["ann"], human="carol")
    assert (swapped.human, swapped.robot_goal, swapped.own_goals) == (2, clean, ((0, corridor().goal),))


@pytest.mark.parametrize(
    ("people", "message"),
    [
        (["dave"], "bystander: expected one of ann, r, carol, got 'dave'"),
        (["ann"], "bystander 'ann': is the human"),
        (["r"], "bystander 'r': has no goal in the task, so a plan has to be given"),
        ({"carol": ["at_ann"]}, "bystander 'carol': can't reach the goal alone, so a plan has to be given"),
        ({"carol": ["there"]}, "there is no fact 'there' in the task"),
        ("carol", "bystanders: expected a list of names, got 'carol'"),
    ],
)
def test_who_can_be_no_bystander_is_said(people: object, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        serendipity.with_bystanders(corridor(), people)  # type: ignore[arg-type]
    assert str(caught.value).startswith(message)


def test_one_who_has_a_plan_has_no_other() -> None:
    built = serendipity.with_bystanders(corridor(), ["carol"])
    with pytest.raises(UsageError, match="has a plan already"):
        serendipity.with_bystanders(built, ["carol"])
    with pytest.raises(UsageError, match="'any' goes without"):
        serendipity.plan(corridor(), human="any", human_plan=[])
    with pytest.raises(UsageError, match="expected 'any', got 'carol'"):
        serendipity.plan(corridor(), human="carol")  # type: ignore[arg-type]


def test_goals_of_files_are_those_of_their_agents(tmp_path: Path) -> None:
    for who in ("ann", "carol", "r"):
        goal = "" if who == "r" else f"(at_{who})"
        domain = f"(define (domain d) (:predicates (at_{who})) (:action go_{who} :effect (at_{who})))"
        folder = tmp_path / who
        folder.mkdir()
        (folder / "domain.pddl").write_text(domain)
        (folder / "problem.pddl").write_text(f"(define (problem p) (:domain d) (:init) (:goal (and {goal})))")
    loaded = serendipity.load(tmp_path, "any")
    names = [loaded.facts[goal.positive[0]] for _, goal in loaded.own_goals]
    assert (loaded.agents[loaded.human], loaded.own_goals[0][0], names) == ("ann", 1, ["at_carol"])
    beside = serendipity.with_bystanders(loaded, ["carol"])
    assert (beside.robot_goal, [deed.name for deed in beside.script.deeds]) == (Condition(), ["go_carol"])
