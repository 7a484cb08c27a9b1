"""The address that a server listens on: one clear line where it can't be had."""

import errno
import ipaddress
import os
import socket
from collections.abc import Sequence
from typing import Final

from serendipity.model import UsageError

_BACKLOG: Final = 2048

_ANYWHERE: Final = ("0.0.0.0", "::")
"""Addresses that stand for every address of the machine."""


def loopback(host: str) -> bool:
    """Whether a host is this machine, and reached from nowhere else."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def listening(host: str, port: int) -> socket.socket:
    """A socket that listens.

    Args:
        host: a name or an address.
        port: 0 for any that is free.

    Raises:
        UsageError: the port is in use or not allowed, or the host is not this machine's.
    """
    if not 0 <= port <= 65535:
        raise UsageError(f"--port: expected a number from 0 to 65535, got {port}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # what has just ended holds the port no longer
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind((host, port))
        made.listen(_BACKLOG)
    except OSError as error:
        made.close()
        raise UsageError(_refused(host, port, error)) from None
    return made


def _refused(host: str, port: int, error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return f"--port: {port} is in use on {host}: name another one, or 0 for any that is free"
    if error.errno == errno.EACCES:
        return f"--port: {port} is not allowed to you: name one above 1023, or 0 for any that is free"
    return f"--host: {host} can't be listened on: {(error.strerror or str(error)).lower()}"


def url(listener: socket.socket) -> str:
    """Where a listening socket is reached."""
    host, port = listener.getsockname()[:2]
    return f"http://{f'[{host}]' if ':' in host else host}:{port}"


def hosts(host: str, more: Sequence[str] = ()) -> list[str]:
    """What a request's ``Host`` may say, ports apart, so that no other site's name leads here."""
    own = [] if host in _ANYWHERE else [host]
    local = ["localhost", "127.0.0.1", "::1"] if loopback(host) or host in _ANYWHERE else []
    return sorted({name.lower() for name in (*own, *local, *more)})
