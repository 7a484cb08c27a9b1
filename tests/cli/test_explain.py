"""``serendipity explain`` on the command line."""

import json
from pathlib import Path

from tests.cli.conftest import Runs, assert_one_line


def test_text_and_json_say_the_same(run: Runs) -> None:
    shown = run("explain --example room2 --discount 0.6")
    assert (shown.code, shown.err) == (0, "")
    data = json.loads(run("explain --example room2 --discount 0.6 --format json").out)
    assert data["schema"] == "serendipity.explanation/1"
    lines = [line.strip() for line in shown.out.splitlines() if line.startswith("  ")]
    assert lines == [sentence["text"] for sentence in data["sentences"]]
    topics = [line for line in shown.out.splitlines() if line and not line.startswith(" ")]
    assert topics == list(dict.fromkeys(sentence["topic"] for sentence in data["sentences"]))
    assert data["break_even_discount"]["exact"] == "1/2"
    assert (data["human_part"], data["robot_part"], data["cost"]) == (11, 1.6, 12.6)


def test_a_result_is_explained(run: Runs) -> None:
    assert run("plan --example room7 --discount 0.6 -o answer.json").code == 0
    from_file = run("explain --example room7 answer.json")
    assert from_file.code == 0
    assert from_file.out == run("explain --example room7 --discount 0.6").out


def test_a_doctored_result_is_refused(run: Runs, answer: dict[str, object]) -> None:
    assert_one_line(run("explain --example room2 help.json --discount 0.6"), "got both")
    Path("help.json").write_text(json.dumps(answer | {"cost": 12}))
    assert_one_line(run("explain --example room2 help.json"), "help.json", "no answer to this task")
