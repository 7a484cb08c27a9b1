"""Files that the first versions wrote are read for ever; those of versions to come are refused in one line.

What is in ``written`` was written by commits of 2026-11-22: results and the journal by ``8dc79d0``, the
proof by ``1cca723``, the log by ``8c8aaf9``.
"""

import gzip
import json
import shutil
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity import InputError, Result
from serendipity.evaluation.reproduction.run import Journal
from serendipity.execution.log import read_logs, replay
from tests.cli.conftest import Runs, assert_one_line

WRITTEN = Path(__file__).parent / "written"
RESULTS = {
    "serendipity": ("room2", "optimal", 12.6),
    "communication": ("room2", "optimal", 11.4),
    "no-help": ("room7", "optimal", 13.0),
    "ties": ("room2", "optimal", 12.6),
    "goals": ("room2", "optimal", 11.5),
}
"""By file: the example that it is about, its status and its cost."""


@pytest.mark.long
@pytest.mark.parametrize("name", RESULTS)
def test_a_result_is_read_and_proved(name: str) -> None:
    example, status, cost = RESULTS[name]
    data = json.loads((WRITTEN / f"{name}.json").read_text())
    result = Result.from_dict(data)
    assert (result.status, result.cost, result.malformed) == (status, cost, {})
    again = result.to_dict()
    assert {key: again[key] for key in data if key not in ("options", "statistics")} == {
        key: value for key, value in data.items() if key not in ("options", "statistics")
    }
    assert again["options"].items() >= data["options"].items()
    assert serendipity.verify(serendipity.example(example), result).verdict == "proved"


def test_a_proof_holds() -> None:
    found = serendipity.check_proof(WRITTEN / "proof.json.gz")
    assert found.accepted and found.claim == "no_opportunity"


def test_a_log_replays() -> None:
    (lines,) = read_logs(WRITTEN / "run.jsonl")
    played = replay(serendipity.example("room2"), lines)
    assert played.done and played.human_cost == 11 and float(played.cost) == 12.6


def test_a_journal_goes_on(tmp_path: Path) -> None:
    path = Path(shutil.copy(WRITTEN / "journal.jsonl", tmp_path))
    journal = Journal(path)
    (record,) = journal.read()
    assert [(row.mode, float(row.cost or 0)) for row in record.rows] == [
        ("individual", 6),
        ("serendipity", 6),
    ]
    journal.append(record)
    assert [*journal.read()] == [record, record]


def newer(name: str, folder: Path) -> Path:
    """A file, but of the next version of its format, which has a field more."""
    content = (WRITTEN / name).read_bytes()
    text = (gzip.decompress(content) if name.endswith(".gz") else content).decode()
    kind = {"run": "execution", "proof": "proof", "journal": "journal"}.get(name.split(".")[0], "result")
    objects = map(json.loads, text.splitlines() if name.endswith(".jsonl") else [text])
    lines = [_with(each, {"schema": f"serendipity.{kind}/2", "more": 1}) for each in objects]
    path = folder / name.removesuffix(".gz")
    path.write_text("\n".join(lines) + "\n")
    return path


def _with(value: dict[str, Any], more: dict[str, Any]) -> str:
    return json.dumps(value | more if value.keys() & {"schema", "fingerprint"} else value)


@pytest.mark.parametrize(
    ("name", "command", "says"),
    [
        ("serendipity.json", "verify --example room2 {}", "'serendipity.result/2' is newer than"),
        ("serendipity.json", "show --example room2 {} -o x.svg", "'serendipity.result/2' is newer than"),
        ("proof.json.gz", "check-proof {}", "expected 'serendipity.proof/1', got 'serendipity.proof/2'"),
        ("run.jsonl", "execute --example room2 --replay {}", "'serendipity.execution/2' is newer than"),
        ("journal.jsonl", "reproduce suite --journal {}", "'serendipity.journal/2' is newer than"),
    ],
)
def test_a_newer_file_is_refused_in_one_line(
    name: str, command: str, says: str, run: Runs, tmp_path: Path
) -> None:
    if "suite" in command:
        serendipity.generate_usar(tmp_path / "suite" / "test1", preset="room2")
    path = newer(name, tmp_path)
    assert_one_line(run(command.format(path)), path.name, says)


def test_a_newer_part_of_a_result_is_said_to_be_newer() -> None:
    data = json.loads((WRITTEN / "goals.json").read_text())
    data["statistics"]["recognition"]["schema"] = "serendipity.recognition/3"
    assert "'serendipity.recognition/3' is newer than" in Result.from_dict(data).malformed["recognition"]


@pytest.mark.parametrize("schema", ["serendipity.result/0x", "serendipity.result/", 2, None, "result/1", []])
def test_what_is_no_version_is_told_as_it_is(schema: object) -> None:
    data = json.loads((WRITTEN / "serendipity.json").read_text()) | {"schema": schema}
    with pytest.raises(InputError, match=r"schema: expected 'serendipity\.result/1', got "):
        Result.from_dict(data)


def test_a_field_that_is_not_known_is_left_out() -> None:
    data = json.loads((WRITTEN / "serendipity.json").read_text())
    assert Result.from_dict(data | {"more": 1}) == Result.from_dict(data)


def test_an_option_that_is_not_known_is_refused() -> None:
    data = json.loads((WRITTEN / "serendipity.json").read_text())
    data["options"]["hurry"] = True
    with pytest.raises(InputError, match="options: unknown option 'hurry'"):
        Result.from_dict(data)
