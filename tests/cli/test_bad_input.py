"""Bad input: exit 2 and one line that a person can act on, never a traceback."""

import json
from pathlib import Path

import pytest

import serendipity
from tests.cli.conftest import Runs, assert_one_line


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path]:
    """A good domain and problem to spoil."""
    serendipity.generate_usar(tmp_path, preset="room2", layout="pair")
    return tmp_path / "domain.pddl", tmp_path / "problem.pddl"


TASK = "plan domain.pddl problem.pddl --human commx --robot robot"


def spoil(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(("which", "content"), [(1, None), (1, b""), (0, bytes(range(256)) * 4)])
def test_files_that_are_missing_empty_or_noise(
    which: int, content: bytes | None, pair: tuple[Path, Path], run: Runs
) -> None:
    pair[which].unlink()
    if content is not None:
        pair[which].write_bytes(content)
    assert_one_line(run(TASK), pair[which].name)


@pytest.mark.parametrize(
    ("who", "old", "new", "words"),
    [
        ("commx", " (conducted_triage commx room1)", "", ["human"]),
        ("robot", "(:goal (and))", "(:goal (at robot room1))", ["commx", "robot", "human"]),
    ],
)
def test_one_agent_has_a_goal(
    who: str, old: str, new: str, words: list[str], tmp_path: Path, run: Runs
) -> None:
    serendipity.generate_usar(tmp_path / "task", preset="room2")
    spoil(tmp_path / f"task/{who}/problem.pddl", old, new)
    assert_one_line(run("plan task"), *words)


def test_who_could_be_the_human_is_said(pair: tuple[Path, Path], run: Runs) -> None:
    assert_one_line(run("plan domain.pddl problem.pddl"), "--human", "--robot")
    delivery = Path(__file__).parents[1] / "pddl" / "data" / "delivery"
    words = ["its agents: v, w, x", "--human H"]
    assert_one_line(run(f"plan {delivery / 'domain.pddl'} {delivery / 'problem.pddl'}"), *words)


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("plan --example room2 --discount 1.5", ["discount", "[0, 1]", "1.5"]),
        ("plan --example room2 --discount much", ["discount", "much"]),
        ("plan --example room2 --discount 1e999999999", ["discount", "1e999999999"]),
        (f"plan --example room2 --max-cost {'9' * 500}", ["max_cost", "99999"]),
        (f"plan --example room2 --window-weight {'9' * 5000}", ["window_weight", "99999"]),
        ("plan --example room2 --horizon 1000000000", ["horizon", "1000000"]),
        ("plan --example room2 --horizon -1", ["horizon", "-1"]),
        ("plan --example room2 --horizon 3", ["horizon", "13"]),
        ("plan --example room2 --horizon inf", ["horizon", "composite"]),
        ("plan --example room2 --mode magic", ["mode", "serendipity", "magic"]),
        ("plan --example room2 --max-window 0", ["max_window"]),
        ("plan --example room2 --keep-prefix", ["keep_prefix", "communication"]),
        ("plan --example room2 --format xml", ["--format", "text", "json", "xml"]),
        ("plan --example room3", ["example", "room2", "room3"]),
        ("plan --example room2 --human nobody", ["nobody", "commx"]),
        ("plan --example room2 --robot robot", ["--robot"]),
        ("plan --example room2 --team a,b", ["--team", "--agent"]),
        ("plan", ["--example", "none"]),
        ("plan --example room2 somewhere", ["more than one"]),
        ("plan nowhere", ["nowhere"]),
        (f"plan {'long' * 200}", ["can't be read: File name too long"]),
        (f"reproduce {'long' * 200}", ["can't be read: File name too long"]),
        ("plan a b c", ["3 paths"]),
        ("plan --agent commx", ["--agent"]),
        ("plan --agent commx=a,b --agent commx=a,b", ["each name once"]),
        ("plan --example room2 --human-plan nowhere", ["nowhere", "read"]),
        ("plan --example room2 -o nowhere/answer.json", ["-o", "nowhere"]),
        ("verify --example room2", ["TASK RESULT.json"]),
        ("verify --example room2 nowhere.json", ["nowhere.json"]),
        ("generate usar", ["-o"]),
        ("generate usar -o out --rooms 1", ["rooms"]),
        ("dance", ["dance"]),
        ("explain --example room2 --mode individual", ["explain", "individual"]),
        ("explain --example room2 absent.json", ["absent.json", "can't be read"]),
        ("interruptions --example room2 --heat-map map.pdf", [".svg", "map.pdf"]),
        ("interruptions --example room2 --heat-map absent/map.svg", ["--heat-map", "no folder"]),
        ("reproduce nowhere", ["nowhere", "expected a folder of tasks"]),
        ("reproduce nowhere --modes help", ["modes", "individual, serendipity", "'help'"]),
        ("reproduce nowhere --discounts ,", ["at least one"]),
        ("reproduce nowhere --jobs 0", ["jobs", "at least 1"]),
        ("reproduce nowhere --format text", ["--format", "table, csv, json"]),
        ("reproduce nowhere --report absent/page.html", ["--report", "no folder"]),
        ("plan --example room2 --save-plan nowhere/help.plan", ["--save-plan"]),
        ("plan --example room2 --progress loud", ["--progress", "plain", "loud"]),
        ("bench --rooms 4 --seeds 1 --plot timings.txt", ["--plot"]),
        ("bench --rooms 4 --seeds 1 --discounts x", ["discount"]),
        ("bench --rooms 4 --seeds 1 --scaling width", ["width"]),
        ("bench --rooms 4 --seeds 1 here --scaling rooms", ["--scaling"]),
        ("bench --rooms 4 --seeds 1 --contenders search,guess", ["guess"]),
    ],
)
def test_wrong_usage(command: str, words: list[str], run: Runs) -> None:
    assert_one_line(run(command), *words)


