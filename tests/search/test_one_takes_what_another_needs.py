"""An epoch in which one agent takes what another asks for: bounds about sequences cut nothing off."""

import pytest

import serendipity
from serendipity.testing.builders import task

BOX = task(
    agents="hum rob",
    human="hum",
    init="free",
    goal="lid box",
    actions={
        "close hum": "free -> lid !free",
        "cover hum": "-> lid @ 2",
        "pack rob": "free -> box",
        "open rob": "lid -> !lid free @ 5",
    },
)


@pytest.mark.parametrize(("interference", "least"), [("paper", 1.5), ("strict", 2.5)])
@pytest.mark.parametrize("limit", [None, 60])
def test_what_one_takes_from_another_is_there_in_the_same_epoch(
    interference: str, least: float, limit: float | None
) -> None:
    options = {"discount": "0.5", "interference": interference, "time_limit": limit}
    assert serendipity.plan(BOX, mode="composite", horizon=1, **options).cost == least
