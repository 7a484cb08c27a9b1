"""The compiled kernel, where there is one.

It is a plain shared library beside its source, called by :mod:`ctypes`, so that one file serves every
version of Python.  Whoever could use it asks :func:`library`, and has a way in Python, slower and
weaker, for where that says None.
"""

import os
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from ctypes import CDLL

_SUFFIXES: Final = {"darwin": ".dylib", "win32": ".dll"}

SOURCE: Final = Path(__file__).with_name("kernel.c")
BINARY: Final = Path(__file__).with_name("_kernel" + _SUFFIXES.get(sys.platform, ".so"))


def library() -> "CDLL | None":
    """The compiled kernel, loaded once.

    Returns:
        None where there is none, where it was compiled from another source than the one beside it, where
        it is no library of this machine, and where the environment variable ``SERENDIPITY_KERNEL`` is
        ``off``.  The first time, that is logged as a warning.
    """
    found = _found()
    if isinstance(found, str):
        _warn(found)
        return None
    return found


def state() -> str:
    """``compiled``, or ``none`` and in brackets why there is no kernel."""
    found = _found()
    return f"none ({found})" if isinstance(found, str) else "compiled"


def state_at_hand() -> str:
    """The same, but a file that nothing has had to load yet is taken for a kernel: loading takes a while.

    Where there is none that is logged, once.
    """
    is_off = os.environ.get("SERENDIPITY_KERNEL") == "off"
    if not is_off and not _loaded.cache_info().currsize and BINARY.is_file():
        return "compiled"
    library()
    return state()


def _found() -> "CDLL | str":
    return "SERENDIPITY_KERNEL=off" if os.environ.get("SERENDIPITY_KERNEL") == "off" else _loaded()


@cache
def _loaded() -> "CDLL | str":
    return load(BINARY, SOURCE)


@cache
def _warn(reason: str) -> None:
    import logging
    from multiprocessing import parent_process

    if parent_process() is None:  # else it has been said where the processes were started
        words = "no compiled kernel (%s): planning is much slower, and proves less within a limit"
        logging.getLogger(__name__).warning(words, reason)


def load(binary: Path, source: Path) -> "CDLL | str":
    """A compiled kernel from a file, or why there is none.

    Args:
        binary: where it is, if it is there.
        source: what it has to be compiled from, if that is there, with the units beside it.
    """
    if not binary.is_file():
        return f"there is no {binary.name}; `python -m search.kernel.build` compiles it"
    # imported here and below: most calls need no kernel, and should not wait for these
    from ctypes import CDLL, c_char_p

    from search.kernel.signatures import declare

    try:
        found = CDLL(str(binary.absolute()))
        compiled_from = found.kernel_source_hash
        compiled_from.restype = c_char_p
        stale = source.is_file() and compiled_from() != source_hash(source).encode()
        if not stale:
            declare(found)
    except (OSError, AttributeError):
        return f"{binary.name} is no kernel for this machine"
    return f"{binary.name} is of another source than the one beside it" if stale else found


def units(source: Path) -> list[Path]:
    """The source and all that it includes: the headers beside it."""
    return [source, *sorted(source.parent.glob("*.h"))]


def source_hash(source: Path) -> str:
    """A checksum of the source and its units; a kernel returns its own by ``kernel_source_hash()``."""
    from binascii import crc32  # zlib takes longer to load, and so does cryptography

    read = (unit.name.encode() + b"\n" + unit.read_bytes() for unit in units(source))
    return format(crc32(b"\n".join(read)), "08x")
