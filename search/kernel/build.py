"""Compiles the kernel, and puts it beside its source.

    python -m search.kernel.build

The compiler is what the environment variable ``CC`` names, else ``cc``, else zig, if the package
``ziglang`` is installed.  Where there is none, that is no failure: all searches work without the kernel,
but are slower, and prove less within a limit.
"""

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from search.kernel.library import BINARY, SOURCE, load, source_hash

FLAGS: Final = (
    *("-std=c11", "-O3", "-shared", "-fPIC", "-Wall", "-Wextra"),
    "-ffp-contract=off",  # or some processors round otherwise than others, and the search goes another way
    # What newer compilers refuse by themselves.
    "-Werror=implicit-function-declaration",
    "-Werror=implicit-int",
    "-Werror=incompatible-pointer-types",
    "-Werror=int-conversion",
    "-Werror=return-type",
)


class CompilerError(Exception):
    """The compiler can't be run, or refuses the source; it says what the compiler said."""


def compiler() -> list[str] | None:
    """The command that compiles C for this machine, or None."""
    named = shlex.split(os.environ.get("CC", ""))
    if named:
        return named
    if shutil.which("cc"):
        return ["cc"]
    return zig() if find_spec("ziglang") else None


def zig(target: str = "native") -> list[str]:
    """The command with which zig compiles C for any processor of a target, without what debuggers want."""
    return [sys.executable, "-m", "ziglang", "cc", "-target", target, "-mcpu=baseline", "-s"]


def compile_kernel(command: Sequence[str], binary: Path, source: Path = SOURCE) -> None:
    """Compile the kernel into a file, which is there whole or not at all.

    Raises:
        CompilerError: that failed.
        OSError: the file can't be written.
    """
    with tempfile.TemporaryDirectory(dir=binary.parent, prefix=f"{binary.stem}-") as scratch:
        defined = f'-DKERNEL_SOURCE_HASH="{source_hash(source)}"'
        try:
            done = subprocess.run(
                [*command, *FLAGS, defined, "-o", binary.name, str(source.absolute())],
                cwd=scratch,  # macOS writes the name into the file as it is given
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                check=False,
            )
        except OSError as error:
            raise CompilerError(f"{command[0]}: {error.strerror}") from None
        if done.returncode:
            raise CompilerError(done.stdout.decode(errors="replace").strip())
        (Path(scratch) / binary.name).replace(binary)


def main(binary: Path = BINARY, source: Path = SOURCE) -> int:
    """Compile, and say in a line what came of it; 1 if there is a compiler and no kernel came of it."""
    command = compiler()
    if command is None:
        print("No kernel: there is no C compiler here (CC, cc, or zig by `pip install ziglang`).")
        return 0
    try:
        compile_kernel(command, binary, source)
    except CompilerError as error:
        print(f"{error}\nNo kernel: {source} can't be compiled.", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"No kernel: {error}", file=sys.stderr)
        return 1
    if isinstance(load(binary, source), str):
        binary.unlink()
        print(f"No kernel: what {command[0]} made of {source} can't be loaded here.", file=sys.stderr)
        return 1
    print(f"Kernel compiled: {binary}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
