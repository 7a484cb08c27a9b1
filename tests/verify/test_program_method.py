"""``--method program``: a solver decides every program, and the certificate counts what it was given."""

from dataclasses import replace
from typing import Any

import pytest

import serendipity
from serendipity.model import Claim, Options, Result, Task
from serendipity_testing.cases import case_1, case_4, case_8, case_10
from tests.verify.claims import claim_of
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.programs import effort
from verify.solvers.mip import SOLVERS, SolverOutcome, optimise


def _proved(task: Task, answer: Result, name: str, **options: Any) -> Claim:
    certificate = certify(task, answer, method="program", **options)
    assert certificate.verdict == "proved"
    return claim_of(certificate, name)


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_optimum_of_the_paper_s_example_is_the_solver_s(solver: str) -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.6")
    claim = _proved(task, answer, "optimal", solver=solver)
    assert (claim.method, claim.solver_calls) == ("program", 1)
    assert claim.size["columns"] > 1000 < claim.size["rows"]
    assert claim.reason.endswith("rows: objective 1012.6, optimum cost 12.6")


@pytest.mark.parametrize(
    ("task", "options", "name"),
    [
        (case_4(), {"discount": "0.9"}, "optimal"),
        (case_4(), {"discount": "0.9", "mode": "communication"}, "optimal"),
        (case_10(), {"discount": "0.5", "horizon": 2, "mode": "composite"}, "optimal"),
        (case_1(), {"discount": "0.5"}, "no_opportunity"),
        (case_8(), {"mode": "composite", "horizon": 1}, "infeasible"),
    ],
)
def test_a_solver_is_asked_where_reachability_would_do(
    task: Task, options: dict[str, Any], name: str
) -> None:
    answer = serendipity.plan(task, **options)
    by_reachability = claim_of(certify(task, answer), name)
    claim = _proved(task, answer, name)
    assert (by_reachability.method, by_reachability.solver_calls, by_reachability.size) == ("program", 0, {})
    assert claim.solver_calls >= 1
    assert claim.size["rows"] > 0
    assert "HiGHS" in claim.reason


def test_calls_of_all_claims_add_up() -> None:
    task = case_4()
    answer = serendipity.plan(task, discount="0.9", mode="communication", communication_weight="0.5")
    certificate = certify(task, answer, method="program")
    optimal = claim_of(certificate, "optimal")
    assert certificate.solver_calls == optimal.solver_calls == 2
    assert certificate.size == {"variables": optimal.size["columns"], "constraints": optimal.size["rows"]}


def test_what_a_limit_leaves_is_no_counter_example(monkeypatch: pytest.MonkeyPatch) -> None:
    """The program knows no limit on the objective: a plan that it allows need not beat the answer."""
    task = case_4()
    answer = solve(task, Options(discount="0.9"))  # type: ignore[arg-type]

    def stopped(*arguments: Any, **settings: Any) -> SolverOutcome:
        return replace(
            optimise(*arguments, **settings), status="undecided", reason="the time limit came first"
        )

    monkeypatch.setattr(effort, "optimise", stopped)
    optimal = claim_of(certify(task, answer, method="program"), "optimal")
    assert (optimal.verdict, optimal.counterexample) == ("undecided", None)
