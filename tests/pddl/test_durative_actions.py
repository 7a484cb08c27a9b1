"""Durative actions (PDDL 2.1): what each form of them means, and what is refused, with file and line."""

from fractions import Fraction
from pathlib import Path

import pytest

from serendipity.model import Condition, GroundAction, InputError, Task, UsageError
from serendipity.pddl.layouts import read_agents, read_pddl
from tests.pddl.texts import facts, pair
from tests.tables import table

DOMAIN = """(define (domain home)
  (:requirements :typing :durative-actions)
  (:types agent place)
  (:predicates (at ?a - agent ?p - place) (path ?x ?y - place) (busy ?a - agent) (clean ?p - place))
  (:functions (far ?x ?y - place) (total-cost))
  (:durative-action walk
    :parameters (?a - agent ?x ?y - place)
    :duration (= ?duration 4)
    :condition (and (at start (at ?a ?x)) (over all (path ?x ?y)))
    :effect (and (at start (not (at ?a ?x))) (at end (at ?a ?y))))
  (:durative-action sweep
    :parameters (?a - agent ?x - place)
    :duration (= ?duration 6)
    :condition (and (over all (at ?a ?x)) (at start (not (busy ?a))) (at end (busy ?a)))
    :effect (and (at start (busy ?a)) (at end (and (not (busy ?a)) (clean ?x)))))
)
"""
PROBLEM = """(define (problem p)
  (:domain home)
  (:objects ann bob - agent bed hall - place)
  (:init (at ann bed) (at bob bed) (path bed hall) (= (far bed hall) 3))
  (:goal (clean hall)))
"""


def read(folder: Path, domain: str = DOMAIN, problem: str = PROBLEM, **more: object) -> Task:
    """The task of two texts, ann being the human and bob the robot."""
    return read_pddl(*pair(folder, domain, problem), "ann", ["bob"], **more)  # type: ignore[arg-type]


def action(task: Task, name: str) -> GroundAction:
    (i,) = task.named[name]
    return task.actions[i]


def literals(task: Task, condition: Condition) -> set[str]:
    return {task.facts[f] for f in condition.positive} | {f"!{task.facts[f]}" for f in condition.negative}


def changed(old: str, new: str, text: str = DOMAIN) -> str:
    assert old in text
    return text.replace(old, new, 1)


def test_each_part_comes_at_its_time(tmp_path: Path) -> None:
    task = read(tmp_path)
    sweep = action(task, "sweep ann hall")
    assert sweep.timing is not None
    assert (sweep.duration, sweep.cost, task.epoch) == (3, 6, 2)
    assert literals(task, sweep.precondition) == {"!busy ann"}
    assert literals(task, sweep.timing.over_all) == {"at ann hall"}
    assert literals(task, sweep.timing.at_end) == {"busy ann"}
    assert facts(task, sweep.timing.start_add) == {"busy ann"}
    assert facts(task, sweep.add) == {"clean hall"}
    assert facts(task, sweep.delete) == {"busy ann"}
    walk = action(task, "walk ann bed hall")
    assert walk.timing is not None
    assert (walk.duration, facts(task, walk.timing.start_delete)) == (2, {"at ann bed"})
    assert "walk ann hall bed" not in task.named  # over all the path has to be there
    assert task.needs_time
    assert task.warnings == ()


def test_actions_of_one_epoch_are_what_actions_always_were(tmp_path: Path) -> None:
    task = read(tmp_path, epoch=6)
    sweep = action(task, "sweep ann hall")
    assert (sweep.timing, literals(task, sweep.precondition)) == (None, {"at ann hall", "!busy ann"})
    assert facts(task, sweep.add) == {"busy ann", "clean hall"}
    assert facts(task, sweep.delete) == set()
    walk = action(task, "walk ann bed hall")
    assert (facts(task, walk.add), facts(task, walk.delete)) == ({"at ann hall"}, {"at ann bed"})
    assert not task.needs_time
    assert task.warnings == (
        "durations are rounded up to whole epochs of 6: 'walk ann bed hall' takes 6 instead of 4",
    )


def test_times_of_the_script_are_said_to_be_rounded_beside_durations(tmp_path: Path) -> None:
    timed = changed("(:init", "(:init (at 7 (busy ann))", PROBLEM)
    assert [line.partition(" of 6")[0] for line in read(tmp_path, DOMAIN, timed, epoch=6).warnings] == [
        "times of the script are rounded up to whole epochs", "durations are rounded up to whole epochs",
    ]  # fmt: skip


