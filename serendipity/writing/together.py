"""Files that are there whole or not at all, several of them together; and files that grow line by line."""

import errno
import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path


def write_together(files: Mapping[Path, bytes]) -> None:
    """Write some files: afterwards all of them are there, or everything is as it was before.

    Folders that are missing are made.  Links are followed; a device or a pipe is written to.

    Raises:
        OSError: the system refuses; ``filename`` is the file it refuses.
    """
    with written_together(files):
        pass


@contextmanager
def written_together(files: Mapping[Path, bytes]) -> Iterator[None]:
    """Files on disk beside their places, which they take if the block ends well; or an OSError."""
    made: list[Path] = []
    waiting: dict[Path, Path] = {}
    try:
        for path, content in files.items():
            with _named(path):
                target = path.resolve()
                if target.is_dir():
                    raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
                made += _folders(target.parent)
                if not target.exists() or target.is_file():
                    waiting[path] = _beside(target, content)
        yield
        for path, content in files.items():
            with _named(path):
                waiting[path].replace(path.resolve()) if path in waiting else path.write_bytes(content)
    except BaseException:
        for temporary in waiting.values():
            temporary.unlink(missing_ok=True)
        with suppress(OSError):  # somebody else uses it by now
            for folder in reversed(made):
                folder.rmdir()
        raise


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Errors that name the file that was meant, and not the one beside it."""
    try:
        yield
    except OSError as error:
        error.filename, error.filename2 = str(path), None
        raise


def _folders(folder: Path) -> list[Path]:
    """Make a folder and those above it; the ones that were missing, outermost first."""
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return missing[::-1]


def _beside(target: Path, content: bytes) -> Path:
    """A new file in the folder of ``target``, with the permissions that it has or would get."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=".serendipity.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        temporary.chmod(target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~_umask())
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return temporary


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def append(file: Path, line: str) -> None:
    """Add a line to a file, made if missing, on disk on return; or an OSError, and it is as before."""
    before = file.stat().st_size if file.exists() else None
    try:
        with file.open("ab") as opened:
            opened.write(line.encode() + b"\n")
            opened.flush()
            os.fsync(opened.fileno())
    except OSError:
        _cut(file, before)
        raise


def _cut(file: Path, size: int | None) -> None:
    """Take away what has been written beyond a size; the whole file where that is None."""
    with suppress(OSError):
        if size is None:
            file.unlink(missing_ok=True)
        elif file.is_file():
            os.truncate(file, size)
