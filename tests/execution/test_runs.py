"""Many runs: the same dice give the same rows, and rows say what happened."""

import pytest

import serendipity
from serendipity.execution import Faults, Recorded, moment_of
from serendipity.model import InputError, UsageError

TIMES = ("slowest",)


def _figures(runs: serendipity.execution.Runs) -> list[dict[str, object]]:
    return [{k: v for k, v in row.to_dict().items() if k not in TIMES} for row in runs.rows]


@pytest.mark.long
@pytest.mark.parametrize("human", ["observant", "local", "omniscient", "noisy:0.3"])
def test_the_same_seed_gives_the_same_runs_in_any_number_of_processes(human: str) -> None:
    task = serendipity.example("room2")
    settings = {"runs": 3, "seed": 5, "discount": "0.9", "ties": "drawn", "faults": "fail=0.2,slow=0.2"}
    rows = _figures(serendipity.execute(task, human, **settings))
    assert rows == _figures(serendipity.execute(task, human, **settings))
    if human == "noisy:0.3":
        assert rows == _figures(serendipity.execute(task, human, jobs=2, **settings))
        assert rows[1:] == [
            {**row, "run": row["run"] + 1}  # type: ignore[operator]
            for row in _figures(serendipity.execute(task, human, **{**settings, "runs": 2, "seed": 6}))
        ]


@pytest.mark.parametrize("human", ["observant", "local", "omniscient", "noisy:0.3"])
def test_runs_with_time_to_decide_are_those_without_a_deadline(human: str) -> None:
    """Runs of one task share tables and the plan from before the first epoch, and nothing that happened."""
    settings = {"runs": 3, "discount": "0.9", "ties": "drawn"}
    timed, untimed = (
        serendipity.execute(serendipity.example("room2"), human, deadline=deadline, **settings)
        for deadline in (60, None)
    )
    assert [(r.cost, r.human_cost, r.epochs) for r in timed.rows] == [
        (r.cost, r.human_cost, r.epochs) for r in untimed.rows
    ]


def test_a_summary_counts_runs() -> None:
    runs = serendipity.execute(serendipity.example("room2"), "noisy:0.2", runs=8, discount="0.9")
    found = runs.summary()
    assert found["less"] + found["same"] + found["more"] == pytest.approx(1)
    assert found["reached"] == 1 and found["kept"] == 1
    assert len(list(runs.summary_lines())) == 4


def test_a_goal_is_recognised_at_some_epoch() -> None:
    task = serendipity.example("room2")
    goals = [{"name": room, "goal": [f"conducted_triage commx {room}"]} for room in ("room1", "room8")]
    (row,) = serendipity.execute(task, goals=goals, discount="0.9").rows
    assert row.known is not None and 1 < row.known < row.epochs and row.wrong == 0


def test_a_recorded_person_does_what_is_written_and_then_goes_on() -> None:
    task = serendipity.example("room2")
    record = ["noop", "move commx room13 hall8", "move_reverse commx hall8 hall7"]
    runs = serendipity.execute(task, record, discount="0.6")
    did = [line["human"] for line in runs.logs[0][1:4]]
    assert did == [None, *record[1:]] and runs.rows[0].reached
    run = serendipity.Execution(task)
    person = Recorded(task, ["move_reverse commx hall8 hall7"])
    assert run.step(person.choose(moment_of(run))).in_vain
    assert run.step(person.choose(moment_of(run))).human == "move commx room13 hall8"


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"human": "psychic"}, "human: expected one of recorded:FILE, .*, got 'psychic'"),
        ({"human": "noisy"}, "human: expected one of"),
        ({"human": "noisy:2"}, "noisy: expected a probability from 0 to 1, got 2"),
        ({"human": "observant:1"}, "human: expected one of"),
        ({"runs": 0}, "runs: expected at least 1, got 0"),
        ({"jobs": 0}, "jobs: expected at least 1, got 0"),
        ({"epochs": 0}, "epochs: expected at least 1, got 0"),
        ({"ties": "robust"}, "ties: expected one of fixed, drawn, got 'robust'"),
        ({"faults": "fail"}, "faults: expected some of fail=P,slow=P,drop=P, got 'fail'"),
        ({"faults": "fail=x"}, "fail: expected a finite number"),
        ({"human_model": "psychic"}, "human_model: expected one of"),
        (
            {"human": "omniscient", "mode": "communication", "goals": [{"goal": ["at commx room1"]}]},
            "goals: with robots. own goals, or communication, an omniscient person.s goal is known",
        ),
        ({"deadline": -1}, "deadline: expected"),
        ({"adapter": "nao"}, "adapter: expected one of simulated.*, got 'nao'"),
        ({"durations": "move"}, "durations: expected some of"),
        ({"epoch_seconds": 0}, "epoch_seconds: expected more than 0"),
        ({"adapter": lambda *_: None, "durations": "*=1"}, "durations: only simulated robots"),
        ({"adapter": lambda *_: None, "faults": "fail=0.1"}, "faults: only simulated robots"),
        ({"mode": "communication"}, "mode: expected serendipity, where nobody is told"),
        ({"human": "omniscient", "mode": "composite"}, "mode: expected serendipity or communication"),
    ],
)
def test_wrong_arguments_are_one_line(arguments: dict[str, object], complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint) as caught:
        serendipity.execute(serendipity.example("room2"), **arguments)
    assert "\n" not in str(caught.value)


def test_a_record_names_actions_of_the_person() -> None:
    with pytest.raises(InputError, match="recorded action 'fly': expected an action of commx's"):
        serendipity.execute(serendipity.example("room2"), ["fly"])


def test_faults_are_probabilities() -> None:
    assert Faults.parse("slow=0.5") == Faults(slow=0.5)
    with pytest.raises(UsageError, match="drop: expected a probability"):
        Faults(drop=1.5)
