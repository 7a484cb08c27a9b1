"""A result that breaks a rule is not believed where it is used: a warning, or exit 1 with --strict."""

import json
from pathlib import Path
from typing import Any

import pytest

from serendipity.pictures.scene.building import MOST_EPOCHS
from tests.cli.conftest import Runs, assert_one_line

USES = ("show --example room2 help.json -o out.svg", "simulate --example room2 help.json -o out.txt")


DOCTORED = [
    ({"cost": 11.0, "saving": 2.0, "objective": 1011.0, "lower_bound": 1011.0}, "cost"),
    ({"window": {"start": 99998, "end": 99999}}, "window"),
]


@pytest.mark.parametrize("command", USES)
@pytest.mark.parametrize(("changes", "claim"), DOCTORED)
def test_a_doctored_result_is_used_with_a_warning(
    command: str, changes: dict[str, Any], claim: str, answer: dict[str, Any], run: Runs
) -> None:
    Path("help.json").write_text(json.dumps(answer | changes))
    done = run(command)
    assert done.code == 0
    assert done.err.startswith("Warning: help.json does not hold: ")
    assert claim in done.err
    assert done.err.count("\n") == 1
    assert run(f"{command} --quiet").err == ""
    assert Path(command.split()[-1]).exists()


@pytest.mark.parametrize("command", USES)
def test_strictly_it_is_refused(command: str, answer: dict[str, Any], run: Runs) -> None:
    good = run(f"{command} --strict")
    assert (good.code, good.err) == (0, "")
    made = Path(command.split()[-1])
    made.unlink()
    Path("help.json").write_text(json.dumps(answer | DOCTORED[0][0]))
    done = run(f"{command} --strict")
    assert (done.code, done.out) == (1, "")
    assert done.err.startswith("Error: help.json does not hold: cost")
    assert not made.exists()


def test_nobody_draws_a_hundred_thousand_epochs(answer: dict[str, Any], run: Runs) -> None:
    answer["plan"][-1]["epoch"] = 100_000
    Path("help.json").write_text(json.dumps(answer))
    done = run("show --example room2 help.json -o out.html")
    assert_one_line(done, "help.json", "100000 epochs", str(MOST_EPOCHS))
