"""Which tasks a suite has, and who is who in them."""

from pathlib import Path

import pytest

from serendipity import InputError, UsageError, generate_usar
from serendipity.evaluation.benchmark.coverage import can_alone
from serendipity.evaluation.measuring.suites import (
    Roles,
    SuiteProblem,
    folders,
    is_suite,
    may_alone,
    problems,
    roles,
)
from tests.pddl.texts import domain, pair, problem

GO = "(:action go :agent ?who - agent :parameters (?x - thing) :precondition (a ?x) :effect (b ?x))"


def written(folder: Path, objects: str) -> SuiteProblem:
    files = pair(folder, domain(GO), problem("(a o1)", "(b o1)", objects))
    return SuiteProblem("small", "little", *files)


def test_problems_stand_beside_their_domain(suite: Path) -> None:
    assert is_suite(suite)
    found = [(each.domain, each.name) for each in problems(suite)]
    assert found == [("flights", "flights"), ("parcels", "flour"), ("parcels", "parcels")]
    assert all(each.domain_file.is_file() and each.problem_file.is_file() for each in problems(suite))


def test_a_stride_starts_anew_in_each_domain(suite: Path) -> None:
    assert [each.name for each in problems(suite, stride=2)] == ["flights", "flour"]


def test_domains_can_be_chosen(suite: Path) -> None:
    assert [each.name for each in problems(suite, ["flights"])] == ["flights"]
    with pytest.raises(UsageError, match="expected some of flights, parcels, got 'rovers'"):
        problems(suite, ["rovers"])


def test_a_folder_of_buildings_is_no_suite(tmp_path: Path) -> None:
    generate_usar(tmp_path / "one", rooms=4, medkits=1)
    assert not is_suite(tmp_path)


def test_the_human_is_the_first_who_can(tmp_path: Path) -> None:
    four = written(tmp_path, "d c b a - agent o1 - thing")
    assert roles(four, 2, lambda _, who: who.human in ("b", "a")) == Roles("b", ("d", "c"), alone=True)
    assert roles(four, 2, lambda *_: False) == Roles("d", ("c", "b"))
    assert roles(four, 5, lambda *_: True) == Roles("d", ("c", "b", "a"), alone=True)


def test_one_agent_is_not_enough(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="two objects or more"):
        roles(written(tmp_path, "a - agent o1 - thing"), 2, lambda *_: True)


def test_who_can_alone_is_found_out(suite: Path) -> None:
    parcels = problems(suite, ["parcels"])[-1]
    assert can_alone(parcels, Roles("dora", ("rolo",)), 5)
    assert not can_alone(parcels, Roles("rolo", ("dora",)), 5), "the market is closed to carts"
    assert may_alone(parcels, Roles("dora", ("rolo",)))
    assert not may_alone(parcels, Roles("rolo", ("dora",)))


def test_folders_stand_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    for number in (10, 9, 1, 2):
        (tmp_path / f"test{number}").mkdir()
    (tmp_path / "notes").touch()
    assert [path.name for path in folders(tmp_path)] == ["test1", "test2", "test9", "test10"]
    assert [path.name for path in folders(tmp_path, stride=3)] == ["test1", "test10"]
