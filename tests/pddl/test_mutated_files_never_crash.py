"""Whatever happens to a file, loading works or gives one line that names a file."""

import tempfile
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from serendipity import SerendipityError, Task, load_pddl
from tests.pddl.texts import OFFICE

TEXTS = tuple(path.read_text() for path in OFFICE)
NOISE = (
    "(",
    ")",
    "?",
    "-",
    ";",
    "\n",
    "=",
    "not",
    "and",
    "or",
    "(and",
    "forall",
    ":goal",
    "1e9",
    "0.",
    "é",
    "\x00",
)


@st.composite
def mutated(draw: st.DrawFn, text: str) -> str:
    for _ in range(draw(st.integers(0, 4))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.sampled_from([0, 1, 2, 5, 20, 200])))
        chunk = text[start:end]
        place = draw(st.integers(0, len(text)))
        match draw(st.sampled_from(["delete", "duplicate", "move", "insert", "swap case"])):
            case "delete":
                text = text[:start] + text[end:]
            case "duplicate":
                text = text[:place] + chunk + text[place:]
            case "move":
                rest = text[:start] + text[end:]
                text = rest[:place] + chunk + rest[place:]
            case "insert":
                text = text[:place] + draw(st.sampled_from(NOISE)) + text[place:]
            case "swap case":
                text = text[:start] + chunk.swapcase() + text[end:]
    return text


def outcome(files: tuple[Path, Path]) -> Task | SerendipityError:
    """What loading gives; any other exception is a failure."""
    try:
        return load_pddl(*files, human="ann", robots=["bot"])
    except SerendipityError as error:
        return error


@given(mutated(TEXTS[0]), mutated(TEXTS[1]))
def test_mutated_files_load_or_fail_in_one_line(domain: str, problem: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        files = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        for file, text in zip(files, (domain, problem), strict=True):
            file.write_text(text)
        result = outcome(files)
    if isinstance(result, Task):
        assert result.agents == ("ann", "bot")
    else:
        assert "\n" not in str(result)
        assert folder in str(result)


@given(st.binary(max_size=200))
def test_noise_fails_in_one_line(noise: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "domain.pddl")
        file.write_bytes(b"(define (domain d) " + noise)
        result = outcome((file, OFFICE[1]))
    assert isinstance(result, SerendipityError)
    assert "\n" not in str(result)
