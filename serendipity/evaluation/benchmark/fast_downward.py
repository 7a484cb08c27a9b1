"""Fast Downward and SymK, planners for a single agent, as processes: translator and search.

They are never imported, for they are under the GPL.  All comes with the optional extra ``bench``: the
translator of both from ``fast-downward.translate``, the binaries from ``up-fast-downward`` and ``up-symk``.
"""

import re
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final, NamedTuple

from serendipity.evaluation.benchmark.contenders import Outcome
from serendipity.evaluation.measuring.figures import children_seconds
from serendipity.model.errors import SerendipityError
from serendipity.pddl.classical import ClassicalFiles


class Search(NamedTuple):
    """A program's configuration.

    Attributes:
        words: as the program is given it.
        package: the wheel that has the program.
        place: of the program in it.
    """

    words: str
    package: str = "up-fast-downward"
    place: str = "downward/builds/release/bin/downward"


LMCUT: Final = Search("astar(lmcut())")
"""A* with landmark cuts."""
IPDB: Final = Search("astar(ipdb())")
"""A* with the pattern databases that hill climbing chooses."""
SYMK: Final = Search("sym_bd()", "up-symk", "symk/builds/release/bin/downward")
"""Symbolic search from both ends, by decision diagrams."""
ANY_PLAN: Final = Search("lazy_greedy([ff()], preferred=[ff()])")
"""Some plan, soon."""

_SAS: Final = "output.sas"
_TRANSLATE: Final = ("-m", "fast_downward.translate", "domain.pddl", "problem.pddl", "--sas-file", _SAS)
_NO_INVARIANTS: Final = ("--invariant-generation-max-time", "0")
_UNSOLVABLE: Final = {"the translator": 10, "the search": 11}
"""Exit codes that are proofs (``driver/returncodes.py`` of Fast Downward)."""

_LEAVING: Final = 5.0
"""Seconds for saying what it knows, once it has to end."""


def absent(search: Search = LMCUT) -> str | None:
    """Why it can't be run, or None."""
    parts = {"fast-downward.translate": _has_translator(), search.package: program(search)}
    missing = " and no ".join(name for name, found in parts.items() if not found)
    hint = "here: pip install serendipity-planner[bench]"
    name = search.package.removeprefix("up-")
    return f"{name} is left out: no {missing} {hint}" if missing else None


@cache
def program(search: Search) -> Path | None:
    """The program, where it is installed."""
    places = (Path(place, search.place) for place in _places(search.package.replace("-", "_")))
    return next(filter(Path.is_file, places), None)


@cache
def _has_translator() -> bool:
    return any(Path(place, "translate", "__main__.py").is_file() for place in _places("fast_downward"))


def _places(package: str) -> list[str]:
    """The folders of a package, which is not imported."""
    found = find_spec(package)
    return [] if found is None else list(found.submodule_search_locations or ())


@dataclass(frozen=True, slots=True)
class Found(Outcome):
    """Its answer; ``seconds`` are of its search process, ``read_seconds`` of the translator.

    Attributes:
        search_seconds: its search time, which leaves out what is built before.
    """

    search_seconds: float = 0.0


def run(files: ClassicalFiles, search: Search, time_limit: float | None, *, invariants: bool = True) -> Found:
    """A planner's answer to a problem.

    Args:
        files: the problem.
        search: which, and its configuration, such as :data:`LMCUT`.
        time_limit: seconds for translating, and as many again for the search.
        invariants: whether to look for them: on ground files that takes seconds, and finds none.

    Raises:
        SerendipityError: it fails, with what it says.
    """
    found_at = program(search)
    assert found_at is not None, "absent() was asked before"
    before, start = children_seconds(), time.perf_counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "domain.pddl").write_text(files.domain, encoding="utf-8")
        (folder / "problem.pddl").write_text(files.problem, encoding="utf-8")
        translator = [sys.executable, *_TRANSLATE, *(() if invariants else _NO_INVARIANTS)]
        code, text = _process(translator, folder, time_limit)
        status = _status(code, "the translator", text)
        translated = time.perf_counter()
        found = Found(status)
        if status == "optimal":
            code, text = _process([str(found_at), "--search", search.words], folder, time_limit, _SAS)
            status = _status(code, "the search", text)
            found = _read(status, text, files.scale, time.perf_counter() - translated)
    return replace(found, read_seconds=translated - start, process_seconds=children_seconds() - before)


def _status(code: int | None, who: str, text: str) -> str:
    if code is None:
        return "unknown"
    if code == _UNSOLVABLE[who]:
        return "infeasible"
    if code != 0:
        raise _failed(who, text)
    return "optimal"


def _failed(who: str, text: str) -> SerendipityError:
    return SerendipityError(f"fast-downward: {who} failed: {' '.join(text.splitlines()[-4:])}")


def _read(status: str, text: str, scale: int, seconds: float) -> Found:
    """Answer of the search, from its output.

    Raises:
        SerendipityError: something is missing in it.
    """

    def last(pattern: str) -> float | None:
        found = re.findall(pattern, text, re.MULTILINE)
        return float(found[-1]) if found else None

    def printed(pattern: str) -> float:
        found = last(pattern)
        if found is None:
            raise _failed("the search", text)
        return found

    memory, bound = last(r"Peak memory: (\d+) KB"), last(r"(?:f = |BOUND: )(\d+)")
    found = Found(
        status,
        lower_bound=None if bound is None or status == "infeasible" else bound / scale,
        expanded=int(last(r"(\d+) expanded$") or 0),
        seconds=seconds,
        search_seconds=seconds,
        memory=None if memory is None else memory / 1024,
    )
    if status == "unknown":
        return found
    cost = printed(r"Plan cost: (\d+)") / scale if status == "optimal" else None
    total = printed(r"Total time: ([0-9.e-]+)s")
    return replace(
        found,
        cost=cost,
        lower_bound=cost,
        expanded=int(last(r"Expanded (\d+) state") or 0),
        search_seconds=printed(r"Search time: ([0-9.e-]+)s"),
        seconds=total,
        plan_seconds=None if cost is None else total,
    )


def _process(
    command: list[str], folder: Path, time_limit: float | None, stdin: str | None = None
) -> tuple[int | None, str]:
    """Exit code, None if it had to end, and output of a process."""
    with (Path("/dev/null") if stdin is None else folder / stdin).open("rb") as source:
        process = subprocess.Popen(
            command, cwd=folder, stdin=source, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
    with process:
        try:
            text, _ = process.communicate(timeout=time_limit)
            return process.returncode, text
        except subprocess.TimeoutExpired:
            process.terminate()  # it then says what it knows
            with suppress(subprocess.TimeoutExpired):
                return None, process.communicate(timeout=_LEAVING)[0]
            return None, ""
        finally:
            process.kill()
