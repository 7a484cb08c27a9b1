"""CBC: a program as an MPS file, a process, and the file with its solution.

The binary is the one that PuLP ships.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from serendipity.model import Deadline
from verify.solvers.model import Model, SolverAnswer
from verify.solvers.process import run, seconds_for

_SENSES: Final = {"<=": "L", ">=": "G", "==": "E"}
_STATUS: Final = {
    ("Optimal",): "optimal",
    ("Infeasible",): "infeasible",
    ("Integer", "infeasible"): "infeasible",
    ("Stopped", "on", "time"): "time-limit",
}
_OPTIONS: Final = ("-timeMode", "elapsed", "-ratio", "0", "-allow", "0.5", "-threads", "1", "-solve")
"""The objective is integral, so that a gap below one half is none; the seed is fixed unless one is given."""


def minimise(model: Model, deadline: Deadline) -> SolverAnswer:
    """Minimise with one thread."""
    with TemporaryDirectory() as folder:
        program, solution = Path(folder, "program.mps"), Path(folder, "solution.txt")
        with program.open("w", encoding="ascii") as file:
            file.writelines(_mps(model, deadline))
        seconds = seconds_for(deadline)
        limit = [] if seconds is None else ["-sec", f"{seconds:.3f}"]
        command = [_binary(), str(program), *limit, *_OPTIONS, "-printingOptions", "all", "-solution"]
        code = run([*command, str(solution)], deadline)
        if code or not solution.exists():
            return SolverAnswer(f"CBC ended with exit status {code}")
        with solution.open(encoding="ascii") as lines:
            return _read(deadline.each(lines), len(model.upper))


def _binary() -> str:
    """The CBC that PuLP 3 ships; ``PULP_CBC_CMD`` itself is deprecated."""
    import pulp

    return str(pulp.PULP_CBC_CMD.pulp_cbc_path)


def _mps(model: Model, deadline: Deadline) -> Iterator[str]:
    """The program, field by field where MPS wants them.

    Every column is in the objective, with 0 if need be: CBC would forget those that are nowhere.
    """
    yield "NAME          m\nROWS\n N  GOAL\n"
    for number, (sense, _) in enumerate(deadline.each(model.heads)):
        yield f" {_SENSES[sense]}  R{number:07}\n"
    entries: list[list[str]] = [[] for _ in model.upper]
    for number, row in enumerate(deadline.each(model.rows)):
        for x, coefficient in row.terms.items():
            entries[x].append(f"    X{x:07}  R{number:07}  {coefficient}\n")
    yield "COLUMNS\n"
    for x, whole in enumerate(deadline.each(model.integral)):
        yield f"    MARK      'MARKER'                 '{'INTORG' if whole else 'INTEND'}'\n"
        yield f"    X{x:07}  GOAL      {model.objective.get(x, 0)}\n"
        yield from entries[x]
    yield "RHS\n"
    for number, (_, right) in enumerate(deadline.each(model.heads)):
        yield f"    RHS       R{number:07}  {right}\n"
    yield "BOUNDS\n"
    for x, (lower, upper) in enumerate(zip(model.lower, deadline.each(model.upper), strict=True)):
        yield f" LO BND       X{x:07}  {lower}\n UP BND       X{x:07}  {upper}\n"
    yield "ENDATA\n"


def _read(lines: Iterable[str], columns: int) -> SolverAnswer:
    """A limit that leaves a solution says its objective at once: ``Stopped on time - objective value 5``."""
    rows = iter(lines)
    said = next(rows, "").split()
    status = next((s for words, s in _STATUS.items() if tuple(said[: len(words)]) == words), "CBC: no answer")
    if status == "infeasible" or (status != "optimal" and said[3:5] != ["-", "objective"]):
        return SolverAnswer(status)
    values = [0.0] * columns
    for row in rows:
        name, value = row.replace("**", "").split()[1:3]
        if name.startswith("X"):
            values[int(name[1:])] = float(value)
    return SolverAnswer(status, values)
