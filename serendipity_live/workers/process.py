"""A worker, ``python -m serendipity_live.workers.process MIB FOLDER``: jobs on stdin, answers on stdout.

It ends when stdin does, so it never outlives the server, and takes its folder for temporary files with it.
"""

import json
import logging
import os
import queue
import shutil
import signal
import sys
import tempfile
import threading
from contextlib import suppress
from typing import IO, Final

from serendipity.model import Deadline, LimitReachedError, SerendipityError
from serendipity.model.errors import limit_words
from serendipity.model.resources.deadline import MIB
from serendipity.model.resources.memory import resident
from serendipity_live.workers.jobs import JOBS, State, WorkerState
from serendipity_live.workers.messages import Message

WRONG: Final = 422
TOO_LONG: Final = 504
TOO_LARGE: Final = 507
BROKEN: Final = 500
"""What went wrong, as status codes of HTTP."""

_ADDRESSES: Final = 4096 * MIB
"""What a process needs beyond its memory limit: addresses of libraries and threads, mostly unused."""


class Worker:
    """One job after the other, each under its limits; a job may be cancelled while it runs.

    Its folder, for temporary files, is gone when it ends.
    """

    def __init__(self, source: IO[bytes], sink: IO[bytes], memory_limit: float, folder: str) -> None:
        self._source = source
        self._sink = sink
        self._memory_limit = memory_limit
        self._folder = folder
        self._state = WorkerState()
        self._jobs: queue.SimpleQueue[tuple[Message, threading.Event]] = queue.SimpleQueue()

    def run(self) -> None:
        """Work until there is no source any more."""
        threading.Thread(target=self._listen, daemon=True).start()
        while True:
            self._work(*self._jobs.get())

    def _listen(self) -> None:
        current = threading.Event()
        with suppress(EOFError):
            while True:
                frame = Message.decoded(self._source.readline())
                if frame.head["kind"] == "cancel":
                    current.set()
                    self._state.cancel()
                else:
                    current = threading.Event()
                    self._jobs.put((frame, current))
        self._end()

    def _work(self, job: Message, cancelled: threading.Event) -> None:
        self._say({"kind": "begun"})
        deadline = Deadline(job.head["time_limit"], self._memory_limit, cancelled)
        try:
            for answer in JOBS[job.head["job"]](self._state, json.loads(job.body), deadline):
                kind = {"kind": "answer", "state": isinstance(answer, State)}
                self._say(kind, json.dumps(answer, allow_nan=False).encode())
            end: dict[str, object] = {"kind": "end"}
        except LimitReachedError as limit:
            end = _failed(TOO_LARGE if limit.reason == "memory-limit" else TOO_LONG, str(limit))
        except MemoryError:
            self._state = WorkerState()
            end = _failed(TOO_LARGE, limit_words("memory-limit"))
        except SerendipityError as error:
            end = _failed(WRONG, str(error))
        except Exception:  # a fault of ours: this job fails, the next one does not
            logging.exception("job '%s' failed", job.head["job"])
            end = _failed(BROKEN, "the planner failed on this request: please report it, with the request")
        self._say({**end, "resident": resident() or 0})

    def _say(self, head: dict[str, object], body: bytes = b"") -> None:
        try:
            self._sink.write(Message(head, body).encoded)
            self._sink.flush()
        except OSError:
            self._end()

    def _end(self) -> None:
        """End this process and the solvers that it has started."""
        shutil.rmtree(self._folder, ignore_errors=True)
        if hasattr(os, "killpg") and os.getpgid(0) == os.getpid():
            os.killpg(0, signal.SIGKILL)
        os._exit(0)


def _failed(status: int, line: str) -> dict[str, object]:
    return {"kind": "error", "status": status, "error": line}


def _limit_addresses(memory_limit: float) -> None:
    """Have what slips through the memory limit fail, instead of taking the machine's memory."""
    try:
        import resource
    except ImportError:  # not on Windows
        return
    most = int(memory_limit * MIB) + _ADDRESSES
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    if hard == resource.RLIM_INFINITY or most < hard:
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))


def main() -> None:
    """Run a worker on the standard streams; what a library prints goes to stderr."""
    memory_limit, folder = float(sys.argv[1]), sys.argv[2]
    tempfile.tempdir = os.environ["TMPDIR"] = folder  # also for the solvers that it starts
    logging.getLogger("search.kernel").setLevel(logging.ERROR)  # the pool says once if there is none
    _limit_addresses(memory_limit)
    sink = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    Worker(sys.stdin.buffer, sink, memory_limit, folder).run()


if __name__ == "__main__":
    main()
