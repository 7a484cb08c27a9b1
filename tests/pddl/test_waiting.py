"""``noop`` and all that only waits: free, never in a plan, and nobody else's name."""

from fractions import Fraction
from pathlib import Path

import pytest

from serendipity import InputError, PlanError, load, plan, recognise
from serendipity.model import GroundAction
from serendipity_testing.builders import task as build
from tests.pddl.texts import YARD, action, domain, names, one, problem, two

WAIT = action("wait", "(home)", "(home) (increase (total-cost) 9)")
REST = action("rest", "(and)", "(increase (total-cost) 3)")
GO = action("go", "(q)", "(p)")


def waits(folder: Path, *more: str) -> str:
    """A task whose agents can wait in two ways."""
    return domain(WAIT, REST, GO, *more, predicates="(p) (q) (home)")


def test_a_given_plan_may_name_what_only_waits(tmp_path: Path) -> None:
    task = one(tmp_path, waits(tmp_path), problem("(q) (home)"))
    assert names(task) == ["go h", "go r"]
    assert task.waiting == {("wait h", 0), ("wait r", 1), ("rest h", 0), ("rest r", 1)}
    steps = task.plan_from_names(["WAIT h", "noop", "go  h", "rest h"])
    assert [task.actions[i].name for i in steps] == ["go h"]
    assert plan(task, human_plan=["rest h", "go h"]).human_plan == ("go h",)


def test_nobody_waits_for_somebody_else_nor_by_what_can_never_be_done(tmp_path: Path) -> None:
    task = one(tmp_path, waits(tmp_path), problem("(q) (home)"))
    with pytest.raises(PlanError, match="step 1: there is no action 'wait r'"):
        task.plan_from_names(["wait r", "go h"])
    assert task.with_human("r").plan_from_names(["wait r", "go r"])
    task = one(tmp_path, waits(tmp_path), problem("(q)"))
    with pytest.raises(PlanError, match="step 1: there is no action 'wait h'"):
        task.plan_from_names(["wait h", "go h"])


def test_waiting_may_be_observed(tmp_path: Path) -> None:
    task = one(tmp_path, waits(tmp_path), problem("(q) (home)"))
    goals = [{"name": "done", "goal": ["p"]}]
    assert recognise(task, goals, ["rest h", "go h"]) == recognise(task, goals, ["go h"])


def test_an_action_may_wait_in_one_case_and_not_in_another(tmp_path: Path) -> None:
    rest = action("rest", "(or (home) (p))", "(and)")
    text = domain(rest, GO, action("leave", "(r)", "(not (home))"), predicates="(p) (q) (r) (home)")
    task = one(tmp_path, text, problem("(q) (home)"))  # nobody can leave
    steps = task.plan_from_names(["rest h", "go h", "rest h"])
    assert [task.actions[i].name for i in steps] == ["go h", "rest h"]


def test_noops_of_files_are_waiting(tmp_path: Path) -> None:
    noop = "(:action noop :parameters () :precondition (home) :effect (home))"
    own = domain(
        noop, "(:action go :parameters () :precondition (q) :effect (p))", predicates="(p) (q) (home)"
    )
    task = two(tmp_path, (own, problem("(q) (home)")), (own, problem("(q) (home)", goal="")))
    assert names(task) == ["go", "go"]
    assert load(YARD).waiting


@pytest.mark.parametrize(("condition", "effect"), [("(and)", "(p)"), ("(q)", "(q)"), ("(not (q))", "(and)")])
def test_a_noop_that_does_something_is_refused(tmp_path: Path, condition: str, effect: str) -> None:
    noop = f"(:action noop :parameters () :precondition {condition} :effect {effect})"
    other = domain("(:action go :parameters () :precondition (p) :effect (not (p)))")
    own = domain("(:action do :parameters () :precondition (q) :effect (not (q)))", noop)
    message = r"h-domain.pddl:6: action 'noop': that name means waiting"
    with pytest.raises(InputError, match=message):
        two(tmp_path, (own, problem("(q)")), (other, problem("(q)", goal="")))


def test_noops_with_arguments_are_actions_like_others(tmp_path: Path) -> None:
    task = one(tmp_path, domain(action("noop", "(q)", "(p)")), problem("(q)"))
    assert names(task) == ["noop h", "noop r"]


def test_no_task_made_by_hand_has_such_a_noop() -> None:
    idle = GroundAction("noop", (0,), (), (), (), (), Fraction(0))
    assert idle.applicable(frozenset())
    with pytest.raises(InputError, match="action 'noop': that name means waiting"):
        GroundAction("noop", (0,), (), (), (0,), (), Fraction(0))
    with pytest.raises(InputError, match="action 'noop': that name means waiting"):
        build(actions={"noop": "-> p"}, agents="noop r", human="noop")
