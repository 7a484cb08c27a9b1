"""On the authors' problems: what the search says of humans who replan holds when played again."""

from pathlib import Path

import pytest

import serendipity
from verify.certificate.simulator import realised_claim

EVERY = 8
"""Each eighth problem; all of them take half a minute."""


def _assert_sound(folder: Path) -> None:
    task = serendipity.load(folder, human="commx")
    answers = {
        model: serendipity.plan(task, discount=0.9, human_model=model)
        for model in ("omniscient", "observant", "local")
    }
    for model, result in answers.items():
        claim = realised_claim(task, result)
        assert claim.verdict == "proved", (model, claim.reason)
        assert result.realised.get(model, True)
    paper = answers["omniscient"]
    if paper.realised["observant"]:
        assert answers["observant"].cost <= paper.cost


def test_usar_answers_are_played_again(usar200: Path) -> None:
    for number in range(1, 201, EVERY):
        _assert_sound(usar200 / f"test{number}")


@pytest.mark.slow
def test_all_usar_answers_are_played_again(usar200: Path) -> None:
    for number in range(1, 201):
        _assert_sound(usar200 / f"test{number}")
