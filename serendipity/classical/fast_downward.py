"""Fast Downward, SymK and Scorpion, planners for a single agent, as processes: translator and search.

They are never imported, for they are under the GPL.  The optional extra ``bench`` has all but Scorpion: the
translator of ``fast-downward.translate``, the programs of ``up-fast-downward`` and ``up-symk``.
"""

import os
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

from serendipity.model.errors import LIMITS, SerendipityError, UsageError
from serendipity.model.resources.deadline import Deadline
from serendipity.pddl.classical import ClassicalFiles


class Search(NamedTuple):
    """A program's configuration.

    Attributes:
        name: of the program.
        words: as the program is given it; ``{0}`` and so on are ``shares`` of the time limit, in seconds.
        package: the wheel that has the program; none where ``place`` is all there is to say.
        place: of the program in it.
        shares: of the time limit.
    """

    name: str
    words: str
    package: str = "up-fast-downward"
    place: str = "downward/builds/release/bin/downward"
    shares: tuple[float, ...] = ()


LMCUT: Final = Search("fast-downward", "astar(lmcut())")
"""A* with landmark cuts."""
IPDB: Final = Search("fast-downward", "astar(ipdb())")
"""A* with the pattern databases that hill climbing chooses."""
SYMK: Final = Search("symk", "sym_bd()", "up-symk", "symk/builds/release/bin/downward")
"""Symbolic search from both ends, by decision diagrams."""
ANY_PLAN: Final = Search("fast-downward", "lazy_greedy([ff()], preferred=[ff()])")
"""Some plan, soon."""

_SCORPION: Final = (
    "astar(scp([projections(hillclimbing(max_time={0:g}, random_seed=0)), projections(systematic(2)), "
    "cartesian()], max_orders=infinity, max_time={1:g}, max_optimization_time={2:g}, diversify=true, "
    "orders=greedy_orders(random_seed=0), random_seed=0), pruning=limited_pruning("
    "pruning=atom_centric_stubborn_sets(), min_required_pruning_ratio=0.2))"
)
_COMPETITION: Final = 1800.0
"""Seconds that the International Planning Competition of 2018 gave."""

_SAS: Final = "output.sas"
_PLAN: Final = "sas_plan"
_TRANSLATE: Final = ("-m", "fast_downward.translate", "domain.pddl", "problem.pddl", "--sas-file", _SAS)
_NO_INVARIANTS: Final = ("--invariant-generation-max-time", "0")
_UNSOLVABLE: Final = {"the translator": 10, "the search": 11}
"""Exit codes that are proofs (``driver/returncodes.py`` of Fast Downward)."""
_EXPLORED: Final = 12, re.compile(r"Completely explored state space|BOUND: 2147483647 < 2147483647 \[0/")
"""What later versions, and SymK, say instead: a proof as well, since all heuristics here are safe."""

_LEAVING: Final = 5.0
"""Seconds for saying what it knows, once it has to end."""

_LOOK: Final = 0.05
"""Seconds between two looks at the deadline."""


def scorpion(path: Path) -> Search:
    """Saturated cost partitioning over diverse orders of abstractions (Seipp, Keller and Helmert 2020), as in
    the competition of 2018: the 100, 200 and 2 of its 1,800 seconds are shares of the time limit here.

    Args:
        path: ``builds/release/bin/downward`` of Scorpion, which its users build.

    Raises:
        UsageError: there is no program.
    """
    if not (path.is_file() and os.access(path, os.X_OK)):
        raise UsageError(f"scorpion: {path} is no program")
    shares = (100 / _COMPETITION, 200 / _COMPETITION, 2 / _COMPETITION)
    return Search("scorpion", _SCORPION, "", str(path.resolve()), shares)


def absent(search: Search = LMCUT, *, translates: bool = True) -> str | None:
    """Why it can't be run, or None.

    Args:
        translates: whether the translator is needed, too.
    """
    parts = {"fast-downward.translate": not translates or _has_translator(), search.package: program(search)}
    missing = " and no ".join(name for name, found in parts.items() if not found)
    hint = "here: pip install serendipity-planner[bench]"
    return f"{search.name} is left out: no {missing} {hint}" if missing else None


@cache
def program(search: Search) -> Path | None:
    """The program, where it is installed."""
    packages = _places(search.package.replace("-", "_")) if search.package else ("",)
    return next(filter(Path.is_file, (Path(place, search.place) for place in packages)), None)


@cache
def _has_translator() -> bool:
    return any(Path(place, "translate", "__main__.py").is_file() for place in _places("fast_downward"))


def _places(package: str) -> list[str]:
    """The folders of a package, which is not imported."""
    found = find_spec(package)
    return [] if found is None else list(found.submodule_search_locations or ())


