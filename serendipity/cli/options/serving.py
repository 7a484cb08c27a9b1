"""Where a server listens, who may ask, and what it lets them use."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from serendipity.cli.choices import option
from serendipity.cli.files.reading import read_text
from serendipity.cli.groups import OptionGroup
from serendipity.model import UsageError
from serendipity.model.options import limit_of

if TYPE_CHECKING:
    from serendipity_live.workers.pool import PoolLimits

_TOKEN: Final = "SERENDIPITY_TOKEN"
_MIB: Final = 2**20


class Listening(OptionGroup):
    """Where a server listens, and who may ask."""

    host: Annotated[str, option("--host ADDRESS", "Where to listen.")] = "127.0.0.1"
    port: Annotated[int, option("--port N", "0 for any that is free.")] = 8123
    allow_host: Annotated[
        list[str] | None, option("--allow-host NAME", "Another name under which it may be asked.")
    ] = None
    token_file: Annotated[
        Path | None, option("--token-file FILE", f"A token that requests need; or in {_TOKEN}.")
    ] = None

    def token(self) -> str | None:
        """The token, or None."""
        from serendipity_live.guards import connections

        token = os.environ.get(_TOKEN) if self.token_file is None else read_text(self.token_file)
        if token is None:
            if not connections.loopback(self.host):
                needed = f"so a token is needed: --token-file, or {_TOKEN}"
                raise UsageError(f"--host: others can reach {self.host}, {needed}")
            return None
        token = token.strip()
        if not token or not token.isascii() or not token.isprintable():
            where = _TOKEN if self.token_file is None else str(self.token_file)
            raise UsageError(f"{where}: expected a token of visible characters")
        return token


class Serving(OptionGroup):
    """What a server lets others use."""

    workers: Annotated[int | None, option("--workers N", "Processes; by default as many as processors.")] = (
        None
    )
    queue: Annotated[int, option("--queue N", "Requests that may wait.")] = 64
    body_limit: Annotated[str, option("--body-limit MIB", "The most that a request may have.")] = "4"
    time_limit: Annotated[str, option("--time-limit SECONDS", "The most that a request may take.")] = "60"
    memory_limit: Annotated[str, option("--memory-limit MIB", "The most that a process may use.")] = "2000"

    def pool(self) -> "PoolLimits":
        """What the workers may use."""
        from serendipity_live.workers.pool import PoolLimits

        for name, number, least in (("--workers", self.workers, 1), ("--queue", self.queue, 0)):
            if number is not None and number < least:
                raise UsageError(f"{name}: expected at least {least}, got {number}")
        return PoolLimits(
            self.workers or os.cpu_count() or 1,
            self.queue,
            limit("time_limit", self.time_limit, "seconds"),
            limit("memory_limit", self.memory_limit, "MiB"),
        )

    def body(self) -> int:
        """Bytes of a request, at most."""
        return int(limit("body_limit", self.body_limit, "MiB") * _MIB)


def limit(name: str, value: str, unit: str) -> float:
    """A limit that there has to be."""
    found = limit_of(name, value, unit)
    if found == float("inf"):
        raise UsageError(f"{name}: expected {unit}, got {value}")
    return found
