"""Every answer to many calls, without times: what two versions of the planner say, side by side.

    python -m benchmarks.answers -o FILE [--count N] [--usar FOLDER]

Writes one JSON line a call: the results of random calls with their
certificates, simulations, reports of interruptions and explanations; of random tasks with several
goals and with silent assistance; and, where the folder is there, of the paper's problems in three
modes at two discounts.  A change that is meant to change nothing
gives the same file: compare with ``diff``.
"""

import argparse
import contextlib
import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import serendipity
from benchmarks.problems import PROBLEMS
from serendipity import SerendipityError, Task
from serendipity.testing.generator.calls import PlanCall, random_call

TIMED = ("elapsed_seconds", "seconds", "gap")
"""What depends on the clock: improvements are told of now and then."""


def main() -> None:
    """Write the file, and say how many lines it has."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--count", type=int, default=600, help="random calls")
    parser.add_argument("--usar", type=Path, default=PROBLEMS / "usar200")
    arguments = parser.parse_args()
    lines = 0
    with arguments.output.open("w") as out:
        for name, answer in _all(arguments):
            out.write(f"{json.dumps([name, answer], sort_keys=True)}\n")
            lines += 1
            if lines % 100 == 0:
                print(f"\r{lines} answers", end="", file=sys.stderr)
    print(f"\r{lines} answers in {arguments.output}")


def _all(arguments: argparse.Namespace) -> Iterator[tuple[str, Any]]:
    for seed in range(arguments.count):
        yield from _random(seed)
    yield from _usar(arguments.usar)


def _random(seed: int) -> Iterator[tuple[str, Any]]:
    """What is asked of one random task."""
    call = random_call(seed)
    task, dice = call.task, Random(f"answers {seed}")
    result = None
    with contextlib.suppress(SerendipityError):
        result = serendipity.plan(task, human_plan=call.human_plan, **call.keywords())
    yield f"plan {seed}", _said(lambda: _last(call))
    if result is not None:
        yield f"result {seed}", _without_times(result.to_dict())
        yield f"check {seed}", _said(lambda: serendipity.check(task, result).to_dict())
        if seed % 3 == 0:
            yield f"verify {seed}", _said(lambda: serendipity.verify(task, result).to_dict())
        if result.plan is not None:
            for model in ("observant", "local"):
                yield (
                    f"simulate {seed} {model}",
                    _said(lambda model=model: serendipity.simulate(task, result, model).to_dict()),
                )
        if seed % 4 == 0:
            yield f"explain {seed}", _said(lambda: serendipity.explain(task, result).to_dict())
    if seed % 4 == 1:
        yield (
            f"interruptions {seed}",
            _said(lambda: serendipity.interruptions(task, discount="0.5").to_dict()),
        )
    if seed % 2 == 0:
        yield from _goals(seed, task, dice)
    if len(task.agents) == 2 and not task.robot_goal:
        yield from _silent(f"assistance {seed}", task, dice)


def _last(call: PlanCall) -> dict[str, Any]:
    *_, last = serendipity.plan_anytime(call.task, human_plan=call.human_plan, **call.keywords())
    return last.to_dict()


def _goals(seed: int, task: Task, dice: Random) -> Iterator[tuple[str, Any]]:
    facts = [fact for fact in task.facts if not fact.startswith("(not")]
    goals = [
        {"name": str(i), "goal": [fact]} for i, fact in enumerate(dice.sample(facts, min(3, len(facts))))
    ]
    mine = [task.actions[i].name for i in task.human_actions]
    observed = dice.sample(mine, 1) if mine and dice.random() < 0.5 else []
    discount = dice.choice(("0", "0.5", "0.9"))
    yield f"recognise {seed}", _said(lambda: serendipity.recognise(task, goals, observed).to_dict())

    def certified() -> list[Any]:
        result = serendipity.plan(task, goals=goals, observed=observed, discount=discount)
        return [
            result.to_dict(),
            serendipity.check(task, result).to_dict(),
            serendipity.verify(task, result).to_dict(),
        ]

    yield f"goals {seed}", _said(certified)


def _silent(name: str, task: Task, dice: Random) -> Iterator[tuple[str, Any]]:
    ties = dice.choice(("fixed", "robust", "optimistic", "expected"))

    def certified() -> list[Any]:
        result = serendipity.plan(task, mode="assistance", ties=ties, discount="0")
        return [result.to_dict(), serendipity.check(task, result).to_dict()]

    yield name, _said(certified)


def _usar(folder: Path) -> Iterator[tuple[str, Any]]:
    for path in sorted(folder.glob("test*")):
        task = serendipity.load(path)
        for mode in ("serendipity", "communication", "composite"):
            for discount in ("0", "0.6"):
                result = serendipity.plan(task, mode=mode, discount=discount)
                yield f"{path.name} {mode} {discount}", _without_times(result.to_dict())


def _said(answer: Callable[[], Any]) -> Any:
    """An answer, or the error that came instead."""
    try:
        return _without_times(answer())
    except SerendipityError as error:
        return f"{type(error).__name__}: {error}"


def _without_times(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_times(item) for key, item in value.items() if key not in TIMED}
    if isinstance(value, list | tuple):
        return [_without_times(item) for item in value]
    return value


if __name__ == "__main__":
    main()