@dataclass(frozen=True, slots=True)
class Found:
    """An answer of such a planner.

    Attributes:
        status: ``optimal``, ``infeasible``, or ``unknown`` where a limit came first.
        cost: of its plan, in the unit of the files' scale; None without one.
        lower_bound: no plan costs less; None where nothing is known.
        expanded: nodes.
        seconds: of the search process, ``read_seconds`` of the translator, by the clock.
        search_seconds: its search time, which leaves out what is built before.
        memory: its peak in MiB, where that is known.
        plan: the names of its operators, one after another; None without one.
    """

    status: str
    cost: float | None = None
    lower_bound: float | None = None
    expanded: int = 0
    seconds: float = 0.0
    search_seconds: float = 0.0
    read_seconds: float = 0.0
    memory: float | None = None
    plan: tuple[str, ...] | None = None


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
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "domain.pddl").write_text(files.domain, encoding="utf-8")
        (folder / "problem.pddl").write_text(files.problem, encoding="utf-8")
        translator = [sys.executable, *_TRANSLATE, *(() if invariants else _NO_INVARIANTS)]
        code, text = _process(translator, folder, Deadline(time_limit))
        status = _status(code, "the translator", text, search)
        translated = time.perf_counter()
        found = Found(status)
        if status == "optimal":
            found = _searched(folder, search, files.scale, Deadline(time_limit))
    return replace(found, read_seconds=translated - start)


def run_translated(text: str, search: Search, deadline: Deadline) -> Found:
    """A planner's answer to a problem in SAS+; costs are as they stand there.

    Args:
        text: what the translator writes.
        search: which planner, and its configuration.
        deadline: the process's memory counts, too.

    Raises:
        SerendipityError: it fails, with what it says.
    """
    with tempfile.TemporaryDirectory() as scratch:
        Path(scratch, _SAS).write_text(text, encoding="utf-8")
        return _searched(Path(scratch), search, 1, deadline)


def _searched(folder: Path, search: Search, scale: int, deadline: Deadline) -> Found:
    found_at = program(search)
    assert found_at is not None, "absent() was asked before"
    left, start = deadline.left(), time.perf_counter()
    words = search.words.format(
        *(share * (_COMPETITION if left is None else left) for share in search.shares)
    )
    code, text = _process([str(found_at), "--search", words], folder, deadline, _SAS)
    status = _status(code, "the search", text, search)
    found = _read(status, text, scale, time.perf_counter() - start, search)
    plan = folder / _PLAN
    if status != "optimal" or not plan.is_file():
        return found
    lines = (line.strip() for line in plan.read_text(encoding="utf-8").splitlines())
    return replace(found, plan=tuple(line.strip("( )") for line in lines if line.startswith("(")))


def _status(code: int | None, who: str, text: str, search: Search) -> str:
    if code is None:
        return "unknown"
    if code == _UNSOLVABLE[who] or (code == _EXPLORED[0] and _EXPLORED[1].search(text)):
        return "infeasible"
    if code != 0:
        raise _failed(search, who, text)
    return "optimal"


def _failed(search: Search, who: str, text: str) -> SerendipityError:
    return SerendipityError(
        f"{search.name}: {who} failed: {' '.join(text.splitlines()[-4:]) or 'it says nothing'}"
    )


def _read(status: str, text: str, scale: int, seconds: float, search: Search) -> Found:
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
            raise _failed(search, "the search", text)
        return found

    memory, bound = last(r"Peak memory: (\d+) KB"), last(r"(?:f = |BOUND: )(?!2147483647)(\d+)")
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
    return replace(
        found,
        cost=cost,
        lower_bound=cost,
        expanded=int(last(r"Expanded (\d+) state") or 0),
        search_seconds=printed(r"Search time: ([0-9.e-]+)s"),
        seconds=printed(r"Total time: ([0-9.e-]+)s"),
    )


def _process(
    command: list[str], folder: Path, deadline: Deadline, stdin: str | None = None
) -> tuple[int | None, str]:
    """Exit code, None if it had to end, and output of a process.

    Raises:
        SerendipityError: it can't be started.
    """
    with (Path("/dev/null") if stdin is None else folder / stdin).open("rb") as source:
        try:
            process = subprocess.Popen(
                command, cwd=folder, stdin=source, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
            )
        except OSError as error:
            raise SerendipityError(f"{command[0]} can't be run: {error.strerror}") from error
    with process:
        try:
            text = _output(process, deadline)
            return process.returncode, text
        except LIMITS:
            process.terminate()  # it then says what it knows
            with suppress(subprocess.TimeoutExpired):
                return None, process.communicate(timeout=_LEAVING)[0]
            return None, ""
        finally:
            process.kill()


def _output(process: "subprocess.Popen[str]", deadline: Deadline) -> str:
    while True:
        left = deadline.left()
        try:
            return process.communicate(timeout=_LOOK if left is None else min(left, _LOOK))[0]
        except subprocess.TimeoutExpired:
            deadline.check_child(process.pid)
