"""What is of another type gets one sentence that names it, whatever is called, and no error of Python's."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity import Execution, Options, Result, SerendipityError, Session, Task, UsageError
from serendipity.testing.builders import task as built

WRONG: dict[str, tuple[Callable[[Task], Any], str]] = {
    "no task": (lambda _: serendipity.plan(None), "task: expected a Task"),  # type: ignore[arg-type]
    "a task's name": (lambda _: serendipity.plan("room2"), "task: expected a Task.* got 'room2'"),  # type: ignore[arg-type]
    "a session of a name": (lambda _: Session("room2"), "task: expected a Task"),  # type: ignore[arg-type]
    "a plan as a text": (
        lambda task: serendipity.plan(task, human_plan="move commx room13 hall8"),
        "human plan: expected a list of names, got 'move commx",
    ),
    "a plan of numbers": (
        lambda task: serendipity.plan(task, human_plan=[1, 2]),  # type: ignore[list-item]
        r"human plan: expected a list of names, got \[1, 2\]",
    ),
    "an action as a text": (
        lambda task: Session(task).execute("move commx room13 hall8"),
        "actions: expected a list of names",
    ),
    "what the human follows": (
        lambda task: Session(task).follow("move"),
        "human plan: expected a list of names",
    ),
    "a goal as a text": (
        lambda task: Session(task).set_goal("at commx hall8"),
        "goal: expected a list of names",
    ),
    "no folder": (lambda _: serendipity.load(None), "path: expected a path, got None"),  # type: ignore[arg-type]
    "no result": (
        lambda task: serendipity.verify(task, None),  # type: ignore[arg-type]
        "result: expected a Result, such as serendipity.plan gives, got None",
    ),
    "a number for goals": (
        lambda task: serendipity.recognise(task, goals=5),  # type: ignore[arg-type]
        "goals: expected a file, or a list of goals, got 5",
    ),
    "what can't be shown": (lambda _: serendipity.load(_Hidden()), "path: .* got a value of type _Hidden"),  # type: ignore[arg-type]
}


class _Hidden:
    """Of a type that nobody expects, and that can't even be shown."""

    def __repr__(self) -> str:
        raise RuntimeError


@pytest.mark.parametrize("what", WRONG)
def test_wrong_types(what: str) -> None:
    ask, message = WRONG[what]
    with pytest.raises(UsageError, match=message):
        ask(serendipity.example("room2"))


TASK = built(goal="g", actions={"do h": "!g -> g", "spare r": "!p -> p"})
RESULT = serendipity.plan(TASK)
GOALS = [{"name": "a", "goal": ["g"]}]
LIMITS = {"time_limit": None, "memory_limit": None, "deadline": None}

