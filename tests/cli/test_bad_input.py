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


@pytest.fixture(scope="module")
def result() -> str:
    """A good result of the example room2."""
    return serendipity.plan(serendipity.example("room2"), discount=0.6).to_json()


CLIP = "--clip: expected --adapter pybullet, and a single run"
OF_ITS_OWN = "--study: has scenarios, conditions and records of its own"


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
        (
            "front --example room2 --disturbance nag=1",
            ["disturbance: expected weights such as ask=1", "'nag=1'"],
        ),
        ("front --example room2 --observed goals.txt", ["--observed: goes with --goals only"]),
        ("front --example room2 -o front.png", ["-o: is for text and data", "--picture front.png"]),
        ("show --example room2 help.json", ["-o", ".html"]),
        ("show --example room2 help.json -o help.gif", ["-o", "help.gif"]),
        ("show --example room2 help.json -o help.html --epoch 3", ["--epoch"]),
        ("show --example room2 help.json -o help.svg --epoch 99", ["epoch", "99"]),
        ("show --example room2 help.json -o help.svg --scenario attic", ["scenario", "none", "attic"]),
        ("show --example room7 help.json -o help.svg", ["help.json", "not applicable"]),
        ("show --example room2 absent.json -o help.svg", ["absent.json"]),
        ("show --example room2 help.json -o absent/help.svg", ["-o", "absent"]),
        ("simulate --example room2 help.json --human-model psychic", ["human_model: expected one of"]),
        ("simulate --example room2 missing.json", ["can't be read"]),
        ("simulate help.json domain.pddl", ["expected TASK and then RESULT.json"]),
        ("execute --example room2 --human recorded", ["expected recorded:FILE, or the FILE behind TASK"]),
        ("execute --example room2 --human recorded:nowhere", ["nowhere: there is no such file"]),
        ("execute --example room2 --goals nowhere", ["nowhere: there is no such file"]),
        ("execute --example room2 --noise wrong=0.1", ["noise: goes with goals only"]),
        ("execute --example room2 --plans nowhere", ["nowhere: there is no such file"]),
        (
            "execute --example room2 --plans nowhere --human-model local",
            ["human_model: with plans only 'omniscient' is possible"],
        ),
        ("execute --example room2 --discount 2", ["discount: expected a number in [0, 1]"]),
        ("execute --example room2 --format xml", ["--format: expected one of text, json, csv"]),
        ("execute --example room2 --replay nowhere", ["nowhere: there is no such file"]),
        ("execute --example room2 --log no/where", ["--log: there is no folder no"]),
        ("execute --example room2 --person nobody", ["nobody"]),
        ("execute --example room2 --clip walk.gif", [CLIP]),
        ("execute --example room2 --clip walk.gif --adapter pybullet --runs 2", [CLIP]),
        ("execute --example room2 --clip walk.mp4 --adapter pybullet", ["ends in one of .gif, .png, .webp"]),
        ("execute --example room2 --clip no/where.gif --adapter pybullet", ["--clip: there is no folder no"]),
        ("recognise --example room2 --goals goals.txt --noise miss", ["some of miss=P,wrong=P, got 'miss'"]),
        (
            "recognise --example room2 --goals goals.txt --noise wrong=2",
            ["wrong: expected a probability"],
        ),
        ("recognise --example room2 --goals goals.txt --noise odd=0.1", ["noise: expected some of miss=P,"]),
        ("learn --example room2 absent.csv", ["absent.csv", "no such file"]),
        ("learn --example room2 .", ["TASK and then TRACES"]),
        ("check-task --example room9", ["room9"]),
        ("serve --port 70000", ["--port: expected a number from 0 to 65535"]),
        ("serve --host 192.0.2.1 --token-file none", ["none: can't be read"]),
        ("serve --host 0.0.0.0", ["--host: others can reach 0.0.0.0, so a token is needed"]),
        ("serve --workers 0", ["--workers: expected at least 1"]),
        ("serve --queue -1", ["--queue: expected at least 0"]),
        ("serve --time-limit x", ["time_limit: expected seconds"]),
        ("serve --time-limit inf", ["time_limit: expected seconds"]),
        ("play --view x", ["--view: expected one of observant, local"]),
        ("play --robots-are x", ["--robots-are: expected one of none, silent, announced"]),
        ("play --discount 2", ["discount: expected a number in [0, 1]"]),
        ("play --study here --rounds 0", ["--rounds: expected a number from 1 to 50"]),
        ("play --study here --example room2", [OF_ITS_OWN]),
        ("play --study here --goals x", [OF_ITS_OWN]),
        ("play --study here --robots-are none", [OF_ITS_OWN]),
        ("play --study here --records there", [OF_ITS_OWN]),
        ("play --report", ["--report: goes with --study"]),
        ("play --allow-host x", ["--allow-host: goes with --study"]),
        ("play --labels none.toml", ["none.toml: can't be read"]),
        ("play --study goals.txt/x", ["--study: "]),
        ("play --records goals.txt/x", ["--records: "]),
        ("play --goals none.txt", ["none.txt: "]),
        ("play --example nowhere", ["example: expected one of"]),
        ("play --port -1", ["--port: expected a number"]),
    ],
)
def test_wrong_usage(command: str, words: list[str], result: str, run: Runs, tmp_path: Path) -> None:
    files = {"goals.txt": "1: conducted_triage commx room1\n", "help.json": result}
    for name, text in files.items():
        Path(name).write_text(text)
    assert_one_line(run(command), *words)
    assert {path.name: path.read_text() for path in tmp_path.iterdir() if path.is_file()} == files


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
