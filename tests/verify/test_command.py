"""``serendipity verify``: encoding, solver and limit are the user's; proofs say how they came about."""

import json
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.cli.app import main
from serendipity.model import Claim, Options, Result, Task
from serendipity.pddl.write import write_pddl
from serendipity.testing.cases import case_10
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.programs import effort
from verify.solvers.mip import SolverOutcome


def _written(folder: Path, task: Task, **options: Any) -> tuple[str, str]:
    write_pddl(task, folder / "task")
    read = serendipity.load(folder / "task", human="h")
    answer = folder / "answer.json"
    answer.write_text(json.dumps(solve(read, Options(**options)).to_dict()))
    return str(folder / "task"), str(answer)


@pytest.mark.parametrize(
    ("encoding", "solver"), [("automata", "highs"), ("automata", "cbc"), ("paper", "cbc")]
)
def test_encoding_and_solver_are_chosen(
    encoding: str, solver: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = _written(tmp_path, case_10(), discount="0.5", horizon=2)
    words = ["verify", *named, "--human", "h", "--encoding", encoding, "--solver", solver, "--format", "json"]
    assert main(words) == 0
    certificate = json.loads(capsys.readouterr().out)
    assert certificate["encoding"] == encoding
    assert certificate["solver"].lower().startswith(solver)


@pytest.mark.parametrize(
    "option",
    [("--encoding", "enigma"), ("--solver", "abacus"), ("--time-limit", "nan"), ("--time-limit", "-1")],
)
def test_wrong_options(option: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    named = _written(tmp_path, case_10(), discount="0.5", horizon=2)
    assert main(["verify", *named, "--human", "h", *option]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "expected" in said


def _optimal(task: Task, result: Result, encoding: str) -> Claim:
    claims = certify(task, result, encoding=encoding).claims
    return next(claim for claim in claims if claim.claim == "optimal")


def test_a_proof_without_a_solver_says_so() -> None:
    task = case_10()
    answer = solve(task, Options(discount="0.5", horizon=2))  # type: ignore[arg-type]
    by_pruning, by_solver = (_optimal(task, answer, encoding) for encoding in ("automata", "paper"))
    assert by_pruning.reason.endswith("closed by reachability and shortest paths, no solver call")
    assert by_solver.reason == "no plan has an objective below 1003"
    assert by_pruning.bound == by_solver.bound == answer.objective == 1003.0


@pytest.mark.parametrize(("known", "said"), [(1004.25, 1004.4), (2000.0, 1012.6), (-3.0, 0.0), (None, None)])
def test_what_is_undecided_still_has_a_bound(
    known: float | None, said: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a stopped solver knows, rounded up to the next possible cost; no more than was asked for."""
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.6")

    def stopped(*_: object, **__: object) -> SolverOutcome:
        return SolverOutcome("undecided", bound=None if known is None else known * 5, reason="time limit")

    monkeypatch.setattr(effort, "optimise", stopped)
    claims = certify(task, answer, encoding="paper").claims
    optimal = next(claim for claim in claims if claim.claim == "optimal")
    assert (optimal.verdict, optimal.bound) == ("undecided", said)
    assert ("no answer has an objective below" in optimal.reason) == (said is not None)
