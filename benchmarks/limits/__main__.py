"""How well every command keeps ``--time-limit`` and ``--memory-limit``, as a process.

    python -m benchmarks.limits plan|verify|memory|commands [--suite FOLDER] [--csv FILE] [--jobs N] [--fair]
        [--limits 0.1,1,10] [--memory MIB] [--commands plan,...] [--rotate N] [--tasks NAME,...] [--stride N]

What is measured, unless options say otherwise:

- ``plan``: every mode on all tasks of the suite, limits of 0.1 and 1 s
- ``verify``: certificates for answers of every mode, on 100 tasks of all kinds, 0.05, 0.5 and 5 s
- ``memory``: every mode and ``verify`` on the ten largest tasks of the suite, 300 MiB, 20 s
- ``commands``: every command on ten tasks of the suite and four of our own, 0.05, 0.5 and 2 s; and on
  all of them 40 MiB above what the process has when it starts

Tasks are those of ``benchmarks.limits.tasks``.

A command starts when the interpreter and its modules are loaded, which it tells itself (``reproduce`` does
not, so the same command with a limit of 0 is taken off).  What is over the limit is the *overrun*; a limit
is *kept* if that is at most 10 % of it and 50 ms.  ``reproduce`` has the limit twice: for reading,
and for its row.  A process that is late by 15 s is killed.

On a busy machine the deadline also counts what others do.  With ``--fair`` no clock runs while the process
waits for a processor (on Linux).  It does not see what solvers wait for, which are processes of their own,
nor what the machine itself waits for another: rows that are late by little are worth a second look.

With ``--csv`` rows are written as they come, and what is there already is not measured again; answers to
check are kept in a folder beside it.
"""

import argparse
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import count
from pathlib import Path

from benchmarks.limits.kinds import tasks_of_all_kinds
from benchmarks.limits.measuring import Measuring, jobs_of, measured
from benchmarks.limits.process import Runner
from benchmarks.limits.rows import add_rows, read_rows
from benchmarks.limits.studies import COMMANDS, STUDIES
from benchmarks.limits.tables import summary, table_of_memory, table_of_times
from benchmarks.limits.tasks import Named, own_tasks, tasks_of_suite
from benchmarks.problems import PROBLEMS

LARGEST = 10
"""Tasks that ``--memory`` is measured on."""


def main() -> int:
    """Measure and print tables; 1 where a limit was not kept."""
    arguments = _arguments()
    study = STUDIES[arguments.study]
    commands = study.commands
    if arguments.commands:
        commands = {name: COMMANDS[name] for name in arguments.commands.split(",")}
    rows = read_rows(arguments.csv)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch if arguments.csv is None else arguments.csv.absolute().with_suffix(".files"))
        folder.mkdir(parents=True, exist_ok=True)
        tasks = [task for task in _tasks(arguments, folder) if task.name.startswith(arguments.tasks)]
        limits = study.limits if arguments.limits is None else arguments.limits
        memory = study.memory if arguments.memory is None else arguments.memory
        if memory:
            tasks = sorted(tasks, key=lambda task: task.size)[-LARGEST:]
        print(f"{len(tasks)} tasks, {len(commands)} commands", file=sys.stderr, flush=True)
        choose = partial(jobs_of, commands=commands, most=arguments.rotate, folder=folder)
        with ThreadPoolExecutor(arguments.jobs) as threads:
            jobs = [job for found in threads.map(choose, tasks, count()) for job in found]
        print(f"{len(jobs)} commands on tasks", file=sys.stderr, flush=True)
        seconds = [float(limit) for limit in limits.split(",") if limit]
        measuring = Measuring(Runner(folder, arguments.fair), seconds, memory)
        for new in measured(measuring, jobs, {row.key for row in rows}, arguments.jobs):
            add_rows(arguments.csv, new)
            rows += new
    table_of_times(rows)
    table_of_memory(rows)
    return summary(rows)


def _tasks(arguments: argparse.Namespace, folder: Path) -> list[Named]:
    if arguments.study == "verify":
        return [*tasks_of_all_kinds(arguments.suite.parent, folder)]
    stride = STUDIES[arguments.study].stride if arguments.stride is None else arguments.stride
    own = own_tasks(folder) if arguments.study == "commands" else ()
    return [*own, *tasks_of_suite(arguments.suite, stride)]


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument(
        "--suite", type=Path, default=PROBLEMS / "codmap15", help="folder of domains in MA-PDDL"
    )
    parser.add_argument("--stride", type=int, default=None, help="take every N-th task of each domain")
    parser.add_argument("--tasks", type=_names, default=("",), help="only tasks whose names begin so")
    parser.add_argument("--commands", default="", help="some of the table's commands")
    parser.add_argument(
        "--rotate", type=int, default=None, help="on each task only N of the commands, in turn"
    )
    parser.add_argument("--limits", default=None, help="seconds, or none")
    parser.add_argument("--memory", type=float, default=None, help="MiB, on the ten largest tasks; 0: none")
    parser.add_argument("--jobs", type=int, default=1, help="so many processes at a time")
    parser.add_argument(
        "--fair", action="store_true", help="don't count what a process waits for a processor"
    )
    parser.add_argument("--csv", type=Path, default=None, help="write rows here, and go on where it ends")
    return parser.parse_args()


def _names(text: str) -> tuple[str, ...]:
    return tuple(text.split(","))


if __name__ == "__main__":
    sys.exit(main())
