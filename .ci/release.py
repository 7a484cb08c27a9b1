"""Tries what is released as those get it who install it, with nothing but Python's standard library.

    python3 .ci/release.py [PYTHON ...]

Builds the sources, and from them a wheel for this platform and one for any.  Then, on each Python that
is named (default: python3.11 to python3.14, as far as they are here), in environments of their own and
outside of the checkout: both wheels are installed alone and run the demo; README's program runs; a
user's program is checked by mypy in strict mode; all extras can be had, and work; and that program runs.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

ROOT = Path(__file__).resolve().parents[1]
USER_PROGRAM = ROOT / "tests" / "release" / "user_program.py"
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
KERNEL = re.compile(r"search/kernel/_kernel\.(so|dylib|dll)")
BELONGS = re.compile(r"(serendipity(_[a-z]+)?|search|verify|serendipity_planner-[^/]*\.dist-info)/.*")
T = TypeVar("T")
USES = {
    "plot": ("-m", "serendipity", "interruptions", "--example", "room2", "--heat-map", "windows.png"),
    "live": ("-c", "import serendipity_live.guards.connections"),
    "dask": ("-c", "import distributed"),
    "data": ("-m", "serendipity", "interruptions", "--example", "room2", "-o", "windows.parquet"),
    "up": ("-c", "import serendipity.up"),
    "testing": ("-c", "import hypothesis, serendipity.testing.league"),
}
"""What each extra for users is there for, in short."""

HAS_KERNEL = "from search.kernel.library import library; print(library() is not None)"


class FailedError(Exception):
    """A step has failed; the text is what it said."""


class Built(NamedTuple):
    """What there is to try, and the Python whose environment has built it."""

    tools: Path
    here: Path
    anywhere: Path


def main() -> int:
    """Try everything; how many Pythons failed."""
    if shutil.which("pyenv"):  # its commands find only versions that are switched on
        bare = run("pyenv", "versions", "--bare").split()
        os.environ["PYENV_VERSION"] = ":".join(sorted(bare, key=numbers, reverse=True))
    pythons = sys.argv[1:] or found()
    if not pythons:
        sys.exit("no Python to try")
    with tempfile.TemporaryDirectory() as folder:
        steps = Steps()
        built = steps.take("sources and wheels", build, Path(folder), pythons[0])
        if built is None or not steps.take("what is in the wheels", contents, built):
            return 1
        failed = sum(not tried(python, built, Path(folder)) for python in pythons)
    print(f"{len(pythons) - failed} passed, {failed} failed")
    return failed


class Steps:
    """Takes steps, and says of each what came of it and how long it took.

    Args:
        name: stands in front of each line.
    """

    def __init__(self, name: str = "") -> None:
        self.fine = True
        self._name = name

    def take(self, what: str, step: Callable[..., T], *arguments: Any) -> T | None:
        """What a step returns; None where it failed."""
        begun = time.monotonic()
        value, said = None, ""
        try:
            value = step(*arguments)
        except FailedError as error:
            said, self.fine = str(error), False
        outcome = "FAILED" if said else "ok"
        print(f"{self._name + what:48} {outcome:6} {time.monotonic() - begun:6.1f} s", flush=True)
        if said:
            print(said, flush=True)
        return value


def found() -> list[str]:
    """The commands of the Pythons that are here."""
    named = {version: f"python{version}" for version in VERSIONS}
    here = {version: command for version, command in named.items() if works(command)}
    for version in named.keys() - here.keys():
        print(f"Python {version} is not here: left out")
    return list(here.values())


def numbers(version: str) -> list[int]:
    """A version as something that can be sorted."""
    return [int(number) for number in re.findall(r"\d+", version)]


def works(command: str) -> bool:
    """Whether a command is there, and starts."""
    try:
        run(command, "-c", "")
    except FailedError:
        return False
    return True


def build(folder: Path, python: str) -> Built:
    """The sources; then both wheels from these, not from the checkout."""
    tools = environment(folder / "tools", python)
    run(tools, "-m", "pip", "install", *map(pinned, ("hatchling", "editables", "mypy")))
    run(tools, "-m", "hatchling", "build", "-t", "sdist", "-d", folder / "sdist", cwd=ROOT)
    (sources,) = (folder / "sdist").glob("*.tar.gz")
    wheels: list[Path] = []
    for platform in ("", "any"):
        into = folder / f"wheel-{platform}"
        run(tools, "-m", "pip", "wheel", "--no-deps", "-w", into, sources, SERENDIPITY_WHEEL=platform)
        wheels.extend(into.glob("*.whl"))
    return Built(tools, *wheels)


def pinned(name: str) -> str:
    """A package in the version that developers have."""
    locked = (ROOT / "requirements-dev.txt").read_text(encoding="utf-8")
    return re.search(rf"^{name}==[^ ;\\]+", locked, re.MULTILINE)[0]  # type: ignore[index]  # or fail


def contents(built: Built) -> bool:
    """Whether wheels have the kernel where they should, the marks of typed packages, and nothing else."""
    for wheel, kernels in ((built.here, 1), (built.anywhere, 0)):
        names = zipfile.ZipFile(wheel).namelist()
        strange = [name for name in names if not BELONGS.fullmatch(name)]
        marks = [name for name in names if name.endswith("/py.typed")]
        if strange or len(marks) != 6 or sum(bool(KERNEL.fullmatch(name)) for name in names) != kernels:
            raise FailedError(f"{wheel.name}: expected {kernels} kernel and 6 py.typed, has {names}")
    if not built.anywhere.name.endswith("-py3-none-any.whl"):
        raise FailedError(f"expected a wheel for any platform, got {built.anywhere.name}")
    return True


def tried(python: str, built: Built, folder: Path) -> bool:
    """Whether everything works on a Python."""
    try:
        version = run(python, "-c", "import platform; print(platform.python_version())").strip()
    except FailedError as error:
        print(f"{python}: {error}")
        return False
    steps = Steps(f"{version}: ")
    home = folder / version
    home.mkdir()
    own: Path | None = None
    for name, wheel in (("any platform", built.anywhere), ("this platform", built.here)):
        own = steps.take(f"wheel for {name}", installed, home / wheel.stem, python, wheel)
        if own is None:
            return False
        steps.take("demo of it", demo, own, home)
    steps.take("README's program", readme, own, home)
    program = Path(shutil.copy(USER_PROGRAM, home))
    steps.take("types of a user's program", typed, built.tools, own, program)
    steps.take("extras", extras, own, built.here, home)
    steps.take("user's program, with extras", run, own, program)
    return steps.fine


def installed(folder: Path, python: str, wheel: Path) -> Path:
    """The Python of an environment with a wheel, and a kernel where the wheel is for one platform."""
    own = environment(folder, python)
    run(own, "-m", "pip", "install", wheel)
    run(own, "-m", "pip", "check")
    expected = str(not wheel.name.endswith("-any.whl"))
    if run(own, "-c", HAS_KERNEL, cwd=folder.parent).strip() != expected:  # not in the checkout
        raise FailedError(f"a kernel is loaded: expected {expected}")
    return own


def demo(own: Path, home: Path) -> str:
    """What `make demo` runs, with what is installed."""
    return run("make", "-f", ROOT / "Makefile", "demo", "RUNS=", f"BIN={own.parent}", cwd=home)


def readme(own: Path, home: Path) -> None:
    """Python in the README, as it stands there."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for program in re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        run(own, "-c", program, cwd=home)


