"""Calls that can't be answered, or not yet, say so in one line.

What is of another type gets one sentence that names it, whatever is called, and no error of Python's.
"""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import serendipity
from serendipity import Execution, Options, Result, Script, SerendipityError, Session, Task, UsageError
from serendipity_testing.builders import task

PAYING = {"nobody_pays": True}
NOTICED = {"noticed": True}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (PAYING | {"mode": "assistance"}, "nobody_pays: is not known of mode 'assistance', nor of humans"),
        (PAYING | {"human_model": "observant"}, "nobody_pays: is not known of mode 'assistance'"),
        (PAYING | {"mode": "composite", "horizon": "inf"}, "nobody_pays: needs a horizon"),
        ({"nobody_pays": "yes"}, "nobody_pays: expected true or false, got 'yes'"),
        ({"leave_free": 3}, "leave_free: expected patterns apart by commas, got 3"),
        ({"leave_price": "at *"}, "leave_price: expected patterns such as dirty"),
        ({"leave_price": "at *=-1"}, r"leave_price: at \*: expected at least 0, got -1"),
        ({"leave_price": "at *=x"}, r"leave_price: at \*: "),
        ({"leave_price": 3}, "leave_price: expected patterns with prices"),
        ({"leave_price": "*=1", "mode": "composite", "horizon": "inf"}, "leave_price: needs a horizon"),
        ({"max_disturbance": -1}, "max_disturbance: expected a number of at least 0, got -1"),
        ({"max_disturbance": 1, "mode": "assistance"}, "max_disturbance: is not known of mode 'assistance'"),
        ({"disturbance": "ask=x"}, "disturbance: ask: "),
        (NOTICED | {"mode": "composite"}, "noticed: goes with mode serendipity only"),
        (NOTICED | {"suffix": "subplan"}, "noticed: goes with suffix replan only"),
    ],
    ids=str,
)
def test_rules_of_help_go_with_some_options_only(options: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.plan(serendipity.example("room2"), **options)


WALK = {
    "go ann": "at_ann_p0 !shut -> at_ann_p1 !at_ann_p0 @ 1",
    "work ann": "at_ann_p1 -> done @ 5",
    "work-lit ann": "at_ann_p1 lit_p0 -> done @ 1",
    "light bot": "!shut -> lit_p0 @ 0",
    "shut cat": "-> shut @ 0",
}


@pytest.mark.parametrize(
    ("robot_goal", "moved", "options", "message"),
    [
        ("lit_p0", [], PAYING | {"suffix": "subplan"}, "it goes with suffix replan only; nobody_pays=False"),
        ("", [(1, "!at_ann_p0"), (1, "at_ann_p1")], NOTICED, "noticed: where somebody else moves the human"),
        (
            "",
            [],
            {"max_disturbance": 0, "interference": "strict"},
            r"where several ask for a fact to be false \('shut'\) is not known",
        ),
    ],
    ids=str,
)
def test_rules_of_help_go_with_some_tasks_only(
    robot_goal: str, moved: list[tuple[int, str]], options: dict[str, Any], message: str
) -> None:
    walk = task(
        agents="ann bot cat", human="ann", init="at_ann_p0", goal="done", robot_goal=robot_goal, actions=WALK
    )
    with pytest.raises(UsageError, match=message):
        serendipity.plan(walk.with_script(Script(facts=moved)), discount="0.5", window_weight=0, **options)


def test_scenarios_in_time_refuse_what_is_not_settled() -> None:
    one = task(goal="done", actions={"do h": " -> done @ 1 [2]", "help r": " -> done"})
    goals = [{"name": name, "goal": ["done"]} for name in "ab"]
    plans = [{"probability": 1, "plan": [[epoch, "do h"]]} for epoch in (1, 2)]
    with pytest.raises(UsageError, match="noise: where a script or durations count"):
        serendipity.plan(one, goals=goals, observed=["do h"], noise="miss=0.1")
    for name, value in {"head_start": 1, "waiting_cost": 1, "suffix": "subplan"}.items():
        with pytest.raises(UsageError, match=f"{name}: in time, with several goals or plans, only"):
            serendipity.plan(one, plans=plans, **{name: value})
    undone = one.with_script(Script(facts=[(4, "!done")]))
    with pytest.raises(UsageError, match=r"plan 'plan 1' does not last until epoch 4: the goal"):
        serendipity.plan(undone, plans=plans, horizon=4)


WRONG: dict[str, tuple[Callable[[Task], Any], str]] = {
    "no task": (lambda _: serendipity.plan(None), "task: expected a Task"),  # type: ignore[arg-type]
    "a task's name": (lambda _: serendipity.plan("room2"), "task: expected a Task.* got 'room2'"),  # type: ignore[arg-type]
    "a plan as a text": (
        lambda task: serendipity.plan(task, human_plan="move commx room13 hall8"),
        "human plan: expected a list of names, got 'move commx",
    ),
    "a goal as a text": (
        lambda task: Session(task).set_goal("at commx hall8"),
        "goal: expected a list of names",
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


Asked = tuple[Callable[..., Any], dict[str, Any]]
_TRIED = {
    "discount",
    "mode",
    "horizon",
    "max_cost",
    "human_model",
    "interference",
    "ties",
    "time_limit",
    "memory_limit",
}
MORE_OPTIONS = set(Options().to_dict()) - _TRIED
"""They are read as those are."""


TASK = task(goal="g", actions={"do h": "!g -> g", "spare r": "!p -> p"})
RESULT = serendipity.plan(TASK)
GOALS = [{"name": "a", "goal": ["g"]}]


def _of(function: Callable[..., Any], call: Callable[..., Any] | None = None, /, **good: Any) -> Asked:
    """What to call, and good values of its arguments: the defaults, but for those that are given."""
    told = inspect.signature(function).parameters.values()
    named = [p for p in told if p.default is not p.empty and p.name not in MORE_OPTIONS]
    defaults = {p.name: p.default for p in named}
    return call or function, defaults | good


CALLS: dict[str, Asked] = {
    "plan": _of(serendipity.plan, task=TASK),
    "plan for goals": _of(serendipity.plan, task=TASK, goals=GOALS),
    "plan_anytime": _of(
        serendipity.plan_anytime, lambda **given: list(serendipity.plan_anytime(**given)), task=TASK
    ),
    "check": _of(serendipity.check, task=TASK, result=RESULT),
    "verify": _of(serendipity.verify, task=TASK, result=RESULT),
    "check_proof": _of(serendipity.check_proof, path="none", task=TASK, result=RESULT),
    "check_task": _of(serendipity.check_task, task=TASK),
    "example": _of(serendipity.example, name="room2"),
    "execute": _of(serendipity.execute, task=TASK, epochs=3),
    "explain": _of(serendipity.explain, task=TASK, result=RESULT),
    "explain without a result": _of(serendipity.explain, task=TASK),
    "generate_usar": _of(serendipity.generate_usar, folder="usar", rooms=4, layout="pair"),
    "interruptions": _of(serendipity.interruptions, task=TASK),
    "load": _of(serendipity.load, path="none"),
    "load_agents": _of(serendipity.load_agents, agents={"h": ("d", "p")}, human="h"),
    "load_pddl": _of(serendipity.load_pddl, domain="d", problem="p", human="h", robots=["r"]),
    "recognise": _of(serendipity.recognise, task=TASK, goals=GOALS),
    "reproduce": _of(serendipity.reproduce, folder="none", modes=("individual",), discounts=(0,)),
    "show": _of(serendipity.show, task=TASK, answer=RESULT),
    "simulate": _of(serendipity.simulate, task=TASK, result=RESULT),
    "Session": _of(Session, task=TASK),
    "Session.execute": (lambda actions: Session(TASK).execute(actions), {"actions": []}),
    "Session.change": (lambda facts: Session(TASK).change(facts), {"facts": {}}),
    "Session.follow": (lambda names: Session(TASK).follow(names), {"names": None}),
    "Session.set_goal": (lambda goal: Session(TASK).set_goal(goal), {"goal": ["g"]}),
    "Session.plan": (lambda **given: Session(TASK).plan(**given), {"discount": 0, "time_limit": None}),
    "Execution": _of(Execution, task=TASK),
    "Execution.step": (lambda action: Execution(TASK).step(action), {"action": None}),
    "Execution.change": (lambda facts: Execution(TASK).change(facts), {"facts": {}}),
    "Execution.drop": (lambda robots: Execution(TASK).drop(robots), {"robots": ["r"]}),
    "Deadline": _of(serendipity.Deadline),
    "Options.from_dict": (Options.from_dict, {"data": Options().to_dict()}),
    "Result.from_dict": (Result.from_dict, {"data": RESULT.to_dict()}),
    "Task.at": _of(TASK.at, state=TASK.init),
    "Task.with_human": (TASK.with_human, {"human": "r"}),
    "Task.plan_from_names": (TASK.plan_from_names, {"names": ["do h"]}),
}

ARRAY = np.array([1, 2])  # whose == is no truth value
ANYTHING = (
    *(None, 5, 2.5, "nonsense", "a\0b", "\ud800", b"x", object(), ARRAY, 10**300),
    *([], ["x"], [["x"]], [None], {"a": 1}, {1: 2}),
)


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
            assert len(str(error)) < 400
