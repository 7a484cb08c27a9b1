"""A server of its own process, as somebody starts it on the command line."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import httpx


@dataclass
class Server:
    """One that is up."""

    url: str
    process: subprocess.Popen[str]
    client: httpx.Client
    folder: Path

    @property
    def port(self) -> int:
        return int(self.url.rpartition(":")[2])

    def post(self, path: str, body: object, **more: object) -> httpx.Response:
        return self.client.post(path, json=body, **more)

    @property
    def busy(self) -> int:
        return int(self.client.get("/health").json()["busy"])

    def stop(self, number: int = signal.SIGINT) -> tuple[int, str]:
        """Its exit code, and what it wrote to stderr."""
        self.process.send_signal(number)
        code = self.process.wait(timeout=20)
        return code, self.process.stderr.read()


def until(holds: Callable[[], bool], seconds: float = 20) -> None:
    """Wait for something that has to come about."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.02)


def workers_of(pid: int) -> list[int]:
    """The processes that a server has started."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            if int(stat.read_text().rpartition(")")[2].split()[1]) == pid:
                found.append(int(stat.parent.name))
        except (OSError, IndexError):
            continue
    return sorted(found)


@contextmanager
def serving(
    *arguments: str, command: str = "serve", env: dict[str, str] | None = None, seconds: float = 120
) -> Iterator[Server]:
    """A server on a free port, in a folder of its own; it is killed after so many seconds."""
    port = [] if "--port" in arguments else ["--port", "0"]
    with TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [sys.executable, "-m", "serendipity", command, *port, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=folder,
            env={**os.environ, **(env or {})},
        )
        watchdog = threading.Timer(seconds, process.kill)
        watchdog.start()
        try:
            line = process.stdout.readline()
            found = re.search(r"http://\S+?:\d+", line)
            assert found is not None, (line, process.stderr and process.stderr.read())
            with httpx.Client(base_url=found[0], timeout=30) as client:
                yield Server(found[0], process, client, Path(folder))
        finally:
            watchdog.cancel()
            process.kill()
            process.wait()
            for stream in (process.stdout, process.stderr):
                if stream is not None:
                    stream.close()
