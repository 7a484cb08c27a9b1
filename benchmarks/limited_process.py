"""Commands as processes of their own: how long they take, and how much memory."""

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

USUAL = ("-m", "serendipity")
"""What Python is asked to run."""

PROCESSOR = (
    "-c",
    "import runpy, time; time.perf_counter = time.process_time; "
    "runpy.run_module('serendipity', None, '__main__')",
)
"""The same with another clock."""


@dataclass(frozen=True, slots=True)
class Ended:
    """How a process ended.

    Attributes:
        code: its exit code; None where it was killed.
        seconds: from its start.
        processor: seconds of processor time.
        peak: most memory, in MiB.
    """

    code: int | None
    seconds: float
    processor: float
    peak: float


@dataclass(frozen=True, slots=True)
class Runner:
    """Runs commands as processes of their own.

    Args:
        program: what Python is asked to run.
        folder: where.
    """

    program: tuple[str, ...]
    folder: Path

    def started(self, command: list[str], patience: float) -> Ended:
        """A command that starts, loads its modules, and ends at once: the quickest of some."""
        runs = [self([*command, "--time-limit", "0"], patience) for _ in range(5)]
        return min(runs, key=lambda ended: ended.seconds)

    def __call__(self, words: list[str], patience: float) -> Ended:
        """A command, which is killed after some seconds."""
        started = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, *self.program, *words, "--quiet"],
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        while True:
            pid, status, used = os.wait4(process.pid, os.WNOHANG)
            seconds = time.perf_counter() - started
            if pid:
                break
            if seconds > patience:
                process.kill()
                _, status, used = os.wait4(process.pid, 0)
                break
            time.sleep(0.001)
        process.returncode = os.waitstatus_to_exitcode(status)
        code = None if process.returncode < 0 else process.returncode
        return Ended(code, seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)
