"""One call of the search, in a process of its own: a JSON object as argument, one on stdout.

What is printed are the fields of a ``contenders.Outcome``.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

from search import prepare, solve
from serendipity.evaluation.benchmark.usage import peak_memory
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LIMITS
from serendipity.model.options import Options
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task
from serendipity.pddl import read_pddl


def answered(
    *,
    domain: str,
    problem: str,
    human: str,
    robots: list[str],
    options: dict[str, Any],
    time_limit: float,
) -> dict[str, Any]:
    """Read, then prepare and plan, each within the limit; what was found and measured."""
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
        "status": answer.status,
        "cost": None if answer.cost is None else float(answer.cost),
        "lower_bound": None if answer.lower_bound is None else float(answer.lower_bound),
        "expanded": answer.expanded or 0,
        "seconds": deadline.elapsed(),
        "plan_seconds": plan_seconds,
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(answered(**json.loads(sys.argv[1]))) + "\n")
