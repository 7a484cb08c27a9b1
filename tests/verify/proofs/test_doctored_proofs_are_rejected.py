"""A proof that was changed proves nothing: its arithmetic fails, or its programs are not the claim's."""

import json
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.model import InputError, ProofCheck
from serendipity_testing.builders import task as build
from tests.verify.proofs.doctored import DOCTORED
from tests.verify.proofs.samples import SAMPLES, Sample, sample
from verify.base.optimal_plans import OptimalPlans
from verify.calls.call import ExaminedCall
from verify.programs import recorded
from verify.programs.effort import Effort, Minimum
from verify.programs.mending import suffix_least
from verify.proofs.book import ProofWriter


def _checked(folder: Path, sample: Sample, *, alone: bool) -> ProofCheck | None:
    """What is found; None where the file is no proof."""
    file = folder / "proof.json"
    file.write_text(json.dumps(sample.proof))
    try:
        if alone:
            return serendipity.check_proof(file)
        return serendipity.check_proof(file, sample.task, sample.result)
    except InputError as error:
        assert str(error).count("\n") == 0
        return None


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_are_accepted(name: str, tmp_path: Path) -> None:
    alone = sample(name).task is None
    found = _checked(tmp_path, sample(name), alone=alone)
    assert found is not None and found.accepted, found
    assert found.compared != alone


def test_samples_have_what_is_doctored() -> None:
    assert "branch" in sample("branched").proof["programs"][0]["tree"]
    assert sample("suffixes").proof["programs"][0]["suffixes"]
    assert sample("no plan").proof["programs"][0]["limit"] is None
    assert len(sample("two programs").proof["programs"]) == 2
    assert sample("help").proof["programs"][0]["solution"]


@pytest.mark.parametrize("name", DOCTORED)
def test_doctored_proofs_are_rejected(name: str, tmp_path: Path) -> None:
    doctored = DOCTORED[name]
    original = sample(doctored.sample)
    changed = original._replace(proof=deepcopy(original.proof))
    doctored.change(changed.proof)
    assert changed.proof != original.proof
    alone = _checked(tmp_path, changed, alone=True)
    assert (alone is None or not alone.accepted) or not doctored.alone
    if not doctored.alone:
        found = _checked(tmp_path, changed, alone=False)
        assert found is None or not found.accepted


def test_a_result_that_breaks_a_rule_is_not_proved(tmp_path: Path) -> None:
    original = sample("help")
    assert original.result is not None
    doctored = original._replace(result=replace(original.result, cost=1.0))
    found = _checked(tmp_path, doctored, alone=False)
    assert found is not None
    assert (found.verdict, found.reason.startswith("cost")) == ("rejected", True)


def test_no_suffix_from_a_state_that_never_holds_is_believed(tmp_path: Path) -> None:
    """Facts that can't change are in no row: without `k`, there would be no plan from any of these states."""
    actions = {"do h": "k -> p @ 5", "quick h": "q k -> p @ 3", "help r": "-> q @ 1"}
    task = build(init="k", goal="p", actions=actions)
    helpless = build(init="k", goal="p", actions=actions | {"help r": "z -> q @ 1"})
    false = serendipity.plan(helpless, horizon=3, max_window=1, window_weight=0)
    plans, effort = OptimalPlans(task), Effort(method="program")
    plan = task.plan_from_names(false.human_plan)
    question = ExaminedCall(task, false.options, plan, plans, effort).question
    encoding, cuts, writer = effort.encode(question), [], ProofWriter()
    for names in (["q"], [], ["p"]):
        state = frozenset(map(task.facts.index, names))
        encoding.bound_suffix(2, state, suffix_least(question, state, 2, plans))
        cuts.append((2, state))
    recorded.write(writer, question.but(most=4), encoding.model, Minimum("none"), cuts=cuts)
    forged = Sample(writer.to_dict("no_opportunity", "automata"), task, false)
    assert serendipity.plan(task, horizon=3, max_window=1, window_weight=0).cost == 4
    assert _checked(tmp_path, forged, alone=True).accepted  # by itself it is in order
    assert not _checked(tmp_path, forged, alone=False).accepted
