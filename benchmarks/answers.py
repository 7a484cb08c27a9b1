"""Every answer to many calls, without times: what two versions of the planner say, side by side.

    python -m benchmarks.answers -o FILE [--count N] [--usar FOLDER]

Writes one JSON line a call: the results of random calls with their certificates, simulations, reports of
interruptions and explanations; of random tasks with several goals and with silent assistance; and, where the
folder is there, of the paper's problems in three modes at two discounts.  A change that is meant to change
nothing gives the same file: compare with ``diff``.
"""

import json
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from itertools import chain, product
from pathlib import Path
from random import Random
from typing import Annotated, Any

import typer

import serendipity
from benchmarks.problems import PROBLEMS, run
from serendipity import Result, SerendipityError, Task
from serendipity_testing.generator.calls import random_call

TIMED = ("elapsed_seconds", "seconds", "gap")
"""Fields that depend on the clock: improvements are told of now and then."""

Ask = Callable[[], Any]


def main(
    output: Annotated[Path, typer.Option("-o", "--output")],
    count: int = 600,
    usar: Path = PROBLEMS / "usar200",
) -> None:
    """Write the file, and say how many lines it has."""
    lines = 0
    with output.open("w") as out:
        for name, ask in chain(chain.from_iterable(map(_random, range(count))), _usar(usar)):
            out.write(f"{json.dumps([name, _said(ask)], sort_keys=True)}\n")
            lines += 1
    print(f"{lines} answers in {output}")


def _random(seed: int) -> Iterator[tuple[str, Ask]]:
    """Questions about one random task."""
    call = random_call(seed)
    task, asked, dice = call.task, call.keywords(), Random(f"answers {seed}")
    result = None
    with suppress(SerendipityError):
        result = serendipity.plan(task, human_plan=call.human_plan, **asked)
    yield f"plan {seed}", lambda: [*serendipity.plan_anytime(task, human_plan=call.human_plan, **asked)][-1]
    if result is not None:
        yield from _about(seed, task, result)
    if seed % 4 == 1:
        yield f"interruptions {seed}", partial(serendipity.interruptions, task, discount="0.5")
    if seed % 2 == 0:
        yield from _goals(seed, task, dice)
    if len(task.agents) == 2 and not task.robot_goal:
        ties = dice.choice(("fixed", "robust", "optimistic", "expected"))
        yield f"assistance {seed}", partial(_certified, task, mode="assistance", ties=ties, discount="0")


def _about(seed: int, task: Task, result: Result) -> Iterator[tuple[str, Ask]]:
    yield f"result {seed}", lambda: result
    yield f"check {seed}", partial(serendipity.check, task, result)
    if seed % 3 == 0:
        yield f"verify {seed}", partial(serendipity.verify, task, result)
    if result.plan is not None:
        for model in ("observant", "local"):
            yield f"simulate {seed} {model}", partial(serendipity.simulate, task, result, model)
    if seed % 4 == 0:
        yield f"explain {seed}", partial(serendipity.explain, task, result)


def _goals(seed: int, task: Task, dice: Random) -> Iterator[tuple[str, Ask]]:
    facts = [fact for fact in task.facts if not fact.startswith("(not")]
    chosen = dice.sample(facts, min(3, len(facts)))
    goals = [{"name": str(i), "goal": [fact]} for i, fact in enumerate(chosen)]
    mine = [task.actions[i].name for i in task.human_actions]
    observed = dice.sample(mine, 1) if mine and dice.random() < 0.5 else []
    discount = dice.choice(("0", "0.5", "0.9"))
    yield f"recognise {seed}", partial(serendipity.recognise, task, goals, observed)
    yield f"goals {seed}", partial(_certified, task, goals=goals, observed=observed, discount=discount)


def _certified(task: Task, **options: Any) -> list[Any]:
    """An answer, checked by the rules, and certified where the goal is not known."""
    result = serendipity.plan(task, **options)
    judges = (serendipity.check, serendipity.verify)[: 2 if "goals" in options else 1]
    return [result, *(judge(task, result) for judge in judges)]


def _usar(folder: Path) -> Iterator[tuple[str, Ask]]:
    for path in sorted(folder.glob("test*")):
        task = serendipity.load(path)
        for mode, discount in product(("serendipity", "communication", "composite"), ("0", "0.6")):
            yield (
                f"{path.name} {mode} {discount}",
                partial(serendipity.plan, task, mode=mode, discount=discount),
            )


def _said(ask: Ask) -> Any:
    """An answer, or the error that came instead."""
    try:
        return _plain(ask())
    except SerendipityError as error:
        return f"{type(error).__name__}: {error}"


def _plain(value: Any) -> Any:
    """As JSON has it, without times."""
    if hasattr(value, "to_dict"):
        value = value.to_dict()
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items() if key not in TIMED}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


if __name__ == "__main__":
    run(main, __doc__)
