from collections.abc import Iterator

import pytest

from tests.live.server import Server, serving


@pytest.fixture(scope="package")
def server() -> Iterator[Server]:
    """One service for all tests that leave it as they found it."""
    with serving("--workers", "2", "--queue", "8", "--body-limit", "0.5", "--time-limit", "20") as started:
        yield started
