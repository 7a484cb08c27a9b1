"""Whatever happens to a file, loading works or gives one line that names a file."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity import Deadline, LimitReachedError, SerendipityError, Task, pddl
from tests.pddl.mutants import ORIGINALS, Files, mutant
from tests.pddl.test_durative_actions import DOMAIN, PROBLEM
from tests.pddl.test_timed_literals import DAY, SHOP
from tests.pddl.texts import OFFICE

SECONDS = 2.0

IN_TIME = (
    Files(DOMAIN, PROBLEM.replace("(:init", "(:init (at 14 (path hall bed))"), "ann", ("bob",)),
    Files(SHOP, DAY, "ann", ("bob",)),
)


def outcome(changed: Files, folder: Path) -> Task | SerendipityError:
    """What loading gives; any other exception is a failure."""
    try:
        return pddl.read_pddl(
            *changed.write(folder), changed.human, changed.robots, deadline=Deadline(SECONDS, 4_000)
        )
    except SerendipityError as error:
        return error


def check(number: int, originals: Sequence[Files] = ORIGINALS) -> None:
    changed = mutant(number, originals)
    with tempfile.TemporaryDirectory() as folder:
        result = outcome(changed, Path(folder))
    if isinstance(result, Task):
        assert result.agents[0] == changed.human
    else:
        text = str(result)
        assert text.isprintable()
        assert len(text.replace(folder, "")) < 300
        assert (
            folder in text or isinstance(result, LimitReachedError) or "expected at least one robot" in text
        )


@pytest.mark.long
@pytest.mark.parametrize("start", range(0, 600, 50))
def test_mutated_files_load_or_fail_in_one_line(start: int) -> None:
    for number in range(start, start + 50):
        check(number)


@pytest.mark.parametrize("start", range(0, 300, 50))
def test_mutated_files_with_time_load_or_fail_in_one_line(start: int) -> None:
    for number in range(start, start + 50):
        check(number, IN_TIME)


@pytest.mark.slow
@pytest.mark.parametrize("start", range(1_000, 21_000, 1_000))
def test_thousands_of_mutated_files(start: int) -> None:
    for number in range(start, start + 1_000):
        check(number)


@given(st.binary(max_size=200))
def test_noise_fails_in_one_line(noise: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "domain.pddl")
        file.write_bytes(b"(define (domain d) " + noise)
        with pytest.raises(SerendipityError) as caught:
            pddl.read_pddl(file, OFFICE[1], "ann", ["bot"])
    assert str(caught.value).isprintable()
