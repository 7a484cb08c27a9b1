"""Commands as processes of their own: how long they take, and how much memory."""

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

USUAL = ("-m", "serendipity")
"""What Python is asked to run."""

PATIENT = (
    "-c",
    "import os, runpy, time; clock = time.perf_counter; "
    "waits = os.open('/proc/self/schedstat', os.O_RDONLY); "
    "time.perf_counter = lambda: clock() - int(os.pread(waits, 99, 0).split()[1]) / 1e9; "
    "runpy.run_module('serendipity', None, '__main__')",
)
"""The same with a clock that stands still while the process waits for a processor; on Linux only."""


@dataclass(frozen=True, slots=True)
class Ended:
    """How a process ended.

    Attributes:
        code: its exit code; None where it was killed.
        seconds: from its start.
        waited: for how many of them it was ready to run, and others did; 0 where that is not known.
        peak: most memory, in MiB.
    """

    code: int | None
    seconds: float
    waited: float
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
        return min(runs, key=lambda ended: ended.seconds - ended.waited)

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
            over = os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            seconds = time.perf_counter() - started
            if over is not None:
                break
            if seconds > patience:
                process.kill()
                os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
                break
            time.sleep(0.001)
        waited = _waited(process.pid)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        code = None if process.returncode < 0 else process.returncode
        return Ended(code, seconds, waited, used.ru_maxrss / 1024)


def _waited(pid: int) -> float:
    try:
        return int(Path(f"/proc/{pid}/schedstat").read_text().split()[1]) / 1e9
    except OSError:
        return 0.0
