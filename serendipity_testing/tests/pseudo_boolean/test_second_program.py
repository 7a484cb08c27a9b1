"""A claim's program made from the semantics by other code is about the same plans as the verifier's."""

from copy import deepcopy
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given, settings

import serendipity
from benchmarks.certificates import Asked
from serendipity.model import Deadline, UsageError
from serendipity_testing.builders import task
from serendipity_testing.generator import random_call_in_time
from serendipity_testing.oracle import best, optimal_human_plan
from serendipity_testing.pseudo_boolean.comparison import difference
from serendipity_testing.pseudo_boolean.opb import PseudoBooleanProblem
from serendipity_testing.pseudo_boolean.question import NotMadeError, PlansAsked
from serendipity_testing.pseudo_boolean.second import program
from serendipity_testing.strategies import Call, calls
from serendipity_testing.tests.pseudo_boolean.every_program import compared
from tests.verify.proofs.samples import DETOUR, Sample, optimum, proved, sample
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.proofs.book import Entry, ProofWriter
from verify.solvers.mip import Model, optimise

_LONG = ("help", "two programs")
_SAMPLES = (
    "no plan",
    "suffixes",
    "given plan",
    *(pytest.param(name, marks=pytest.mark.slow) for name in _LONG),
)

_SHORTCUT = {
    "walk0 h": "at0 -> at1 !at0",
    "walk1 h": "at1 -> at2 !at1",
    "walk2 h": "at2 -> at3 !at2",
    "jump h": "at0 open -> at3 !at0",
    "lift h r": "at1 !tired -> at3 !at1",
    "open r": "-> open tired",
    "idle r": "!tired -> tired",
}


@cache
def _help(encoding: str = "automata") -> Sample:
    """The robot opens a shortcut in an epoch that the human leaves free."""
    corridor = task(init="at0", goal="at3", actions=_SHORTCUT)
    result = serendipity.plan(corridor, discount="0.5")
    writer = ProofWriter()
    assert certify(corridor, result, proof=writer, encoding=encoding).verdict == "proved"
    return Sample(writer.to_dict("optimal", encoding), corridor, result)


def least(problem: PseudoBooleanProblem, solver: str = "highs") -> int | None:
    """The least objective of a problem."""
    model, columns = Model(), dict[str, int]()
    for x in problem.variables:
        columns[x] = model.binary()
    model.objective = {columns[x]: a for x, a in (problem.objective or {}).items()}
    for terms, right in problem.constraints:
        model.add({columns[x]: a for x, a in terms.items()}, ">=", right)
    outcome = optimise(model, solver=solver, deadline=Deadline(60))
    assert outcome.status != "undecided", outcome
    values = outcome.values
    return None if values is None else sum(weight * values[x] for x, weight in model.objective.items())


def _said(found: Sample, entry: Entry) -> str | None:
    assert found.task is not None
    assert found.result is not None
    return difference(found.task, found.result, entry, least)


@pytest.mark.parametrize("name", _SAMPLES)
def test_samples_are_about_the_same_plans(name: str) -> None:
    for entry in sample(name).proof["programs"]:
        assert _said(sample(name), entry) is None


@pytest.mark.long
@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual"])
def test_random_calls_have_the_same_optima(mode: str) -> None:
    @settings(max_examples=10)
    @given(calls(modes=(mode,), ties=False))
    def law(call: Call) -> None:
        for encoding in ("automata", "paper"):
            writer = ProofWriter()
            try:
                result = solve(call.task, call.options, human_plan=call.human_plan_names)
                certify(call.task, result, proof=writer, encoding=encoding)
            except UsageError:
                return
            for entry in writer.programs:
                try:
                    assert difference(call.task, result, entry, least) is None, entry["name"]
                except NotMadeError:
                    continue

    law()


@pytest.mark.long
@settings(max_examples=10)
@given(calls(modes=("communication", "composite"), ties=False))
def test_joint_plans_cost_what_brute_force_says(call: Call) -> None:
    options = call.options
    try:
        expected = best(call.task, options, call.human_plan)
    except UsageError:
        return
    plan = call.human_plan if call.human_plan is not None else optimal_human_plan(call.task) or ()
    epochs = len(plan) if options.horizon is None else options.horizon
    if not isinstance(epochs, int) or not epochs or options.keep_prefix or options.max_cost is not None:
        return
    problem, unit = program(PlansAsked(call.task, options, plan, epochs, "all plans"))
    found = least(problem)
    assert (None if found is None else found * unit) == expected.objective


