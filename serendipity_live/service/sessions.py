"""What the server remembers of sessions: enough for any worker to go on with them."""

import json
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final

from starlette.exceptions import HTTPException

_AROUND: Final = 1024
"""Bytes of a session besides its texts, at most."""


@dataclass(slots=True)
class Remembered:
    """One session; what may be large is JSON text. ``state`` is as workers write it, at first ``null``."""

    name: str
    begun: bytes
    used: float
    state: bytes = b"null"
    version: int = 0
    busy: bool = False

    def asked(self, call: str, given: dict[str, Any]) -> bytes:
        """A call as a worker's job."""
        session = b'{"id": "%s", "version": %d, "state": %s, "begun": %s}' % (
            *(self.name.encode(), self.version),
            *(self.state, self.begun),
        )
        head = json.dumps({"call": call, "given": given}).encode()
        return b'%s, "session": %s}' % (head[:-1], session)

    def move(self, state: bytes) -> None:
        """Take over where a call has left it."""
        self.state = state
        self.version += 1

    def told(self, *, whole: bool = False) -> dict[str, Any]:
        """What callers see of it; with all of it for another server, if they ask for that."""
        snapshot = {"snapshot": self.snapshot} if whole else {}
        return {"id": self.name, **(json.loads(self.state) or {}), **snapshot}

    @property
    def snapshot(self) -> dict[str, Any]:
        """All of it, for another server."""
        return {**json.loads(self.begun), "state": json.loads(self.state)}

    @property
    def size(self) -> int:
        """The bytes that it takes, and some for what is around them."""
        return len(self.begun) + len(self.state) + _AROUND


class SessionStore:
    """The sessions of a server: those that nobody uses for some seconds are forgotten and free their room."""

    def __init__(self, most: int, bytes_: int, seconds: float) -> None:
        self._most = most
        self._bytes = bytes_
        self._seconds = seconds
        self._known: dict[str, Remembered] = {}

    def __len__(self) -> int:
        return len(self._known)

    @property
    def size(self) -> int:
        """The bytes that all of them take."""
        return sum(session.size for session in self._known.values())

    def begin(self, begun: dict[str, Any], state: dict[str, Any] | None = None) -> Remembered:
        """A session that :meth:`add` makes known, perhaps with the state of one on another server."""
        request, stands = (json.dumps(part, ensure_ascii=False).encode() for part in (begun, state))
        session = Remembered(secrets.token_urlsafe(16), request, time.monotonic(), stands)
        self._require_room(session)
        return session

    def add(self, session: Remembered) -> None:
        """Make a session known."""
        self._require_room(session)
        self._known[session.name] = session

    def _require_room(self, session: Remembered) -> None:
        self._forget()
        if len(self._known) >= self._most:
            raise HTTPException(429, f"sessions: there are {self._most}, no more are kept: delete one")
        if self.size + session.size > self._bytes:
            most = f"{self._bytes / 2**20:g} MiB"
            raise HTTPException(
                429, f"sessions: all of them may take {most}, too little for this: delete one"
            )

    def named(self, name: str) -> Remembered:
        """A session."""
        self._forget()
        if name not in self._known:
            raise HTTPException(404, f"session '{name:.50}': there is none, or no more")
        session = self._known[name]
        session.used = time.monotonic()
        return session

    def end(self, name: str) -> None:
        """Forget a session."""
        del self._known[self.named(name).name]

    @contextmanager
    def calling(self, name: str) -> Iterator[Remembered]:
        """A session for one call, which no other call may come into."""
        session = self.named(name)
        if session.busy:
            raise HTTPException(409, f"session '{name}': another call of it is under way")
        session.busy = True
        try:
            yield session
        finally:
            session.busy = False

    def _forget(self) -> None:
        oldest = time.monotonic() - self._seconds
        for name in [name for name, known in self._known.items() if known.used < oldest and not known.busy]:
            del self._known[name]
