"""The solver adapter's contract: what counts as a proof, and what does not."""

import random
import sys
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from time import perf_counter

import pytest

from serendipity.model import Deadline
from serendipity.model.resources.memory import resident
from verify.limits import limited, limits
from verify.solvers import cbc, highs, worker
from verify.solvers.mip import SOLVERS, Model, optimise

solvers = pytest.mark.parametrize("solver", SOLVERS)


def _cover(seed: int, columns: int, rows: int) -> Model:
    """A random covering problem; at 1000 by 500 it takes seconds."""
    dice = random.Random(seed)
    model = Model()
    for _ in range(columns):
        model.objective[model.binary()] = dice.randint(1, 20)
    for _ in range(rows):
        model.add(dict.fromkeys(dice.sample(range(columns), 6), 1), ">=", 1)
    return model


def least(model: Model) -> int | None:
    """The optimum by trying everything."""
    sides = {"<=": int.__le__, ">=": int.__ge__, "==": int.__eq__}
    columns = (range(low, high + 1) for low, high in zip(model.lower, model.upper, strict=True))
    found = (
        sum(values[x] * weight for x, weight in model.objective.items())
        for values in product(*columns)
        if all(sides[r.sense](sum(values[x] * c for x, c in r.terms.items()), r.right) for r in model.rows)
    )
    return min(found, default=None)


@solvers
@pytest.mark.parametrize("seed", range(5))
def test_optimum_is_the_least(solver: str, seed: int) -> None:
    model = _cover(seed, 10, 6)
    outcome = optimise(model, solver=solver)
    assert outcome.status == "optimal"
    assert outcome.values is not None
    objective = sum(outcome.values[x] * weight for x, weight in model.objective.items())
    assert objective == least(model)
    assert outcome.bound is None or outcome.bound <= objective + 1e-6


@solvers
def test_infeasible_is_a_proof_without_values(solver: str) -> None:
    model = Model()
    x, y = model.binary(), model.binary()
    model.add({x: 1, y: 1}, ">=", 2)
    model.add({x: 1, y: 1}, "<=", 1)
    outcome = optimise(model, solver=solver)
    assert (outcome.status, outcome.values) == ("infeasible", None)


@solvers
def test_a_time_limit_is_no_proof(solver: str) -> None:
    model = _cover(1, 1000, 500)
    outcome = optimise(model, solver=solver, deadline=Deadline(0.2))
    assert outcome.status == "undecided"
    assert outcome.reason.startswith("the time limit came first")


def test_no_time_at_all_is_no_proof() -> None:
    outcome = optimise(_cover(1, 10, 5), deadline=Deadline(0))
    assert (outcome.status, outcome.values) == ("undecided", None)


@solvers
@pytest.mark.parametrize(
    ("sense", "right", "status"),
    [("<=", 0, "optimal"), ("<=", -1, "infeasible"), (">=", 1, "infeasible"), ("==", 1, "infeasible")],
)
def test_rows_without_columns_are_checked(solver: str, sense: str, right: int, status: str) -> None:
    model = Model()
    model.binary()
    model.add({}, sense, right)
    assert optimise(model, solver=solver).status == status


def test_numbers_that_tolerances_blur_are_no_proof() -> None:
    model = Model()
    model.objective[model.binary()] = limits().coefficient + 1
    outcome = optimise(model)
    assert outcome.status == "undecided"
    assert "digits" in outcome.reason


# -- solvers as processes


@pytest.fixture
def in_a_process() -> Iterator[None]:
    """HiGHS solves nothing in this process."""
    with limited(solved_here=0):
        yield


@pytest.mark.long
@pytest.mark.parametrize("presolve", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_a_process_says_what_a_call_says(seed: int, presolve: bool) -> None:
    model = _cover(seed, 12, 8)
    model.presolve = presolve
    here = optimise(model)
    with limited(solved_here=0):
        apart = optimise(model)
        assert (apart.status, apart.values, apart.bound) == (here.status, here.values, here.bound)
        model.add({0: 1}, ">=", 2)
        assert optimise(model).status == "infeasible"


def test_what_takes_longer_than_a_moment_is_solved_in_a_process(monkeypatch: pytest.MonkeyPatch) -> None:
    model = _cover(3, 12, 8)
    with limited(solver_seconds=0.0):
        assert optimise(model, deadline=Deadline(60)).status == "optimal"
        monkeypatch.setattr(worker, "__file__", "missing.py")
        assert "exit status" in optimise(model, deadline=Deadline(60)).reason


def _stubborn(folder: Path, does: str) -> Path:
    """A solver that knows a bound, and then keeps no limit."""
    script = folder / "stubborn.py"
    script.write_text(f"import time\nprint('{{\"bound\": 3.0}}', flush=True)\n{does}\ntime.sleep(60)\n")
    return script


@pytest.mark.usefixtures("in_a_process")
def test_a_solver_that_keeps_no_limit_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "__file__", str(_stubborn(tmp_path, "")))
    started = perf_counter()
    outcome = optimise(_cover(1, 10, 5), deadline=Deadline(1.0))
    assert perf_counter() - started < 10
    assert (outcome.status, outcome.bound) == ("undecided", 3.0)
    assert outcome.reason == "the time limit came first, solving a program of 10 columns and 5 rows"


@pytest.mark.skipif(
    not Path("/proc/self/statm").exists(), reason="another process's memory is known on Linux"
)
@pytest.mark.usefixtures("in_a_process")
def test_a_solver_s_memory_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "__file__", str(_stubborn(tmp_path, "a = bytearray(b'x') * 300_000_000")))
    limit = (resident() or 0) / 2**20 + 200
    outcome = optimise(_cover(1, 10, 5), deadline=Deadline(memory_limit=limit))
    assert (outcome.status, outcome.bound) == ("undecided", 3.0)
    assert outcome.reason.startswith("memory is used up")


@pytest.mark.skipif(sys.platform == "win32", reason="a script is no program there")
def test_cbc_is_killed_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = _stubborn(tmp_path, "")
    script.write_text(f"#!{sys.executable}\n{script.read_text()}")
    script.chmod(0o755)
    monkeypatch.setattr(cbc, "_binary", lambda: str(script))
    started = perf_counter()
    outcome = optimise(_cover(1, 10, 5), solver="cbc", deadline=Deadline(1.0))
    assert perf_counter() - started < 10
    assert (outcome.status, outcome.values) == ("undecided", None)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.usefixtures("in_a_process")
def test_a_solver_that_breaks_proves_nothing(
    solver: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "__file__", str(tmp_path / "missing.py"))
    monkeypatch.setattr(cbc, "_binary", lambda: sys.executable)  # which takes a program of ours for its own
    outcome = optimise(_cover(1, 10, 5), solver=solver)
    assert (outcome.status, outcome.values) == ("undecided", None)
    assert "exit status" in outcome.reason


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.usefixtures("in_a_process")
def test_a_disk_that_is_full_proves_nothing(solver: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(highs, "TemporaryFile", full)
    monkeypatch.setattr(cbc, "TemporaryDirectory", full)
    outcome = optimise(_cover(1, 10, 5), solver=solver)
    assert outcome.status == "undecided"
    assert outcome.reason == "the solver could not be run: No space left on device"


def test_a_program_larger_than_memory_is_not_handed_to_a_solver() -> None:
    limit = (resident() or 0) / 2**20 + 1
    outcome = optimise(_cover(1, 1000, 2000), deadline=Deadline(memory_limit=limit))
    assert (outcome.status, outcome.values) == ("undecided", None)
    assert outcome.reason.startswith("memory is used up")
