"""A certificate is a proof only if every claim that the kind of answer needs was examined."""

from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.model import Certificate, Claim
from serendipity_testing.crosscheck.doctored import without_plan
from tests.verify.edits.corpus import corpus
from verify.base.obligations import BEST, NEEDED, complete, kind_of, needed

_PAGE = Path(__file__).parents[2] / "docs" / "verification.md"


def _verdict(claims: tuple[Claim, ...]) -> str:
    return Certificate(claims, 0.0).verdict


@pytest.mark.long
def test_every_row_of_the_table_has_an_example() -> None:
    met = {(kind_of(good.result), good.result.status) for good in corpus()}
    rows = {(kind, status) for kind, row in NEEDED.items() for status in row}
    unmet = rows - met
    assert {kind for kind, _ in met} == set(NEEDED)
    assert {status for _, status in unmet} <= {"feasible", "infeasible", "unknown"}


def test_a_claim_left_out_or_out_of_scope_leaves_it_undecided() -> None:
    """Good answers are proved, unless they claim nothing."""
    assert _verdict(()) == "undecided"
    for good in corpus():
        claims = serendipity.verify(good.task, good.result).claims
        claims_nothing = good.result.status == "unknown" and good.result.lower_bound is None
        assert _verdict(claims) == ("undecided" if claims_nothing else "proved"), (good.name, claims)
        if claims_nothing:
            continue
        assert _verdict(complete(good.result, ())) == "undecided"
        for name in needed(good.result):
            rest = tuple(claim for claim in claims if claim.claim != name)
            passed = tuple(replace(c, verdict="not_in_scope") if c.claim == name else c for c in claims)
            for without in (rest, passed):
                assert _verdict(complete(good.result, without)) == "undecided", (good.name, name)


def test_the_page_shows_the_table() -> None:
    lines = ["| answer | " + " | ".join(NEEDED["a plan"]) + " |", "|---|---|---|---|---|"]
    for kind, row in NEEDED.items():
        cells = (", ".join(row.get(status, ("-",))) for status in NEEDED["a plan"])
        lines.append(f"| {kind} | " + " | ".join(cells) + " |")
    assert "\n".join(lines) in _PAGE.read_text()
    assert BEST in _PAGE.read_text()


@pytest.mark.parametrize(
    ("mode", "bound", "verdict"),
    [
        ("serendipity", 0.0, "proved"),
        ("serendipity", 12.0, "proved"),
        ("serendipity", 2000.0, "refuted"),
        ("composite", 0.0, "proved"),
        ("composite", 2000.0, "refuted"),
        ("individual", 13.0, "proved"),
        ("individual", 13.5, "refuted"),
    ],
)
def test_a_bound_without_an_answer_is_a_claim(mode: str, bound: float, verdict: str) -> None:
    """It was left undecided, for breaking a rule that it does not break."""
    task = serendipity.example("room2")
    answer = serendipity.plan(task, mode=mode)
    unknown = without_plan(answer, "unknown", "time-limit", bound)
    assert serendipity.verify(task, unknown).verdict == verdict
