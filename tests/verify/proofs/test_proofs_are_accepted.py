"""What is proved is written down, and anybody who reads it again agrees."""

import gzip
import itertools
import json
import os
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Deadline, Options, Result, Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_1, case_4, case_10
from serendipity_testing.strategies import Call, calls
from tests.verify.proofs.samples import entry
from tests.verify.test_ip_solver import least
from tests.verify.untrue import dearer
from verify.base.undecided import UndecidedError
from verify.calls.solve import solve
from verify.limits import limited
from verify.proofs.checker import RejectedProofError, program, refute
from verify.proofs.tree import refutation
from verify.solvers.mip import Model


def _proof(task: Task, result: Result, file: Path, **options: Any) -> dict[str, Any]:
    """The proof of a result, accepted by whoever reads it."""
    certificate = serendipity.verify(task, result, proof=file, **options)
    assert certificate.verdict == "proved", certificate
    for found in (serendipity.check_proof(file), serendipity.check_proof(file, task, result)):
        assert found.accepted, found
    read: dict[str, Any] = json.loads(file.read_bytes())
    return read


# -- planning calls


@given(calls())
def test_answers_are_proved_for_anybody(call: Call) -> None:
    try:
        answer = solve(call.task, call.options, human_plan=call.human_plan_names)
    except UsageError:
        return
    if call.options.mode == "composite" and "inf" in (answer.horizon, call.options.horizon):
        return
    with TemporaryDirectory() as folder:
        _proof(call.task, answer, Path(folder, "proof.json"))


@pytest.mark.parametrize("encoding", ["automata", "paper"])
def test_every_encoding_is_proved(encoding: str, tmp_path: Path) -> None:
    task = case_10()
    answer = solve(task, Options(discount=Fraction(1, 2), horizon=2))
    proof = _proof(task, answer, tmp_path / "proof.json", encoding=encoding)
    assert proof["encoding"] == encoding


@pytest.mark.parametrize("solver", ["highs", "cbc"])
def test_a_proof_says_what_the_optimum_is(solver: str, tmp_path: Path) -> None:
    task = case_4()
    answer = serendipity.plan(task, discount="0.9")
    proof = _proof(task, answer, tmp_path / "proof.json", solver=solver)
    (only,) = proof["programs"]
    unit = Fraction(only["unit"])
    assert (proof["claim"], only["name"]) == ("optimal", "every window, 8 epochs")
    assert float((only["limit"] + 1) * unit) == answer.objective == 1006.2
    (found,) = serendipity.check_proof(tmp_path / "proof.json").programs
    assert found.optimum == only["limit"] + 1


def test_every_row_says_what_it_stands_for(tmp_path: Path) -> None:
    task = case_4()
    proof = _proof(task, serendipity.plan(task, discount="0.9"), tmp_path / "proof.json")
    families = {row["family"] for row in proof["programs"][0]["rows"]}
    assert {"eq. 3", "eq. 8", "eq. 10: h", "eq. 10: rob"} <= families
    assert "" not in families


@pytest.mark.parametrize("mode", ["individual", "serendipity"])
def test_what_the_human_can_do_alone(mode: str, tmp_path: Path) -> None:
    can = build(goal="p", actions={"a h": "-> q", "b h": "q -> p", "help r": "-> q"})
    cannot = build(goal="p", actions={"a h": "-> !q", "b h": "q -> p", "help r": "-> q"})
    answer = serendipity.plan(cannot, mode=mode)
    assert answer.reason == "no-human-plan"
    proof = _proof(cannot, answer, tmp_path / "no.json")
    assert (proof["claim"], proof["programs"][0]["limit"]) == ("infeasible", None)
    if mode == "individual":
        proof = _proof(can, serendipity.plan(can, mode=mode), tmp_path / "yes.json")
        assert (proof["claim"], proof["programs"][0]["limit"]) == ("optimal", 1)
        assert proof["programs"][0]["name"] == "the human alone, 3 states"