CALLS: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "plan": (
        serendipity.plan,
        {"task": TASK, "human_plan": None, "visible": None, "on_improvement": None, "cancelled": None}
        | {"goals": None, "discount": 0, "mode": "serendipity", **LIMITS},
    ),
    "plan for goals": (serendipity.plan, {"task": TASK, "goals": GOALS, "observed": (), "beta": 1}),
    "plan_anytime": (
        lambda **given: list(serendipity.plan_anytime(**given)),
        {"task": TASK, "human_plan": None, "visible": None, "cancelled": None, **LIMITS},
    ),
    "check": (serendipity.check, {"task": TASK, "result": RESULT, "time_limit": None, "deadline": None}),
    "verify": (
        serendipity.verify,
        {"task": TASK, "result": RESULT, "solver": "highs", "encoding": "automata", "method": "auto"}
        | {"proof": None, **LIMITS},
    ),
    "check_proof": (serendipity.check_proof, {"path": "none", "task": TASK, "result": RESULT, **LIMITS}),
    "check_task": (serendipity.check_task, {"task": TASK, "files": (), "deadline": None}),
    "example": (serendipity.example, {"name": "room2", "deadline": None}),
    "execute": (
        serendipity.execute,
        {"task": TASK, "human": "observant", "runs": 1, "seed": 0, "ties": "fixed", "faults": None}
        | {"adapter": None, "durations": None, "epoch_seconds": None, "human_model": None, "goals": None}
        | {"epochs": 3, "jobs": 1, "on_progress": None, "deadline": None},
    ),
    "explain": (serendipity.explain, {"task": TASK, "result": RESULT, "on_progress": None, **LIMITS}),
    "explain without a result": (serendipity.explain, {"task": TASK, "human_plan": None, "discount": 0}),
    "generate_usar": (
        serendipity.generate_usar,
        {"folder": "usar", "rooms": 4, "medkits": 1, "robots": 1, "seed": 0, "extra_edges": 0}
        | {"corridors": None, "preset": None, "layout": "pair"},
    ),
    "interruptions": (
        serendipity.interruptions,
        {"task": TASK, "human_plan": None, "on_progress": None, "discount": 0, **LIMITS},
    ),
    "load": (serendipity.load, {"path": "none", "human": None, "on_progress": None, **LIMITS}),
    "load_agents": (
        serendipity.load_agents,
        {
            "agents": {"h": ("d", "p")},
            "team": None,
            "human": "h",
            "name": None,
            "on_progress": None,
            **LIMITS,
        },
    ),
    "load_pddl": (
        serendipity.load_pddl,
        {"domain": "d", "problem": "p", "human": "h", "robots": ["r"], "name": None, "on_progress": None}
        | LIMITS,
    ),
    "recognise": (serendipity.recognise, {"task": TASK, "goals": GOALS, "observed": (), "beta": 1, **LIMITS}),
    "reproduce": (
        serendipity.reproduce,
        {"folder": "none", "modes": ("individual",), "discounts": (0,), "jobs": 1, "journal": None}
        | {"on_progress": None, **LIMITS},
    ),
    "simulate": (
        serendipity.simulate,
        {"task": TASK, "result": RESULT, "human_model": "observant", "visible": None, **LIMITS},
    ),
    "Session": (Session, {"task": TASK, "human_plan": None}),
    "Session.execute": (lambda actions: Session(TASK).execute(actions), {"actions": []}),
    "Session.change": (lambda facts: Session(TASK).change(facts), {"facts": {}}),
    "Session.follow": (lambda names: Session(TASK).follow(names), {"names": None}),
    "Session.set_goal": (lambda goal: Session(TASK).set_goal(goal), {"goal": ["g"]}),
    "Session.plan": (lambda **given: Session(TASK).plan(**given), {"discount": 0, "time_limit": None}),
    "Execution": (
        Execution,
        {"task": TASK, "discount": 0, "human_model": "observant", "goals": None, "beta": 1, "deadline": None}
        | {"interference": "paper", "told": False, "mode": "serendipity"},
    ),
    "Execution.step": (lambda action: Execution(TASK).step(action), {"action": None}),
    "Execution.change": (lambda facts: Execution(TASK).change(facts), {"facts": {}}),
    "Execution.drop": (lambda robots: Execution(TASK).drop(robots), {"robots": ["r"]}),
    "Deadline": (serendipity.Deadline, {"time_limit": None, "memory_limit": None}),
    "Options.from_dict": (Options.from_dict, {"data": Options().to_dict()}),
    "Result.from_dict": (Result.from_dict, {"data": RESULT.to_dict()}),
    "Task.at": (TASK.at, {"state": TASK.init, "deadline": None}),
    "Task.with_human": (TASK.with_human, {"human": "r"}),
    "Task.plan_from_names": (TASK.plan_from_names, {"names": ["do h"]}),
}

ANYTHING = (None, 5, 2.5, "nonsense", "a\0b", b"x", [], ["x"], [["x"]], [None], {"a": 1}, {1: 2}, object())


@pytest.mark.parametrize(
    ("call", "argument"), [(call, argument) for call, (_, good) in CALLS.items() for argument in good]
)
def test_anything_for_any_argument(
    call: str, argument: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is taken, or refused in one line."""
    monkeypatch.chdir(tmp_path)
    asked, good = CALLS[call]
    for value in ANYTHING:
        try:
            asked(**good | {argument: value})
        except SerendipityError as error:
            assert "\n" not in str(error)
