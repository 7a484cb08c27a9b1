"""Symbolic search in a process of its own: a step of it may take seconds, and looks at no limit meanwhile."""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from search.classical.problem import ClassicalProblem
from serendipity.model.resources.child import ended
from serendipity.model.resources.deadline import Deadline


def is_installed() -> bool:
    """Whether there are decision diagrams, and a Python to run."""
    return bool(sys.executable) and find_spec("oxidd") is not None


def cheapest_plan(
    problem: ClassicalProblem, state: int, limit: int, deadline: Deadline, on_bound: Callable[[int], None]
) -> list[int] | None:
    """The canonical cheapest plan from a packed state, by numbers of operators; None from a limit on.

    Args:
        on_bound: told of what no plan weighs less than; at last of what the plan weighs, or the limit.

    Raises:
        LimitReachedError: the deadline came first; the process has been killed.
        MemoryError: it has given up.
        OSError: there can be no process.
    """
    with TemporaryDirectory() as folder:
        told, said = Path(folder, "told"), Path(folder, "said")
        told.write_bytes(pickle.dumps((problem, state, limit)))
        with told.open("rb") as source, said.open("wb") as target:
            child = subprocess.Popen(
                [sys.executable, "-P", "-m", __package__],
                stdin=source,
                stdout=target,
                stderr=subprocess.DEVNULL,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            )
        if ended(child, deadline, lambda: on_bound(_last(said)[0])):
            raise MemoryError("too many nodes in decision diagrams")
        weight, *plan = _last(said)
        on_bound(weight)
        return plan if weight < limit else None


def _last(said: Path) -> list[int]:
    """The numbers of the last line that is complete: a bound, at the end with a plan behind it."""
    lines = said.read_text().splitlines(keepends=True)
    return next(([*map(int, line.split())] for line in reversed(lines) if line.endswith("\n")), [0])