def test_a_bound_and_no_epochs_at_all(tmp_path: Path) -> None:
    task, doctored = dearer()
    feasible = replace(doctored, status="feasible", lower_bound=1008.5)
    assert _proof(task, feasible, tmp_path / "bound.json")["claim"] == "lower_bound"
    done = build(init="p", goal="p", actions={"do h": "-> p", "help r": "-> p"})
    assert _proof(done, serendipity.plan(done), tmp_path / "done.json")["programs"][0]["columns"] == []


@pytest.mark.long
def test_equal_proofs_are_equal_files(tmp_path: Path) -> None:
    """Whatever the hash seed is: programs are made again by other processes."""
    script = "import sys, serendipity as s; t = s.example('room7'); s.verify(t, s.plan(t), proof=sys.argv[1])"
    contents = []
    for seed in ("1", "2"):
        file = tmp_path / f"{seed}.json.gz"
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)}
        subprocess.run([sys.executable, "-c", script, file], env=environment, check=True)
        contents.append(file.read_bytes())
    assert contents[0] == contents[1]
    assert json.loads(gzip.decompress(contents[0]))["schema"] == "serendipity.proof/1"


# -- what there is no proof of


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"mode": "composite", "horizon": "inf"}, "plans without a horizon"),
        ({"human_model": "observant", "discount": "0.9"}, "a human who replans, where"),
        ({"mode": "assistance"}, "mode assistance"),
    ],
)
def test_no_programs_no_proof(options: dict[str, Any], what: str, tmp_path: Path) -> None:
    task = case_4()
    answer = serendipity.plan(task, **options)
    with pytest.raises(UsageError, match=f"there are no programs for {what}"):
        serendipity.verify(task, answer, proof=tmp_path / "proof.json")


def test_what_is_not_proved_is_not_written(tmp_path: Path) -> None:
    task, doctored = dearer()
    assert serendipity.verify(task, doctored, proof=tmp_path / "refuted.json").verdict == "refuted"
    answer = serendipity.plan(case_1())
    assert serendipity.verify(case_1(), answer, proof=tmp_path / "late.json", time_limit=0).verdict == (
        "undecided"
    )
    assert list(tmp_path.iterdir()) == []


# -- programs


def _refuted(model: Model, limit: int | None) -> int:
    """Leaves of a tree that the checker accepts."""
    return refute(program(json.loads(json.dumps(entry(model, limit))), "program")).leaves


@given(st.integers(0, 10**6))
def test_random_programs_with_general_bounds(seed: int) -> None:
    dice, model = Random(seed), Model()
    for _ in range(dice.randint(1, 5)):
        low = dice.randint(-3, 1)
        column = model.column(low, low + dice.randint(0, 4))
        model.objective[column] = dice.randint(-5, 5)
    for _ in range(dice.randint(1, 6)):
        terms = {x: dice.randint(-4, 4) for x in range(len(model.upper)) if dice.random() < 0.7}
        model.add(terms, dice.choice(("<=", ">=", "==")), dice.randint(-6, 6))
    best = least(model)
    _refuted(model, None if best is None else best - 1)
    if best is not None:
        with pytest.raises(UndecidedError):
            refutation(model, best, Deadline())


def test_a_leaf_that_leaves_something_is_rejected() -> None:
    model = Model()
    model.objective[model.binary()] = 1
    entry = {
        "name": "one column",
        "columns": [[0, 1]],
        "objective": [[0, 1]],
        "limit": 0,
        "rows": [],
        "tree": {"multipliers": [[-1, "1/1"]]},
    }
    with pytest.raises(RejectedProofError, match="leaf 1 leaves something"):
        refute(program(entry, "program"))


def test_numbers_beyond_machine_words_are_added_up_exactly() -> None:
    """Of three sets two are needed, where one is paid for; a limit on all of them is far away."""
    model = Model()
    columns = [model.binary() for _ in range(3)]
    model.objective = dict.fromkeys(columns, 1)
    model.add(dict.fromkeys(columns, 7), "<=", 10**25)
    for pair in itertools.combinations(columns, 2):
        model.add(dict.fromkeys(pair, 1), ">=", 1)
    with limited(coefficient=10**26):
        refute(program(entry(model, 1), "covering"))
