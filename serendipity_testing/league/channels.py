"""Ways to a helper that is somewhere else: in a thread, in a process, behind an address."""

import json
import queue
import subprocess
import threading
import urllib.request
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

from serendipity.model import Deadline, LimitReachedError
from serendipity_testing.judges.commands import program_words
from serendipity_testing.league.protocol import AnswerError, Ask, Observation

_PATIENCE: Final = 60.0
"""Seconds that an endpoint has where there is no deadline."""


class Timely:
    """Asks in a thread of its own, and waits no longer than there is time.

    An answer that comes too late is nobody's: the next question waits until it has come.

    Args:
        end: called when nobody asks any more.
    """

    def __init__(self, ask: Ask, end: Callable[[], None] = lambda: None) -> None:
        self._ask, self._end = ask, end
        self._questions: queue.SimpleQueue[Observation | None] = queue.SimpleQueue()
        self._answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._busy = False
        threading.Thread(target=self._work, daemon=True).start()

    def __call__(self, observation: Observation) -> Any:
        """The answer, or a LimitReachedError."""
        clock = Deadline(observation["seconds"])
        if self._busy:
            self._next(clock)
        self._questions.put(observation)
        self._busy = True
        answer = self._next(clock)
        if isinstance(answer, AnswerError | LimitReachedError):
            raise answer
        return answer

    def close(self) -> None:
        """Ask no more."""
        self._questions.put(None)
        self._end()

    def _next(self, clock: Deadline) -> Any:
        try:
            answer = self._answers.get(timeout=clock.left())
        except queue.Empty:
            raise LimitReachedError("time-limit") from None
        self._busy = False
        return answer

    def _work(self) -> None:
        while (observation := self._questions.get()) is not None:
            try:
                self._answers.put(self._ask(observation))
            except (AnswerError, LimitReachedError) as error:
                self._answers.put(error)
            except BaseException as error:  # whatever a stranger's helper does is its own fault, leaving too
                self._answers.put(AnswerError(f"{type(error).__name__}: {error}"))


class Process:
    """A program that reads an observation a line and writes an answer a line, as JSON.

    It goes on from case to case; where it has ended it is started again for the next question.

    Args:
        text: the command line, as a shell splits it; there is no shell.

    Raises:
        UsageError: there is no such program.
    """

    def __init__(self, text: str) -> None:
        self._words = program_words(text, "helper")
        self._running: subprocess.Popen[str] | None = None

    def __call__(self, observation: Observation) -> Any:
        """Its answer."""
        if self._running is None:
            pipe = subprocess.PIPE
            self._running = subprocess.Popen(self._words, stdin=pipe, stdout=pipe, text=True)
        running = self._running
        assert running.stdin is not None and running.stdout is not None, "they are pipes"
        try:
            running.stdin.write(json.dumps(observation) + "\n")
            running.stdin.flush()
            line = running.stdout.readline()
        except OSError:
            line = ""
        if not line:
            self.close()
            raise AnswerError(f"the program has ended, exit code {running.returncode}")
        return _value(line)

    def close(self) -> None:
        """End it."""
        running, self._running = self._running, None
        if running is not None:
            running.kill()
            running.wait()
            for stream in (running.stdin, running.stdout):
                if stream is not None:
                    with suppress(OSError):  # something may be left to be written
                        stream.close()


class Endpoint:
    """An address that is sent observations by POST, as JSON, and answers with JSON."""

    def __init__(self, address: str) -> None:
        self._address = address

    def __call__(self, observation: Observation) -> Any:
        """Its answer, or a LimitReachedError."""
        body, head = json.dumps(observation).encode(), {"Content-Type": "application/json"}
        request = urllib.request.Request(self._address, body, head, method="POST")
        try:
            with urllib.request.urlopen(request, timeout=observation["seconds"] or _PATIENCE) as response:
                return _value(response.read().decode(errors="replace"))
        except OSError as error:
            if isinstance(error, TimeoutError) or isinstance(getattr(error, "reason", None), TimeoutError):
                raise LimitReachedError("time-limit") from None
            raise AnswerError(f"{self._address}: {error}") from None


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        raise AnswerError(f"expected JSON, got {text.strip()!r:.50}") from None
