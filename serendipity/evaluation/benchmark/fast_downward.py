"""Fast Downward, ``astar(lmcut())``, on the composite task without a horizon.

It is run as two processes, translator and search, and never imported: it is under the GPL.
Both come with the optional extra ``bench``: the translator from ``fast-downward.translate``,
the search's binary from the wheel ``up-fast-downward``.
"""

import re
import subprocess
import sys
import tempfile
from fractions import Fraction
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from search import PreparedTask
from serendipity.evaluation.benchmark.answer import Answer
from serendipity.evaluation.benchmark.usage import children_seconds
from serendipity.model.errors import SerendipityError
from serendipity.model.options import Options
from serendipity.pddl.write import composite_files

_TRANSLATE: Final = (
    *("-m", "fast_downward.translate", "domain.pddl", "problem.pddl", "--sas-file", "output.sas"),
    # Looking for invariants takes 5 s on tasks that are already ground, and finds none.
    *("--invariant-generation-max-time", "0"),
)
_UNSOLVABLE: Final = {"translator": 10, "search": 11}
"""Exit codes that are proofs (``driver/returncodes.py`` of Fast Downward)."""


def absent() -> str | None:
    """Why it can't be run, or None."""
    missing = [
        name
        for name, found in (("fast-downward.translate", _has_translator()), ("up-fast-downward", _binary()))
        if not found
    ]
    if not missing:
        return None
    return f"fast-downward is left out: no {' and no '.join(missing)} here: pip install serendipity[bench]"


def answer(prepared: PreparedTask, options: Options) -> Answer:
    """What it finds; ``seconds`` is the search time that it prints.

    Raises:
        SerendipityError: it fails, with what it says.
    """
    binary = _binary()
    assert binary is not None, "absent() was asked before"
    files = composite_files(prepared.task, options.discount)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "domain.pddl").write_text(files.domain, encoding="utf-8")
        (folder / "problem.pddl").write_text(files.problem, encoding="utf-8")
        start = children_seconds()
        try:
            code, text = _run([sys.executable, *_TRANSLATE], folder, options.time_limit)
            if code == _UNSOLVABLE["translator"]:
                return Answer(0.0, "infeasible", None, children_seconds() - start)
            _expect(code == 0, "the translator", text)
            search = [str(binary), "--search", "astar(lmcut())"]
            code, text = _run(search, folder, options.time_limit, stdin=folder / "output.sas")
        except subprocess.TimeoutExpired:
            spent = children_seconds() - start
            return Answer(spent, "unknown", None, spent)
        process_seconds = children_seconds() - start
    unsolvable = code == _UNSOLVABLE["search"]
    _expect(code == 0 or unsolvable, "the search", text)
    return Answer(
        seconds=_printed(r"Search time: ([0-9.e-]+)s", text),
        status="infeasible" if unsolvable else "optimal",
        cost=None if unsolvable else float(Fraction(int(_printed(r"Plan cost: (\d+)", text)), files.scale)),
        process_seconds=process_seconds,
        memory=_printed(r"Peak memory: (\d+) KB", text) / 1024,
    )


def _run(
    command: list[str], folder: Path, time_limit: float | None, stdin: Path | None = None
) -> tuple[int, str]:
    """Exit code and output of a process.

    Raises:
        subprocess.TimeoutExpired: it took longer; it is ended.
    """
    with (stdin or Path("/dev/null")).open("rb") as source:
        done = subprocess.run(
            command,
            cwd=folder,
            stdin=source,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=time_limit,
            check=False,
        )
    return done.returncode, done.stdout


def _expect(fulfilled: bool, who: str, text: str) -> None:
    if not fulfilled:
        last = " ".join(text.split("\n")[-4:])
        raise SerendipityError(f"fast-downward: {who} failed: {last}")


def _printed(pattern: str, text: str) -> float:
    """The last number of its kind in the output."""
    found = re.findall(pattern, text)
    _expect(bool(found), "the search", text)
    return float(found[-1])


@cache
def _has_translator() -> bool:
    return any(Path(place, "translate", "__main__.py").is_file() for place in _places("fast_downward"))


@cache
def _binary() -> Path | None:
    below = Path("downward", "builds", "release", "bin", "downward")
    return next(
        (Path(place, below) for place in _places("up_fast_downward") if Path(place, below).is_file()), None
    )


def _places(package: str) -> list[str]:
    """The folders of a package, which is not imported."""
    found = find_spec(package)
    return [] if found is None else list(found.submodule_search_locations or ())
