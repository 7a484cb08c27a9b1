"""One call of the search in a process of its own: a JSON object as argument, another one on stdout.

No call is warmed up by another one then, and the peak of memory is that of the call.
"""

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from search import prepare, solve
from serendipity.evaluation.measuring.figures import peak_memory, timed
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LIMITS, SerendipityError
from serendipity.model.options import Options
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task
from serendipity.pddl import read_folder, read_pddl


def in_child(kind: str, *, most: float | None = None, **asked: Any) -> dict[str, Any]:
    """Result of a call in a process of its own.

    Args:
        kind: ``suite`` or ``series``.
        most: seconds after which it is ended, or None.
        asked: its keywords, plain values.

    Raises:
        SerendipityError: the process has failed; the last line that it said, or its exit code.
        TimeoutExpired: it was ended.
    """
    command = [sys.executable, "-m", __name__, kind, json.dumps(asked)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=most)
    if done.returncode:
        raise SerendipityError(done.stderr.strip().rpartition("\n")[2] or f"exit code {done.returncode}")
    return json.loads(done.stdout)  # type: ignore[no-any-return]


def in_suite(
    *, domain: str, problem: str, human: str, robots: list[str], options: dict[str, Any], time_limit: float
) -> dict[str, Any]:
    """Read, then prepare and plan, each within the limit, by the clock: fields of an ``Outcome``."""
    start = time.perf_counter()
    outcome: dict[str, Any] = {"status": "unknown"}
    try:
        task = read_pddl(Path(domain), Path(problem), human, robots, deadline=Deadline(time_limit))
    except LIMITS:
        outcome["read_seconds"] = time.perf_counter() - start
    else:
        outcome["read_seconds"] = time.perf_counter() - start
        with no_collection():  # as `plan` does
            outcome |= _planned(task, Options(**options), Deadline(time_limit))
    return outcome | {"process_seconds": time.process_time(), "memory": peak_memory()}


def _planned(task: Task, options: Options, deadline: Deadline) -> dict[str, Any]:
    answer, plan_seconds = Answer("unknown"), None
    try:
        for answer in solve(prepare(task, deadline), options, deadline=deadline):
            if plan_seconds is None and answer.cost is not None:
                plan_seconds = deadline.elapsed()
    except LIMITS:
        pass  # before there was anything
    return {
        **_said(answer),
        "lower_bound": None if answer.lower_bound is None else float(answer.lower_bound),
        "seconds": deadline.elapsed(),
        "plan_seconds": plan_seconds,
    }


def in_series(*, folder: str, options: dict[str, Any], time_limit: float) -> dict[str, Any]:
    """Read, prepare and plan twice, in processor seconds: the measured fields of a ``Sample``."""
    asked = Options(**options, time_limit=time_limit)

    def call() -> Answer:
        *_, answer = solve(prepared, asked, deadline=Deadline(time_limit))
        return answer

    task, read_seconds = timed(lambda: read_folder(folder))
    prepared, pack_seconds = timed(lambda: prepare(task))
    answer, search_seconds = timed(call)
    _, again_seconds = timed(call)
    return {
        **_said(answer),
        "actions": len(task.actions),
        "length": len(answer.human_plan or ()),
        "read_seconds": read_seconds,
        "pack_seconds": pack_seconds,
        "search_seconds": search_seconds,
        "again_seconds": again_seconds,
        "memory": peak_memory(),
    }


def _said(answer: Answer) -> dict[str, Any]:
    cost = None if answer.cost is None else float(answer.cost)
    return {"status": answer.status, "cost": cost, "expanded": answer.expanded or 0}


if __name__ == "__main__":
    _, name, text = sys.argv
    call = in_suite if name == "suite" else in_series
    sys.stdout.write(json.dumps(call(**json.loads(text))) + "\n")
