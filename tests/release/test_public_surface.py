"""What is public is written down: a change to it shows in the commit that makes it."""

from difflib import unified_diff
from importlib.util import find_spec

import pytest

from tests.release.surface import WRITTEN, surface

RENEW = "The public surface is another one (docs/reference/stability.md): `python -m tests.release.surface`"


@pytest.mark.skipif(find_spec("unified_planning") is None, reason="the extra `up` is not installed")
def test_the_public_surface_is_the_one_that_is_written_down() -> None:
    before, after = WRITTEN.read_text(encoding="utf-8").splitlines(), surface().splitlines()
    differing = unified_diff(before, after, "written", "now", lineterm="", n=0)
    assert before == after, "\n".join([RENEW, *differing])
