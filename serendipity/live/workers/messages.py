"""What server and workers say to each other: a line of JSON, and behind it as many bytes as it announces."""

import json
from asyncio import StreamReader
from dataclasses import dataclass
from typing import IO, Any, Final

_LENGTH: Final = "length"


@dataclass(frozen=True, slots=True)
class Message:
    """One message.

    Attributes:
        head: what it is, as a small JSON object.
        body: JSON text, which the one who passes it on need not read.
    """

    head: dict[str, Any]
    body: bytes = b""

    @property
    def encoded(self) -> bytes:
        """The message as it is sent."""
        return json.dumps({**self.head, _LENGTH: len(self.body)}).encode() + b"\n" + self.body


def read(stream: IO[bytes]) -> Message | None:
    """The next message of a stream; None at its end."""
    line = stream.readline()
    if not line.endswith(b"\n"):
        return None
    head = json.loads(line)
    body = stream.read(head[_LENGTH])
    return Message(head, body) if len(body) == head[_LENGTH] else None


class Incoming:
    """Messages of an asynchronous stream; whoever stops waiting for one may wait for it again.

    Args:
        stream: where they come from.
    """

    def __init__(self, stream: StreamReader) -> None:
        self._stream = stream
        self._head: dict[str, Any] | None = None
        """Of a message whose body is still to come."""

    async def next(self) -> Message:
        """The next message.

        Raises:
            EOFError: the stream has ended.
        """
        if self._head is None:
            line = await self._stream.readline()
            if not line.endswith(b"\n"):
                raise EOFError
            self._head = json.loads(line)
        head = self._head
        body = await self._stream.readexactly(head[_LENGTH])  # its IncompleteReadError is an EOFError
        self._head = None
        return Message(head, body)
