"""Every role that a planted bug speaks of is played by something in the code of today."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.verify.planted import PLANTED, Bug, roles
from tests.verify.planted.roles import PARTS, PLACES, name_of, place

BODIES = "\n".join(
    file.read_text() for file in Path(roles.__file__).parent.glob("*.py") if file.name != "roles.py"
)


@pytest.mark.parametrize("role", PLACES)
def test_places_are_there(role: str) -> None:
    assert place(role)


@pytest.mark.parametrize("role", PARTS)
def test_parts_are_there(role: str) -> None:
    assert name_of(role)


def test_each_place_has_its_bugs() -> None:
    idle = set(PLACES) - {bug.role for bug in PLANTED}
    assert not idle, f"plant a bug there (tests/verify/planted), or take the line out of roles.PLACES: {idle}"


def test_each_part_is_spoken_of() -> None:
    idle = {role for role in PARTS if f'"{role}"' not in BODIES}
    assert not idle, f"no bug speaks of it: take the line out of roles.PARTS: {idle}"


@pytest.mark.parametrize("bug", PLANTED, ids=lambda bug: bug.name)
def test_bugs_can_be_planted_and_removed(bug: Bug) -> None:
    found = place(bug.role)
    before = vars(found.owner)[found.name]
    with pytest.MonkeyPatch.context() as patch:
        bug.plant(patch)
        assert vars(found.owner)[found.name] is not before
    assert vars(found.owner)[found.name] is before


@pytest.mark.parametrize(
    "path",
    ["search.nowhere:Space.key", "search.strategies.call:Nobody.key", "search.strategies.call:Call.nothing"],
)
@pytest.mark.parametrize(("table", "ask"), [(PLACES, place), (PARTS, name_of)])
def test_a_lost_role_is_named(
    monkeypatch: pytest.MonkeyPatch, path: str, table: dict[str, str], ask: Callable[[str], object]
) -> None:
    role = next(iter(table))
    monkeypatch.setitem(table, role, path)
    with pytest.raises(LookupError, match=re.escape(repr(role))):
        ask(role)
