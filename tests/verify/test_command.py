"""``serendipity verify``: encoding, solver and limit are the user's; proofs say how they came about."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import serendipity
from serendipity.model import Options
from serendipity.pddl.write import write_pddl
from serendipity_testing.cases import case_10
from tests.cli.conftest import Run, Runs, assert_one_line
from tests.verify.claims import claim_of
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.programs import effort
from verify.solvers.mip import SolverOutcome


@pytest.fixture
def verified(run: Runs) -> Callable[[str], Run]:
    """Verify an answer to case 10, read from files, under more options."""
    write_pddl(case_10(), "task")
    answer = solve(serendipity.load("task", human="h"), Options(discount="0.5", horizon=2))
    Path("answer.json").write_text(json.dumps(answer.to_dict()))
    return lambda options: run(f"verify task answer.json --human h {options}")


@pytest.mark.parametrize(
    ("encoding", "solver"), [("automata", "highs"), ("automata", "cbc"), ("paper", "cbc")]
)
def test_encoding_and_solver_are_chosen(encoding: str, solver: str, verified: Callable[[str], Run]) -> None:
    certificate = json.loads(verified(f"--encoding {encoding} --solver {solver} --format json").out)
    assert certificate["encoding"] == encoding
    assert certificate["solver"].lower().startswith(solver)


@pytest.mark.parametrize(
    "option", ["--encoding enigma", "--solver abacus", "--time-limit nan", "--time-limit -1"]
)
def test_wrong_options(option: str, verified: Callable[[str], Run]) -> None:
    assert_one_line(verified(option), "expected")


def test_a_proof_without_a_solver_says_so() -> None:
    task = case_10()
    answer = solve(task, Options(discount="0.5", horizon=2))  # type: ignore[arg-type]
    by_pruning, by_solver = (
        claim_of(certify(task, answer, encoding=encoding), "optimal") for encoding in ("automata", "paper")
    )
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
    optimal = claim_of(certify(task, answer, encoding="paper"), "optimal")
    assert (optimal.verdict, optimal.bound) == ("undecided", said)
    assert ("no answer has an objective below" in optimal.reason) == (said is not None)
