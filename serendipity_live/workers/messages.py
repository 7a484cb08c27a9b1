"""What server and workers say to each other: a line with a JSON object and, behind a tab, a JSON text."""

import json
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Message:
    """A small JSON object, and JSON text on one line, without tabs, that who passes it on need not read."""

    head: dict[str, Any]
    body: bytes = b""

    @property
    def encoded(self) -> bytes:
        """The message as it is sent."""
        return json.dumps(self.head).encode() + b"\t" + self.body + b"\n"

    @classmethod
    def decoded(cls, line: bytes) -> "Message":
        """The message of a line; an EOFError where the stream has ended before the line did."""
        if not line.endswith(b"\n"):
            raise EOFError
        head, _, body = line[:-1].partition(b"\t")
        return cls(json.loads(head), body)
