"""Progress that is said again and again: plain lines that get rarer, or one JSON object a line."""

from abc import ABC, abstractmethod
from threading import Event, Thread
from time import monotonic
from typing import Any, ClassVar, Final, Self

from serendipity.cli.streams.progress import Display
from serendipity.cli.streams.stderr import tell, write_line

RAREST: Final = 60.0
"""Seconds between two plain lines at most."""


class RepeatedDisplay(Display, ABC):
    """Says in a thread how far work is: first after some seconds, then after pauses that grow by a factor."""

    first: ClassVar[float]
    growth: ClassVar[float]

    def __init__(self, what: str) -> None:
        self.what = what
        self.words = ""
        self.done = self.total = 0
        self.first_done: int | None = None
        self.figures: dict[str, float | None] = {}
        self._started = monotonic()
        self._over = Event()
        self._thread = Thread(target=self._repeat, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self._over.set()
        self._thread.join()
        self.end(finished=kind is None)

    def count(self, done: int, total: int, **figures: float | None) -> None:
        """See the base."""
        self.first_done = done if self.first_done is None else self.first_done
        self.done, self.total, self.figures = done, total, figures
        self.words = ", ".join(f"{value:g} {name}" for name, value in figures.items() if value is not None)

    def news(self, words: str, **figures: float | None) -> None:
        """See the base."""
        self.words, self.figures = words, figures

    def seconds(self) -> float:
        """Since the work began."""
        return monotonic() - self._started

    @abstractmethod
    def say(self) -> None:
        """Say how far it is."""

    @abstractmethod
    def end(self, *, finished: bool) -> None:
        """Say that it is over, or broken off."""

    def _repeat(self) -> None:
        pause = self.first
        while not self._over.wait(pause):
            self.say()
            pause = min(self.growth * pause, RAREST)


class PlainLines(RepeatedDisplay):
    """``searches: 12 of 182 (4 s, 56 s left)``."""

    first, growth = 2.0, 2.0
    _said = False

    def say(self) -> None:
        """See the base."""
        self._said = True
        counted = "" if self.first_done is None else f"{self.done} of {self.total}"
        known = ", ".join(part for part in (counted, self.words) if part)
        tell(f"{self.what}{': ' if known else ''}{known} ({self.seconds():.0f} s{self._left()})")

    def _left(self) -> str:
        """How long it will take yet, if it goes on as it has gone so far."""
        if self.first_done is None or self.done == self.first_done:
            return ""
        pace = self.seconds() / (self.done - self.first_done)
        return f", {pace * (self.total - self.done):.0f} s left"

    def end(self, *, finished: bool) -> None:
        """See the base."""
        if finished and self._said:
            tell(f"{self.what}: done ({self.seconds():.0f} s)")


class JsonLines(RepeatedDisplay):
    """``{"event": "answer", "what": "planning", "seconds": 0.12, "cost": 12.6, ...}``."""

    first, growth = 1.0, 1.0

    def news(self, words: str, **figures: float | None) -> None:
        """See the base."""
        super().news(words, **figures)
        self._write("answer")

    def say(self) -> None:
        """See the base."""
        self._write("working")

    def end(self, *, finished: bool) -> None:
        """See the base."""
        if finished:
            self._write("done")

    def _write(self, event: str) -> None:
        import json

        line: dict[str, Any] = {"event": event, "what": self.what, "seconds": round(self.seconds(), 3)}
        line |= self.figures
        if self.first_done is not None:
            line |= {"done": self.done, "total": self.total}
        write_line(json.dumps(line))
