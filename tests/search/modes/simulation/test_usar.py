"""On the authors' problems: what the search says of humans who replan holds when played again."""

from pathlib import Path

import pytest

import serendipity
from verify.certificate.simulator import realised_claim


@pytest.mark.parametrize(
    "numbers", [range(1, 201, 8), pytest.param(range(1, 201), marks=pytest.mark.slow)], ids=["some", "all"]
)
def test_usar_answers_are_played_again(numbers: range, usar200: Path) -> None:
    for number in numbers:
        task = serendipity.load(usar200 / f"test{number}", human="commx")
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
