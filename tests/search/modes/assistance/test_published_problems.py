"""The published problems of silent assistance: proved under all ties, values in their order."""

from pathlib import Path

import pytest

import serendipity
from benchmarks.problems import silent, silent_task
from search import PreparedTask
from search.modes.assistance.bounds.bound import ValueBound
from search.modes.assistance.game.game import Game
from search.packed.cost_vector import INFINITE_KEY
from serendipity import Task
from serendipity.model import Deadline
from serendipity_testing.oracle.assistance import Costs

PROBLEMS = [
    *(("car_assistance1", n) for n in (2, 12, 17)),
    *(("teleport_assistance1", n) for n in (4, 19, 35, 37)),
    *(("visitall_assistance", n) for n in (0, 2, 5, 8)),
]


def load(folder: Path, problem: int) -> Task:
    files = {name: pair for name, *pair in silent(folder.parent)}
    return silent_task(*files[f"{folder.name}/{problem}"])


def joint_optimum(task: Task) -> Costs | None:
    """What both together pay without turns, or a relaxation of it: a bound on every policy."""
    game = Game(PreparedTask(task), Deadline())
    value = ValueBound(game)(game.init)
    return None if value >= INFINITE_KEY else game.pair(value)


def proved(task: Task, ties: str) -> Costs:
    result = serendipity.plan(task, mode="assistance", ties=ties)
    assert result.status == "optimal"
    return result.bounds.lower


@pytest.mark.long
@pytest.mark.parametrize(("domain", "problem"), PROBLEMS)
def test_values_stand_in_order(spa: Path, domain: str, problem: int) -> None:
    task = load(spa / domain, problem)
    values = {ties: proved(task, ties) for ties in ("optimistic", "fixed", "expected", "robust")}
    assert joint_optimum(task) <= values["optimistic"] <= values["fixed"]
    assert values["optimistic"] <= values["expected"] <= values["robust"]


@pytest.mark.parametrize(("domain", "problem"), [("teleport_assistance1", 37), ("car_assistance1", 12)])
@pytest.mark.parametrize("ties", ["optimistic", "fixed", "expected", "robust"])
def test_certificate_proves_the_answer(spa: Path, domain: str, problem: int, ties: str) -> None:
    task = load(spa / domain, problem)
    certificate = serendipity.verify(task, serendipity.plan(task, mode="assistance", ties=ties))
    assert [claim.verdict for claim in certificate.claims] == ["proved"] * 4
