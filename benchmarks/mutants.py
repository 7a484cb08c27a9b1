"""Mutated PDDL files through the whole program: loaded, planned for, verified, each within a limit.

    python -m benchmarks.mutants [--count N] [--start N] [--keep FOLDER]

Counts what must not happen: exceptions that are not the program's own, verdicts against its own
answers, limits that are overrun by more than a tenth and 50 ms, by the clock and by the processor
time (so a busy machine is no overrun).  Each such mutant is named by its number, and with ``--keep``
written down.  What takes longer than twenty seconds is given up, and counted as hanging.
"""

import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import NoReturn, TypeVar

import typer

import serendipity
from serendipity import SerendipityError
from serendipity.evaluation.measuring.figures import peak_memory
from tests.pddl.mutants import Mutant, mutant

T = TypeVar("T")

LIMITS = {"loading": 0.5, "planning": 0.5, "verifying": 1.0}
MEMORY = 4_000
MODES = ("serendipity", "serendipity", "communication", "composite", "individual", "assistance")
HANGS = 20


class HangsError(Exception):
    """Something took much longer than its limit."""


def give_up(*_: object) -> NoReturn:
    """Handle an alarm."""
    raise HangsError


class Trial:
    """What has happened so far.

    Args:
        keep: where mutants are written that show something wrong, or None.
    """

    def __init__(self, keep: Path | None) -> None:
        self.counts: Counter[str] = Counter()
        self.wrong: list[str] = []
        self._keep = keep

    def run(self, number: int) -> None:
        """Load a mutant, and plan and verify if it loads."""
        changed = mutant(number)
        try:
            with tempfile.TemporaryDirectory() as folder:
                self._all(changed, number, Path(folder))
        except HangsError:
            self._note(changed, number, "hangs")
        except SerendipityError as error:
            self.counts[type(error).__name__] += 1
            if not str(error).isprintable():
                self._note(changed, number, f"not one line: {str(error)!r:.200}")
        except Exception as error:  # what is looked for
            self._note(changed, number, f"exception {type(error).__name__}: {error!s:.200}")

    def _all(self, changed: Mutant, number: int, folder: Path) -> None:
        files = changed.write(folder)
        load = lambda limit: serendipity.load_pddl(  # noqa: E731
            *files, changed.human, changed.robots, time_limit=limit, memory_limit=MEMORY
        )
        task = self._timed("loading", load, changed, number)
        self.counts["loaded"] += 1
        options = {"mode": Random(number).choice(MODES), "discount": "0.9"}
        result = self._timed(
            "planning", lambda limit: serendipity.plan(task, time_limit=limit, **options), changed, number
        )
        self.counts[f"planned: {result.status}"] += 1
        certificate = self._timed(
            "verifying", lambda limit: serendipity.verify(task, result, time_limit=limit), changed, number
        )
        self.counts[f"verified: {certificate.verdict}"] += 1
        if certificate.verdict == "refuted":
            self._note(changed, number, f"refuted {options['mode']}: {certificate.refuted}")

    def _timed(self, what: str, work: Callable[[float], T], changed: Mutant, number: int) -> T:
        limit = LIMITS[what]
        start, used = time.perf_counter(), time.process_time()
        signal.alarm(HANGS)
        try:
            return work(limit)
        finally:
            signal.alarm(0)
            late = min(time.perf_counter() - start, time.process_time() - used) - limit
            if late > limit / 10 + 0.05:
                self._note(changed, number, f"overrun {what}: {late:.2f} s")

    def _note(self, changed: Mutant, number: int, what: str) -> None:
        self.counts[what.split(":")[0]] += 1
        self.wrong.append(f"mutant {number} ({', '.join(changed.changes)}): {what}")
        print(self.wrong[-1], flush=True)
        if self._keep is not None:
            folder = self._keep / str(number)
            folder.mkdir(parents=True, exist_ok=True)
            changed.write(folder)

    def summary(self) -> str:
        """The counts, and the peak of memory."""
        counts = ", ".join(f"{what} {count}" for what, count in sorted(self.counts.items()))
        return f"{counts}; peak {peak_memory():.0f} MiB"


def main(count: int = 2_000, start: int = 0, keep: Path | None = None) -> None:
    """Print what has happened, and exit with 1 if something did that must not."""
    signal.signal(signal.SIGALRM, give_up)
    trial = Trial(keep)
    started = time.perf_counter()
    for number in range(start, start + count):
        trial.run(number)
        if number % 1_000 == 999:
            print(f"{number + 1}: {trial.summary()}", flush=True)
    print(f"{count} mutants in {time.perf_counter() - started:.0f} s: {trial.summary()}")
    sys.exit(bool(trial.wrong))


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
