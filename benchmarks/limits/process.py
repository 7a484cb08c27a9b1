"""Commands as processes of their own: how long they take, and how much memory."""

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import NamedTemporaryFile

_PROGRAM = """
import os, runpy, sys, time
from serendipity.cli.options import limits

clock, said, fair = time.perf_counter, sys.argv.pop(1), sys.argv.pop(1) == "fair"
waits = os.open("/proc/self/schedstat", os.O_RDONLY) if fair else None

def waited():
    return 0.0 if waits is None else int(os.pread(waits, 99, 0).split()[1]) / 1e9

def begun(*given):
    with open(said, "w") as file:
        print(clock(), waited(), file=file)
    return begin(*given)

begin, limits.limits_from = limits.limits_from, begun
if fair:
    time.perf_counter = lambda: clock() - waited()
runpy.run_module("serendipity", None, "__main__")
"""
"""The command ``serendipity``, which tells when its limits begin; ``fair``, its clock stands still
while the process waits for a processor."""


@dataclass(frozen=True, slots=True)
class Ended:
    """How a process ended.

    Attributes:
        code: its exit code; None where it was killed.
        seconds: from when its limits began, or else from its start; with a fair clock less what it waited.
        waited: for how many seconds it was ready to run, and others did; 0 where that is not known.
        peak: most memory, in MiB.
        begun: whether its limits began, as those of commands do that go through ``limits.begin``.
    """

    code: int | None
    seconds: float
    waited: float
    peak: float
    begun: bool


@dataclass(frozen=True, slots=True)
class Runner:
    """Runs commands as processes of their own.

    Args:
        folder: where.
        fair: whether no clock runs while they wait for a processor; on Linux only.
    """

    folder: Path
    fair: bool = False

    def started(self, command: list[str], patience: float) -> Ended:
        """A command that starts, loads its modules, and ends at once: the quickest of some."""
        runs = [self([*command, "--time-limit", "0"], patience) for _ in range(5)]
        return min(runs, key=lambda ended: ended.seconds)

    def __call__(self, words: list[str], patience: float) -> Ended:
        """A command, which is killed after some seconds; with a fair clock less what it waits."""
        with NamedTemporaryFile(mode="r", dir=self.folder) as said:
            started = time.perf_counter()
            process = subprocess.Popen(
                [sys.executable, "-c", _PROGRAM, said.name, "fair" if self.fair else "", *words, "--quiet"],
                cwd=self.folder,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
                late = time.perf_counter() - started > patience
                if late and self.fair:
                    late = time.perf_counter() - started - _waited(process.pid) > patience
                if late:
                    process.kill()
                    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
                time.sleep(0.001)
            ended, waited = time.perf_counter(), _waited(process.pid)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            began, before = map(float, said.read().split() or (started, 0.0))
        seconds = ended - began - (waited - before if self.fair else 0.0)
        code = None if process.returncode < 0 else process.returncode
        return Ended(code, seconds, waited, used.ru_maxrss / 1024, began != started)


def _waited(pid: int) -> float:
    """Seconds that a process, which may have ended, was ready to run and did not."""
    try:
        return int(Path(f"/proc/{pid}/schedstat").read_text().split()[1]) / 1e9
    except OSError:
        return 0.0
