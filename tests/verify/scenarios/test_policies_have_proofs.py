"""That no policy is better is written down as a program, which anybody can check."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

import serendipity
from tests.verify.scenarios.edit import Edit, edit, together
from tests.verify.scenarios.studio import helped, studio
from tests.verify.scenarios.three_ways import Asked, agreed, calls_over_scenarios, is_small


def _proof(folder: Path, **options: Any) -> tuple[Path, dict[str, Any]]:
    file = folder / "proof.json"
    assert serendipity.verify(studio(), helped(**options), proof=file).verdict == "proved"
    return file, json.loads(file.read_bytes())


@pytest.mark.parametrize("policy", ["watching", "fixed"])
@pytest.mark.parametrize("risk", ["mean", "worst", "regret"])
def test_policies_have_proofs(risk: str, policy: str, tmp_path: Path) -> None:
    file, proof = _proof(tmp_path, risk=risk, policy=policy)
    assert serendipity.check_proof(file).accepted
    assert serendipity.check_proof(file, studio(), helped(risk=risk, policy=policy)).accepted
    assert proof["programs"][-1]["name"] == "all policies over 2 scenarios, 3 epochs"


def test_posteriors_of_many_digits_have_proofs(tmp_path: Path) -> None:
    """Their parts are no numbers that a solver can tell apart: they count to nine digits."""
    goals = [{"name": name, "goal": [name], "prior": prior} for name, prior in (("p", "0.3"), ("z", "0.7"))]
    asked = {"goals": goals, "observed": ["begin_p h"], "beta": 0.37, "horizon": 3}
    for noise in (None, "miss=0.1,wrong=0.2"):
        answer = serendipity.plan(studio(), noise=noise, **asked)
        file = tmp_path / "proof.json"
        assert serendipity.verify(studio(), answer, proof=file).verdict == "proved"
        assert serendipity.check_proof(file, studio(), answer).accepted
        name = json.loads(file.read_bytes())["programs"][-1]["name"]
        assert name == "all policies over 2 scenarios, 3 epochs, probabilities in parts of 1000000000"


def _without(family: str) -> Edit:
    kept = edit("rows", lambda rows: [row for row in rows if row["family"] != family])
    return together(kept, edit("tree", {"multipliers": []}))


_DOCTORED: dict[str, tuple[str, Edit]] = {
    "another limit": ("mean", edit("limit", lambda limit: limit - 1)),
    "robots that know": ("mean", _without("semantics 11: robots")),
    "seeing what is not there": ("mean", _without("semantics 11: what is seen")),
    "not all count": ("worst", _without("semantics 11: the greatest counts")),
    "other probabilities": ("mean", edit("objective.0.1", 10**6)),
}


@pytest.mark.parametrize("way", _DOCTORED)
def test_doctored_proofs_are_rejected(way: str, tmp_path: Path) -> None:
    risk, change = _DOCTORED[way]
    file, proof = _proof(tmp_path, risk=risk)
    change(proof["programs"][-1])
    file.write_text(json.dumps(proof))
    assert not serendipity.check_proof(file, studio(), helped(risk=risk)).accepted


def test_a_policy_that_is_not_the_best_has_no_proof(tmp_path: Path) -> None:
    """The answer for who commits themselves, said to be that of who watches."""
    fixed = helped(policy="fixed")
    claimed = replace(fixed, options=fixed.options.but(policy="watching"))
    file = tmp_path / "proof.json"
    assert serendipity.verify(studio(), claimed, proof=file).verdict == "undecided"
    assert not file.exists()
    assert serendipity.verify(studio(), claimed).verdict == "refuted"


@pytest.mark.long
@given(calls_over_scenarios())
@settings(max_examples=15)
def test_search_brute_force_and_certificates_agree(asked: Asked) -> None:
    if is_small(asked):
        agreed(asked)