def typed(tools: Path, own: Path, program: Path) -> str:
    """What mypy says of a user's program, with the packages that are installed."""
    return run(tools, "-m", "mypy", "--strict", "--python-executable", own, program, cwd=program.parent)


def extras(own: Path, wheel: Path, home: Path) -> None:
    """Install and try all that users may want; whatever else there is can be had together with it."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        every = tomllib.load(file)["project"]["optional-dependencies"]
    for_users = re.findall(r"\w+", every["all"][0].partition("[")[2])
    run(own, "-m", "pip", "install", f"{wheel}[all]")
    run(own, "-m", "pip", "check")
    for name in for_users:
        run(own, *USES[name], cwd=home)
    run(own, "-m", "pip", "install", "--dry-run", f"{wheel}[{','.join(every)}]")


def environment(folder: Path, python: str) -> Path:
    """The Python of a new environment."""
    run(python, "-m", "venv", folder)
    return folder / "bin" / "python"


def run(*command: str | Path, cwd: Path | None = None, **environment: str) -> str:
    """What a command prints.

    Raises:
        FailedError: it fails, or isn't there.
    """
    inherited = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    inherited |= {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_QUIET": "1", **environment}
    words: Sequence[str] = [str(word) for word in command]
    try:
        done = subprocess.run(
            words,
            cwd=cwd,
            env=inherited,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )
    except OSError as error:
        raise FailedError(f"{words[0]}: {error.strerror}") from None
    if done.returncode:
        raise FailedError(f"{' '.join(words)[:200]}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
