"""A certificate's verdict follows from its claims; wrong words are refused."""

import json

import pytest

from serendipity.model import Certificate, Claim, PlanStep, UsageError


@pytest.mark.parametrize(
    ("verdicts", "whole"),
    [
        ((), "undecided"),
        (("not_in_scope",), "undecided"),
        (("proved", "not_in_scope"), "proved"),
        (("proved", "undecided"), "undecided"),
        (("undecided", "refuted", "proved"), "refuted"),
    ],
)
def test_the_whole_is_as_good_as_its_worst_claim(verdicts: tuple[str, ...], whole: str) -> None:
    claims = tuple(Claim("cost", verdict, "because") for verdict in verdicts)
    certificate = Certificate(claims, 0.1)
    assert certificate.verdict == whole
    assert (certificate.refuted is not None) == (whole == "refuted")


@pytest.mark.parametrize(("claim", "verdict"), [("beauty", "proved"), ("cost", "maybe")])
def test_unknown_words_are_refused(claim: str, verdict: str) -> None:
    with pytest.raises(UsageError, match="expected one of"):
        Claim(claim, verdict, "because")


def test_json_has_the_documented_fields() -> None:
    step = PlanStep(1, ("h", "r"), "lift h r", 2.0)
    claim = Claim("optimal", "refuted", "cheaper", (step,), 0.2, 1.5, "program", {"columns": 3, "rows": 2}, 1)
    written = Certificate((claim,), 0.3, "S 1", "E", solver_calls=1).to_dict()
    assert json.loads(json.dumps(written)) == {
        "schema": "serendipity.certificate/1",
        "verdict": "refuted",
        "claims": [
            {
                "claim": "optimal",
                "verdict": "refuted",
                "reason": "cheaper",
                "counterexample": [{"epoch": 1, "agents": ["h", "r"], "action": "lift h r", "cost": 2.0}],
                "seconds": 0.2,
                "bound": 1.5,
                "method": "program",
                "size": {"columns": 3, "rows": 2},
                "solver_calls": 1,
            }
        ],
        "solver": "S 1",
        "encoding": "E",
        "size": {},
        "solver_calls": 1,
        "elapsed_seconds": 0.3,
    }
