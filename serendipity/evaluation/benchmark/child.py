"""One task of a scaling series, in a process of its own: ``FOLDER MODE DISCOUNT TIME_LIMIT``.

Prints a JSON object with the measured fields of a ``scaling.Sample``.
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from search import prepare, solve
from serendipity.evaluation.benchmark.measure import MODES
from serendipity.evaluation.benchmark.usage import peak_memory
from serendipity.model.answers.answer import Answer
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.pddl import read_folder

T = TypeVar("T")


def answered(folder: Path, mode: str, discount: str, time_limit: float) -> dict[str, Any]:
    """Read, pack and plan twice; what was measured."""
    options = Options(discount=discount, time_limit=time_limit, **MODES[mode])

    def call() -> Answer:
        *_, outcome = solve(prepared, options, deadline=Deadline(time_limit))
        return outcome

    read_seconds, task = _timed(lambda: read_folder(folder))
    pack_seconds, prepared = _timed(lambda: prepare(task))
    search_seconds, outcome = _timed(call)
    again_seconds, _ = _timed(call)
    return {
        "actions": len(task.actions),
        "length": len(outcome.human_plan or ()),
        "read_seconds": read_seconds,
        "pack_seconds": pack_seconds,
        "search_seconds": search_seconds,
        "again_seconds": again_seconds,
        "memory": peak_memory(),
        "status": outcome.status,
        "cost": None if outcome.cost is None else float(outcome.cost),
        "expanded": outcome.expanded,
    }


def _timed(work: Callable[[], T]) -> tuple[float, T]:
    start = time.process_time()
    done = work()
    return time.process_time() - start, done


if __name__ == "__main__":
    place, *asked, limit = sys.argv[1:]
    sys.stdout.write(json.dumps(answered(Path(place), asked[0], asked[1], float(limit))) + "\n")