Answer = dict[str, object]


def assert_refused(run: Runs, text: str, *words: str) -> None:
    """A result of that text is."""
    Path("help.json").write_text(text)
    assert_one_line(run("verify --example room2 help.json"), "help.json", *words)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"schema": "serendipity.result/0"}, ["schema"]),
        ({"cost": -1}, ["cost"]),
        ({"cost": 10**400}, ["cost"]),
        ({"options": {"window_weight": 10**400}}, ["window_weight"]),
        ({"horizon": 10**9}, ["horizon"]),
        ({"status": "great"}, ["status"]),
        ({"window": {"start": 6, "end": 10**9}}, ["window.end"]),
        ({"plan": [{"epoch": 10**9, "agents": ["commx"], "action": "x", "cost": 1}]}, ["plan[0].epoch"]),
        ({"options": {"discount": 2}}, ["discount"]),
    ],
)
def test_spoilt_results(changes: dict[str, object], words: list[str], answer: Answer, run: Runs) -> None:
    assert_refused(run, json.dumps(answer | changes), *words)


def test_result_for_another_task(answer: Answer, run: Runs) -> None:
    assert run("generate usar --rooms 4 -o other").code == 0
    assert_one_line(run("verify other help.json"), "help.json", "another task")
    assert_refused(run, json.dumps(answer | {"human": "somebody"}), "another task", "somebody")


def test_result_with_nan(answer: Answer, run: Runs) -> None:
    assert_refused(run, json.dumps(answer | {"cost": float("nan")}), "NaN")


@pytest.mark.parametrize("text", ["", "{", "[]", "[" * 100_000, "9" * 5000, "\x00"])
def test_results_that_are_no_object(text: str, run: Runs) -> None:
    assert_refused(run, text)


def test_results_and_goals_may_begin_with_a_byte_order_mark(answer: Answer, run: Runs) -> None:
    Path("help.json").write_text("\ufeff" + json.dumps(answer))
    assert run("verify --example room2 help.json").code == 0
    Path("goals.json").write_text('\ufeff[{"goal": ["conducted_triage commx room1"]}]')
    assert run("recognise --example room2 --goals goals.json").code == 0


def test_truncated_result_names_the_line(answer: Answer, run: Runs) -> None:
    text = json.dumps(answer, indent=1)[:-40]
    assert_refused(run, text, f"help.json:{text.count(chr(10)) + 1}:")


@pytest.mark.parametrize("option", ["--window-weight", "--max-cost"])
def test_weights_that_no_float_is(option: str, run: Runs) -> None:
    done = run(f"plan --example room2 --discount 0.6 {option} 99999999999999999999 -o help.json")
    assert (done.code, done.err) == (0, "")
    assert run("verify --example room2 help.json").code == 0


@pytest.mark.parametrize("number", ["1e300", "9" * 101])
def test_numbers_that_are_too_long_are_called_so(number: str, run: Runs) -> None:
    done = run(f"plan --example room2 --window-weight {number}")
    assert_one_line(done, "window_weight: expected a finite number of at most 100 digits", number[:40])


def test_in_a_process_of_its_own(process: Runs) -> None:
    assert_one_line(process("plan nowhere --discount 0.5"), "nowhere")
    assert_one_line(process("plan --discount"), "--discount")
