"""Each exit code, and that nothing but the documented ones comes out.

A result that breaks a rule is not believed where it is used: a warning, or exit 1 with --strict.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import pytest

import serendipity
from serendipity.cli.exit_codes import OF_STATUS, OF_VERDICT, ExitCode
from serendipity.model import Result, Task
from serendipity.model.answers.answer import Status
from serendipity.pictures.scene.building import MOST_EPOCHS
from tests.cli.conftest import Runs, assert_one_line

HUMAN_ALONE_CANNOT = """
(define (domain d) (:requirements :strips)
  (:predicates (help ?a) (done ?a) (held ?a))
  (:action lift :parameters (?x ?y) :precondition (held ?x) :effect (help ?y))
  (:action finish :parameters (?x) :precondition (help ?x) :effect (done ?x)))
"""
PROBLEM = "(define (problem p) (:domain d) (:objects h r) (:init (held r)) (:goal (done h)))"


@pytest.fixture
def stuck(tmp_path: Path) -> str:
    """A task whose human can't reach their goal alone."""
    (tmp_path / "d.pddl").write_text(HUMAN_ALONE_CANNOT)
    (tmp_path / "p.pddl").write_text(PROBLEM)
    return "d.pddl p.pddl --human h --robot r"


def test_codes_are_the_documented_ones() -> None:
    assert {code.name: int(code) for code in ExitCode} == {
        "ANSWERED": 0,
        "REFUTED": 1,
        "WRONG_INPUT": 2,
        "INFEASIBLE": 3,
        "UNDECIDED": 4,
        "UNEXPECTED": 70,
        "INTERRUPTED": 130,
    }
    assert set(OF_STATUS) == set(get_args(Status))
    assert set(OF_VERDICT) == {"proved", "refuted", "undecided"}


def test_infeasible_is_3_and_still_written(stuck: str, run: Runs) -> None:
    done = run(f"plan {stuck} --format json")
    assert done.code == 3
    assert (json.loads(done.out)["status"], json.loads(done.out)["reason"]) == ("infeasible", "no-human-plan")
    assert run(f"plan {stuck}").out.count("infeasible") == 1


def test_a_joint_plan_where_he_has_none_is_0(stuck: str, run: Runs) -> None:
    assert run(f"plan {stuck} --mode composite").code == 0
    assert run(f"plan {stuck} --mode communication --horizon 2").code == 0


def anytime(monkeypatch: pytest.MonkeyPatch, error: BaseException | None, *found: Result) -> None:
    """Planning finds some answers, and then ends or fails."""

    def answers(task: Task, **options: Any) -> Iterator[Result]:
        yield from found
        if error is not None:
            raise error

    monkeypatch.setattr(serendipity, "plan_anytime", answers)


def test_no_answer_within_the_limit_is_4(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    anytime(monkeypatch, None, Result("serendipity", "unknown", "commx", serendipity.Options()))
    done = run("plan --example room2 --time-limit 60")
    assert done.code == 4
    assert "the limit came before any answer" in done.out


def test_an_interrupt_writes_the_incumbent_and_is_130(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    found = serendipity.plan(serendipity.example("room2"), discount=0.6)
    anytime(monkeypatch, KeyboardInterrupt(), replace(found, status="feasible"))
    done = run("plan --example room2 --discount 0.6 --format json -o answer.json")
    assert done.code == 130
    assert json.loads(Path("answer.json").read_text())["status"] == "feasible"


def test_an_interrupted_proof_does_not_lose_the_answer(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(task: Task, result: Result, **limits: Any) -> serendipity.Certificate:
        raise KeyboardInterrupt

    monkeypatch.setattr(serendipity, "verify", interrupted)
    done = run("plan --example room2 --discount 0.6 --verify -o answer.json")
    assert done.code == 130
    written = json.loads(Path("answer.json").read_text())
    assert (written["cost"], "certificate" in written) == (12.6, False)


def test_an_interrupt_before_any_plan_is_130_too(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    anytime(monkeypatch, KeyboardInterrupt())
    done = run("plan --example room2 -o answer.json")
    assert done.code == 130
    assert not Path("answer.json").exists()
    assert done.err.count("\n") == 1


def test_a_doctored_result_is_1(answer: dict[str, Any], run: Runs) -> None:
    assert run("verify --example room2 help.json").code in (0, 4)
    answer["plan"] = [step for step in answer["plan"] if not step["action"].startswith("hand_over")]
    Path("help.json").write_text(json.dumps(answer))
    done = run("verify --example room2 help.json")
    assert done.code == 1
    assert "refuted" in done.out
    certificate = json.loads(run("verify --example room2 help.json --format json").out)
    assert certificate["verdict"] == "refuted"
    assert any(claim["verdict"] == "refuted" and claim["reason"] for claim in certificate["claims"])


@pytest.mark.parametrize("option", ["", "-vv"])
def test_a_fault_of_ours_is_70(option: str, run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    anytime(monkeypatch, AssertionError("never\nso"))
    done = run(f"plan --example room2 {option}")
    assert (done.code, done.out) == (70, "")
    *before, last = done.err.splitlines()
    assert last.startswith("Error: unexpected AssertionError: never so: a fault of Serendipity; please")
    assert any("Traceback" in line for line in before) == bool(option)


USES = ("show --example room2 help.json -o out.svg", "simulate --example room2 help.json -o out.txt")


DOCTORED = [
    ({"cost": 11.0, "saving": 2.0, "objective": 1011.0, "lower_bound": 1011.0}, "cost"),
    ({"window": {"start": 99998, "end": 99999}}, "window"),
]


@pytest.mark.parametrize("command", USES)
@pytest.mark.parametrize(("changes", "claim"), DOCTORED)
def test_a_doctored_result_is_used_with_a_warning(
    command: str, changes: dict[str, Any], claim: str, answer: dict[str, Any], run: Runs
) -> None:
    Path("help.json").write_text(json.dumps(answer | changes))
    done = run(command)
    assert done.code == 0
    assert done.err.startswith("Warning: help.json does not hold: ")
    assert claim in done.err
    assert done.err.count("\n") == 1
    assert run(f"{command} --quiet").err == ""
    assert Path(command.split()[-1]).exists()


@pytest.mark.parametrize("command", USES)
def test_strictly_it_is_refused(command: str, answer: dict[str, Any], run: Runs) -> None:
    good = run(f"{command} --strict")
    assert (good.code, good.err) == (0, "")
    made = Path(command.split()[-1])
    made.unlink()
    Path("help.json").write_text(json.dumps(answer | DOCTORED[0][0]))
    done = run(f"{command} --strict")
    assert (done.code, done.out) == (1, "")
    assert done.err.startswith("Error: help.json does not hold: cost")
    assert not made.exists()


def test_nobody_draws_a_hundred_thousand_epochs(answer: dict[str, Any], run: Runs) -> None:
    answer["plan"][-1]["epoch"] = 100_000
    Path("help.json").write_text(json.dumps(answer))
    done = run("show --example room2 help.json -o out.html")
    assert_one_line(done, "help.json", "100000 epochs", str(MOST_EPOCHS))
