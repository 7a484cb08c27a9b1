"""A proof that was changed proves nothing: its arithmetic fails, or its programs are not the claim's."""

import json
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.model import InputError, ProofCheck
from tests.verify.proofs.doctored import DOCTORED
from tests.verify.proofs.samples import SAMPLES, Sample, sample


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
