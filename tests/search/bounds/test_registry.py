"""The table of bounds names what is there, and all that is there."""

import re
from pathlib import Path
from pkgutil import resolve_name

from docs import hooks
from search import bounds
from search.bounds.registry import BOUNDS
from search.strategies.portfolio import STRATEGIES, TURNS

ROOM = Path(bounds.__file__).parent
WHAT_THEY_STAND_ON = {"__init__", "registry", "interactions", "achiever_automaton", "achiever_costs"}


def test_each_is_where_it_is_said_to_be() -> None:
    assert len({bound.name for bound in BOUNDS}) == len(BOUNDS)
    assert all(callable(resolve_name(bound.home)) for bound in BOUNDS)
    assert all(all(bound) for bound in BOUNDS)


def test_none_of_the_room_is_missing() -> None:
    named = {bound.home.partition(":")[0].rpartition(".")[2] for bound in BOUNDS}
    missing = {path.stem for path in ROOM.glob("*.py")} - named - WHAT_THEY_STAND_ON
    assert not missing, "modules of search/bounds without a row in its registry.py"


def test_strategies_that_ask_are_in_the_portfolio() -> None:
    turns = {*STRATEGIES, *(turn.name for turn in TURNS)}
    for bound in BOUNDS:
        asking = re.findall(r"\b[a-z]+-[a-z]+\b", bound.asked_by)
        assert {*asking} <= turns, f"{bound.name}: asked_by: words with a hyphen are strategies or turns"


def test_the_documentation_shows_them() -> None:
    page = Path(hooks.__file__).with_name("search.md").read_text(encoding="utf-8")
    shown = hooks.on_page_markdown(page)
    for name in (*STRATEGIES, *(turn.name for turn in TURNS), *(bound.name for bound in BOUNDS)):
        assert f"| {name} |" in shown or f"`{name}`" in shown, name
    assert "<!--" not in shown
