"""The compiled kernel, where there is one.

It is a plain shared library beside its source, called by :mod:`ctypes`, so that one file serves every
version of Python.  Whoever could use it asks :func:`library`, and has a way in Python for where that
says None.
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
        ``off``.
    """
    return None if os.environ.get("SERENDIPITY_KERNEL") == "off" else _loaded()


@cache
def _loaded() -> "CDLL | None":
    return load(BINARY, SOURCE)


def load(binary: Path, source: Path) -> "CDLL | None":
    """A compiled kernel from a file.

    Args:
        binary: where it is, if it is there.
        source: what it has to be compiled from, if that is there, with the units beside it.
    """
    if not binary.is_file():
        return None
    import ctypes  # here and below: most calls need no kernel, and should not wait for these

    try:
        found = ctypes.CDLL(str(binary.absolute()))
        compiled_from = found.kernel_source_hash
        compiled_from.restype = ctypes.c_char_p
        stale = source.is_file() and compiled_from() != source_hash(source).encode()
    except (OSError, AttributeError):
        return None
    return None if stale else found


def units(source: Path) -> list[Path]:
    """The source and all that it includes: the headers beside it."""
    return [source, *sorted(source.parent.glob("*.h"))]


def source_hash(source: Path) -> str:
    """What tells one state of the source from another; a kernel returns it as ``kernel_source_hash()``."""
    import hashlib

    hashes = (f"{unit.name} {hashlib.sha256(unit.read_bytes()).hexdigest()}" for unit in units(source))
    return hashlib.sha256("\n".join(hashes).encode()).hexdigest()