def test_an_action_is_as_dear_as_it_is_long_unless_costs_are_said(tmp_path: Path) -> None:
    assert action(read(tmp_path), "walk ann bed hall").cost == 4
    priced = changed("(at end (at ?a ?y))", "(at end (at ?a ?y)) (at start (increase (total-cost) 7))")
    task = read(tmp_path, priced)
    assert (action(task, "walk ann bed hall").cost, action(task, "sweep ann hall").cost) == (7, 0)
    timed = changed("(:goal", "(:metric minimize (total-time)) (:goal", PROBLEM)
    task = read(tmp_path, priced, timed)
    assert action(task, "walk ann bed hall").cost == 4
    (warning,) = task.warnings
    assert "total-time is read as: actions cost their durations" in warning


@pytest.mark.parametrize(
    ("duration", "epochs", "unit"),
    [
        ("(= ?duration (far ?x ?y))", 1, 3),
        ("(= ?duration (* 2 (+ (far ?x ?y) 0.5)))", 7, 1),
        ("(= ?duration (/ (far ?x ?y) 2))", 1, Fraction(3, 2)),
        ("(and (>= ?duration 2) (>= ?duration (far ?x ?y)) (<= ?duration 9))", 1, 3),
        ("(at start (= ?duration 4))", 2, 2),
        ("(>= ?duration 0.25)", 1, Fraction(1, 4)),
    ],
)
def test_durations_are_numbers_static_functions_and_what_is_calculated_of_them(
    tmp_path: Path, duration: str, epochs: int, unit: Fraction
) -> None:
    task = read(tmp_path, changed("(= ?duration 4)", duration))
    assert (action(task, "walk ann bed hall").duration, task.epoch) == (epochs, unit)


def test_of_bounds_the_least_is_taken_and_that_is_said_once(tmp_path: Path) -> None:
    domain = changed("(= ?duration 4)", "(and (>= ?duration 4) (<= ?duration 8))")
    domain = changed("(= ?duration 6)", "(>= ?duration 6)", domain)
    task = read(tmp_path, domain)
    assert [action(task, name).cost for name in ("walk ann bed hall", "sweep ann hall")] == [4, 6]
    (warning,) = task.warnings
    assert "domain.pddl:6: action 'walk': of durations between bounds the least" in warning


def test_ordinary_actions_take_an_epoch_of_a_unit_of_time(tmp_path: Path) -> None:
    domain = changed(
        "(:durative-action sweep",
        "(:action shout :parameters (?a - agent) :effect (busy ?a)) (:durative-action sweep",
    )
    task = read(tmp_path, domain)
    assert (task.epoch, action(task, "walk ann bed hall").duration) == (1, 4)
    assert (action(task, "shout ann").duration, action(task, "shout ann").cost) == (1, 1)


def test_conditions_may_be_quantified(tmp_path: Path) -> None:
    everywhere = "(forall (?q - place) (and (over all (not (clean ?q))) (at start (path ?x ?y))))"
    task = read(tmp_path, changed("(over all (path ?x ?y))", everywhere))
    walk = action(task, "walk ann bed hall")
    assert walk.timing is not None
    assert literals(task, walk.timing.over_all) == {"!clean bed", "!clean hall"}
    task = read(tmp_path, changed("(over all (path ?x ?y))", "(at start (exists (?q - place) (path ?x ?q)))"))
    assert "walk ann bed bed" in task.named
    effects = changed(
        "(at end (at ?a ?y))", "(at end (at ?a ?y)) (forall (?q - place) (at start (not (clean ?q))))"
    )
    walk = action(task := read(tmp_path, effects), "walk ann bed hall")
    assert walk.timing is not None
    assert facts(task, walk.timing.start_delete) == {"at ann bed", "clean bed", "clean hall"}


def test_ma_pddl_names_the_agent(tmp_path: Path) -> None:
    domain = DOMAIN.replace("    :parameters (?a - agent ", "    :agent ?a - agent :parameters (")
    (tmp_path / "d.pddl").write_text(domain)
    (tmp_path / "p.pddl").write_text(PROBLEM)
    task = read_pddl(tmp_path / "d.pddl", tmp_path / "p.pddl", "ann")
    assert (task.agents, action(task, "sweep bob hall").participants) == (("ann", "bob"), (1,))
    assert action(task, "sweep bob hall").duration == 3


