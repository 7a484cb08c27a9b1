"""Timed initial literals (PDDL 2.2): the script of a task."""

from pathlib import Path

import pytest

from serendipity.model import InputError, Task, TimedFact
from serendipity.pddl.layouts import read_folder
from serendipity.pddl.write import write_pddl
from serendipity_testing.oracle import human_plans
from tests.pddl import test_durative_actions as durative
from tests.pddl.test_durative_actions import DOMAIN, PROBLEM

SHOP = """(define (domain shop)
  (:requirements :typing :timed-initial-literals :multi-agent)
  (:types agent place)
  (:predicates (at ?a - agent ?p - place) (open ?p - place) (has ?a - agent))
  (:action go :agent ?a - agent :parameters (?x ?y - place)
    :precondition (at ?a ?x) :effect (and (not (at ?a ?x)) (at ?a ?y)))
  (:action buy :agent ?a - agent :parameters (?x - place)
    :precondition (and (at ?a ?x) (open ?x)) :effect (has ?a))
)
"""
DAY = """(define (problem day)
  (:domain shop)
  (:objects ann bob - agent home shop - place)
  (:init (at ann home) (at bob home)
    (at 30 (not (open shop)))
    (at 8 (open shop)))
  (:goal (has ann)))
"""


def read(folder: Path, domain: str = SHOP, problem: str = DAY, **more: object) -> Task:
    return durative.read(folder, domain, problem, **more)


def test_a_literal_becomes_true_with_the_epoch_that_ends_then(tmp_path: Path) -> None:
    task = read(tmp_path)
    open_ = task.facts.index("open shop")
    assert task.script.facts == (TimedFact(8, open_, True), TimedFact(30, open_, False))
    assert (task.epoch, task.script.last, task.needs_time) == (1, 30, True)
    assert "buy ann shop" in task.named  # though nobody ever opens it


def test_a_goal_may_be_what_only_the_script_brings_about(tmp_path: Path) -> None:
    domain = SHOP.replace("(has ?a - agent)", "(has ?a - agent) (dark)")
    problem = DAY.replace("(:goal (has ann))", "(:goal (and (dark) (not (open shop))))")
    task = read(tmp_path, domain, problem.replace("(at 8", "(at 40 (dark)) (at 8"))
    dark = task.facts.index("dark")
    assert (task.script.facts[-1], dark in task.goal.positive) == (TimedFact(40, dark, True), True)
    plan = next(human_plans(task))
    assert (tuple(plan), task.epochs_of(plan)) == ((), 40)


def test_predicates_called_at_are_not_mistaken_for_times(tmp_path: Path) -> None:
    assert "at ann home" in read(tmp_path).facts


def test_durations_and_times_have_one_unit(tmp_path: Path) -> None:
    durative = DOMAIN.replace(":durative-actions", ":durative-actions :timed-initial-literals")
    timed = PROBLEM.replace("(:init", "(:init (at 14 (path hall bed))")
    task = read(tmp_path, durative, timed)
    path = task.facts.index("path hall bed")
    assert (task.epoch, task.script.facts) == (2, (TimedFact(7, path, True),))
    assert "walk ann hall bed" in task.named
    assert read(tmp_path, durative, timed, epoch=5).script.facts == (TimedFact(3, path, True),)


def test_what_nobody_asks_for_is_left_out(tmp_path: Path) -> None:
    domain = SHOP.replace("(has ?a - agent)", "(has ?a - agent) (dark)")
    task = read(tmp_path, domain, DAY.replace("(at 8", "(at 20 (dark)) (at 8"))
    assert ("dark" in task.facts, task.script.last) == (False, 30)


def test_a_fact_that_only_the_script_changes_is_no_constant(tmp_path: Path) -> None:
    closing = DAY.replace("(at 8 (open shop))", "").replace("(at bob home)", "(at bob home) (open shop)")
    task = read(tmp_path, SHOP, closing)
    assert "open shop" in task.facts
    (variable,) = (v for v in task.variables if task.facts.index("open shop") in v.facts)
    assert variable.boolean


@pytest.mark.parametrize(
    ("new", "line", "message"),
    [
        ("(at 8 (opened shop))", 6, "unknown predicate 'opened'"),
        ("(at 8 (open ann))", 6, "'ann' is of type 'agent', expected type 'place'"),
        ("(at 8 (= (price shop) 3))", 6, "timed initial fluents ('(at 8 (...))') are not supported"),
        ("(on 8 (open shop))", 6, "expected '(at TIME LITERAL)', got 'on'"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(tmp_path: Path, new: str, line: int, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, SHOP, DAY.replace("(at 8 (open shop))", new))
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{tmp_path / 'problem.pddl'}:{line}: ")
    assert "\n" not in str(caught.value)


def test_tasks_with_time_are_written_and_read_back(tmp_path: Path) -> None:
    task = read(tmp_path, DOMAIN, PROBLEM.replace("(:init", "(:init (at 14 (path hall bed))"))
    write_pddl(task, tmp_path / "written")
    again = read_folder(tmp_path / "written", "ann", epoch=1)

    def words(one: Task) -> list[object]:
        return sorted(
            (
                a.name.replace(" ", "_"),
                a.duration,
                a.cost,
                *(sorted(one.facts[f].replace(" ", "_") for f in part)),
            )
            for a in one.actions
            for moment in a.moments
            for part in (moment.pre, moment.neg, moment.add, moment.delete)
        )

    assert words(again) == words(task)
    assert [(one.epoch, one.true) for one in again.script.facts] == [(7, True)]
