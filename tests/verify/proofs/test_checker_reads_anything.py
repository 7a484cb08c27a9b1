"""Whatever is in a file, the checker has one line to say and an exit code; it never crashes."""

import gzip
import json
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cli.conftest import Runs, assert_one_line
from tests.verify.proofs.samples import sample
from verify.proofs.checker import MalformedProofError, RejectedProofError, check, read

_SMALL = ("branched", "given plan", "no plan", "suffixes")

_VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-3, 3) | st.floats() | st.text(max_size=3) | st.just("1/1"),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)


def _survives(data: Any) -> None:
    try:
        check(data)
    except (MalformedProofError, RejectedProofError) as error:
        assert "\n" not in str(error)


def _places(data: Any) -> list[tuple[Any, Any]]:
    """Every container with a key in it."""
    found: list[tuple[Any, Any]] = []
    waiting = [data]
    while waiting:
        here = waiting.pop()
        keys = here.keys() if isinstance(here, dict) else range(len(here)) if isinstance(here, list) else ()
        for key in keys:
            found.append((here, key))
            waiting.append(here[key])
    return found


@given(st.sampled_from(_SMALL), st.integers(0, 10**9), _VALUES)
def test_any_value_anywhere(name: str, seed: int, value: Any) -> None:
    data = json.loads(json.dumps(sample(name).proof))
    dice = Random(seed)
    where, key = dice.choice(_places(data))
    where[key] = value
    _survives(data)


@given(st.sampled_from(_SMALL), st.integers(0, 10**9))
def test_any_field_removed(name: str, seed: int) -> None:
    data = json.loads(json.dumps(sample(name).proof))
    where, key = Random(seed).choice(_places(data))
    del where[key]
    _survives(data)


@given(_VALUES)
def test_any_json(value: Any) -> None:
    _survives(value)


@pytest.mark.parametrize("pack", [bytes, gzip.compress], ids=["json", "gzip"])
def test_a_byte_order_mark(pack: Callable[[bytes], bytes], tmp_path: Path) -> None:
    file, proof = tmp_path / "proof.json", sample("branched").proof
    file.write_bytes(pack(b"\xef\xbb\xbf" + json.dumps(proof).encode()))
    assert check(read(file))


@pytest.mark.long
@pytest.mark.parametrize("packed", [False, True], ids=["json", "gzip"])
def test_any_bytes(packed: bool, run: Runs) -> None:
    content = json.dumps(sample("branched").proof).encode()
    if packed:
        content = gzip.compress(content, mtime=0)
    dice, file, codes = Random(7), Path("proof.json"), set()
    for _ in range(150):
        broken = bytearray(content)
        for _ in range(dice.randint(1, 3)):
            broken[dice.randrange(len(broken))] = dice.randrange(256)
        file.write_bytes(broken[: dice.choice((len(broken), dice.randrange(len(broken))))])
        done = run(f"check-proof {file}")
        codes.add(done.code)
        assert done.code in (0, 1, 2)
        assert "Traceback" not in done.out + done.err
        assert done.err.count("\n") == (done.code == 2)
    assert 2 in codes


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "expected JSON"),
        (b"\x1f\x8b", "expected a whole gzip file"),
        (b"\xff\xfe", "expected JSON in UTF-8"),
        (b"[" * 100_000, "expected JSON: it is nested too deeply, or has a number of thousands of digits\n"),
        (b'{"a":' * 100_000, "expected JSON: it is nested too deeply"),
        (b"9" * 10_000, "or has a number of thousands of digits\n"),
        (b'"' + b" " * 100_000 + b"\xc3", "in position 100001: unexpected end of data\n"),
        (b"NaN", "expected an object with 'schema'"),
        (b'{"schema": 1, "schema": 2}', "each field of an object once"),
        (b'{"schema": null}', "schema: expected a text"),
        (b"null", "expected an object with 'schema'"),
    ],
)
def test_files_that_are_no_proofs(content: bytes, said: str, run: Runs) -> None:
    Path("proof.json").write_bytes(content)
    assert_one_line(run("check-proof proof.json"), "Error: proof.json: ", said)


def test_files_that_are_not_there(tmp_path: Path) -> None:
    for path in (tmp_path / "none.json", tmp_path):
        with pytest.raises(MalformedProofError, match="can't be read"):
            read(path)


@pytest.mark.parametrize(
    "text", ["1/1" * 9, "1/" + "9" * 61, "9" * 61 + "/1", "1", "/1", " 1/1", "1/1\n", "١/1"]
)
def test_multipliers_are_plain_numbers(text: str) -> None:
    data = json.loads(json.dumps(sample("branched").proof))
    node = data["programs"][0]["tree"]
    while "down" in node:
        node = node["down"]
    node["multipliers"][0][1] = text
    with pytest.raises(MalformedProofError, match="expected numerator/denominator"):
        check(data)