def test_each_agent_may_have_files(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(DOMAIN)
    for name, other in (("ann", "bob"), ("bob", "ann")):
        own = PROBLEM.replace(f"(at {other} bed)", "").replace("ann bob - agent", f"{name} - agent")
        own = own if name == "ann" else own.replace("(:goal (clean hall))", "")
        (tmp_path / f"{name}.pddl").write_text(own)
    task = read_agents({name: (tmp_path / "d.pddl", tmp_path / f"{name}.pddl") for name in ("ann", "bob")})
    assert (task.epoch, action(task, "sweep bob hall").duration) == (2, 3)


WRONG = """
(= ?duration 4) | (= ?duration long) | 8 | expected a number, got 'long'
(= ?duration 4) | () | 8 | expected '(= ?duration N)' or '(>= ?duration N)', got '()'
(= ?duration 4) | (<= ?duration 4) | 8 | expected '(= ?duration N)' or '(>= ?duration N)'
(= ?duration 4) | (< ?duration 4) | 8 | expected '=', '<=' or '>=' before '?duration'
(= ?duration 4) | (= ?time 4) | 8 | expected '?duration', got '?time'
(= ?duration 4) | (= ?duration (far ?x)) | 8 | function 'far' takes 2 arguments, got 1
(= ?duration 4) | (= ?duration (- (far bed hall) 3)) | 8 | object 'bed' is not declared
(= ?duration 4) | (= ?duration (- (far ?x ?y) 3)) | 6 | 'walk ann bed hall': expected a duration above 0
(= ?duration 4) | (= ?duration (far ?y ?x)) | 6 | no initial value of 'far hall bed' for its duration
(= ?duration 4) | (= ?duration (/ 4 0)) | 8 | division by zero
(= ?duration 4) | (= ?duration (/ 4 (- (far ?x ?y) 3))) | 6 | division by zero in its duration
(= ?duration 4) | (and (>= ?duration 4) (<= ?duration (far ?x ?y))) | 6
  | expected a duration of at least 4, and of at most 3
(= ?duration 4) | (= ?duration 0.000001) | 11 | takes 6,000,000 epochs of 1e-06
:duration (= ?duration 4) |  | 6 | action 'walk': expected a ':duration'
:duration (= ?duration 4) | :precondition () | 8 | expected ':parameters', ':duration', ':condition'
(at start (at ?a ?x)) | (at ?a ?x) | 9 | expected '(at start ...)' or '(over all ...)' or '(at end
(over all (path ?x ?y)) | (over all (or (clean ?x) (clean ?y))) | 6 | 'over all': expected no 'or'
(over all (path ?x ?y)) | (over all (>= (far ?x ?y) 2)) | 9 | numeric conditions are not supported
(at end (at ?a ?y)) | (at ?a ?y) | 10 | expected '(at start ...)' or '(at end ...)', got '(at ?a ?y)'
(at end (at ?a ?y)) | (over all (at ?a ?y)) | 10 | expected '(at start ...)' or '(at end ...)'
(at end (at ?a ?y)) | (increase (far ?x ?y) (* #t 2)) | 10
  | continuous effects ('increase' without 'at start' or 'at end') are not supported
(at end (at ?a ?y)) | (at end (increase (total-cost) (* 2 ?duration))) | 10
  | '?duration' in effects on numbers is not supported
(at end (at ?a ?y)) | (at end (decrease (far ?x ?y) 1)) | 10
  | numeric effects are not supported, except 'increase (total-cost)'
(at end (at ?a ?y)) | (when (at start (clean ?x)) (at end (at ?a ?y))) | 10
  | conditional effects of durative actions are not supported
(:durative-action sweep | (:durative-action walk | 11 | action 'walk' is defined already in line 6
:durative-actions) | :durative-actions :continuous-effects) | 2 | continuous effects
"""


@pytest.mark.parametrize(("old", "new", "line", "message"), table(WRONG))
def test_what_is_wrong_is_said_in_a_line(tmp_path: Path, old: str, new: str, line: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, changed(old, new))
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{tmp_path / 'domain.pddl'}:{line}: ")
    assert "\n" not in str(caught.value)


def test_too_many_epochs_are_told_with_the_way_out(tmp_path: Path) -> None:
    long = changed("(= ?duration 4)", "(= ?duration 6000001)")
    with pytest.raises(InputError, match=r"at most 1,000,000: longer epochs can be asked for with --epoch"):
        read(tmp_path, long)
    assert action(read(tmp_path, long, epoch="1000.5"), "walk ann bed hall").duration == 5998


@pytest.mark.parametrize("epoch", [0, -1, "soon", float("nan")])
def test_an_epoch_is_some_time(tmp_path: Path, epoch: object) -> None:
    with pytest.raises(UsageError, match="epoch: expected a"):
        read(tmp_path, epoch=epoch)


def test_a_disjunctive_goal_that_actions_change_while_they_go_on_is_refused(tmp_path: Path) -> None:
    either = changed("(clean hall)", "(or (clean hall) (busy bob))", PROBLEM)
    with pytest.raises(InputError, match=r"'or' with '.*', which durative actions or the script change"):
        read(tmp_path, DOMAIN, either)