def _without(entry: Entry, family: str) -> Entry:
    """A program without some of its rows, with the optimum that it has then: what a faulty encoder writes."""
    doctored = deepcopy(entry)
    doctored["rows"] = [row for row in entry["rows"] if not row["family"].startswith(family)]
    assert len(doctored["rows"]) < len(entry["rows"])
    model = Model()
    for low, high in entry["columns"]:
        model.column(low, high)
    model.objective = dict(map(tuple, entry["objective"]))
    for row in doctored["rows"]:
        model.add(dict(map(tuple, row["terms"])), row["sense"], row["right"])
    doctored["limit"] = optimum(model) - 1
    return doctored


_FAULTS = {
    "automata": ("eq. 10: h", "eq. 10: r", "eq. 4"),
    "paper": ("eq. 1, 2", "eq. 3", "eq. 4", "eq. 5", "eq. 12"),
}


@pytest.mark.parametrize("encoding", _FAULTS)
def test_rows_that_are_missing_are_found(encoding: str) -> None:
    found = _help(encoding)
    (entry,) = found.proof["programs"]
    assert _said(found, entry) is None
    for family in _FAULTS[encoding]:
        assert "an optimum of" in (_said(found, _without(entry, family)) or ""), family


@pytest.mark.parametrize(
    "change",
    [
        {"limit": 2003},
        {"limit": 2001},
        {"unit": "1/1"},
        {"name": "all plans, 1 epochs"},
        {"name": "all plans, 3 epochs, robots idle"},
        {"name": "pi_H as planned, 3 epochs"},
        {"name": "every window, 3 epochs, cost at most 2"},
    ],
    ids=str,
)
def test_other_claims_are_found(change: Entry) -> None:
    (entry,) = _help().proof["programs"]
    assert _said(_help(), entry | change) is not None


def test_what_is_not_made_says_so() -> None:
    found = _help()
    assert found.task is not None
    with pytest.raises(NotMadeError, match="beside any of"):
        _said(found, found.proof["programs"][0] | {"name": "every window, 3 epochs, beside any of 3 plans"})
    assert found.result is not None
    literal = found.result.options.but(preservation="state")
    with pytest.raises(NotMadeError, match="preservation"):
        program(PlansAsked(found.task, literal, (), 3, "every window", most_cost=Fraction(2)))


def test_suffixes_are_told_apart_by_facts_with_bearing_only() -> None:
    """A fact that the human may make true in passing, and one that is never true, change no optimal plan."""
    aside = {"hum h": "-> z", "fly h": "never -> p", "call h": "-> more", "wish h": "more never -> p"}
    found = proved(task(goal="p", actions=DETOUR | aside), horizon=3, max_window=1)
    (entry,) = found.proof["programs"]
    assert entry["suffixes"]
    assert _said(found, entry) is None
    for each in entry["suffixes"]:
        each["state"] = [*each["state"], "z"]
    assert _said(found, entry) is None
    for each in entry["suffixes"]:
        each["state"] = [*each["state"], "never"]
    assert _said(found, entry) is None


@pytest.mark.parametrize("seed", [537, 553])
def test_calls_in_time_are_not_made(seed: int) -> None:
    call, writer = random_call_in_time(seed), ProofWriter()
    result = serendipity.plan(call.task, **call.keywords())
    certify(call.task, result, proof=writer)
    assert writer.programs
    for entry in writer.programs:
        with pytest.raises(NotMadeError, match="semantics 10"):
            difference(call.task, result, entry, least)


def test_every_program_of_a_call_is_compared(tmp_path: Path) -> None:
    pytest.importorskip("ortools", reason="no OR-Tools: `make bench-extra` installs it")
    serendipity.generate_usar(tmp_path / "building", rooms=6)
    asked = Asked("", (str(tmp_path / "building"), None), "serendipity", "0.5", None)
    said = [text for _, text in compared((asked, None, 60))["programs"]]
    assert said and set(said) == {"the same"}
