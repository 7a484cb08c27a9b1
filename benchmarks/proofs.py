"""What is proved of answers on tasks of any size, and how soon: buildings, and suites of domains.

    python -m benchmarks.proofs ANSWERS [--buildings 84x3,84x3x2,210x6] [--seeds 5] [--suite FOLDER]
        [--stride N] [--domains NAME,...] [--modes NAME,...] [--discount D] [--plan-limit SECONDS]
        [--time-limit SECONDS] [--method NAME] [--only WORD] [--plan-only] [--again] [--csv FILE]

A building is named by its rooms, medkits and robots.  Each task is planned in each mode; answers stand
in the folder ANSWERS, and a later run with the same folder plans only what is missing.  Then each
answer that was proved by the search is read and verified in a process of its own, which gives seconds
by the clock for reading and for the certificate, and the most memory that it had.  What comes of it
stands in ANSWERS at once, so that a run that was ended goes on where it was; ``--again`` verifies anew.
The last line says how many of the answers are proved.
"""

import argparse
import csv
import json
import resource
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, fields, replace
from multiprocessing import get_context
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any, Final

import serendipity
from benchmarks.alone import may_alone
from serendipity import Result, Task
from serendipity.evaluation.benchmark.coverage import MODES, Problem, Roles, problems
from serendipity.evaluation.benchmark.coverage.suite import roles
from serendipity.model.errors import SerendipityError

_BUILDINGS: Final = "84x3,84x3x2,84x3x3,210x6,840x2,2100x10"
_SETTLED: Final = ("optimal", "infeasible")


@dataclass(frozen=True, slots=True)
class Asked:
    """A task, by what makes it, and a mode.

    Attributes:
        group: what it is counted with: a building's name, or a domain.
        task: its name within the group.
        mode: one of ``coverage.MODES``.
        source: of a building rooms, medkits, robots and seed; of a problem its files, human and robots.
    """

    group: str
    task: str
    mode: str
    source: tuple[Any, ...]

    @property
    def name(self) -> str:
        """A name for files."""
        return f"{self.group}-{self.task}-{self.mode}"

    def load(self, folder: Path) -> Task:
        """Read the task, a building's files being written to ``folder`` first if they are not there."""
        if isinstance(self.source[0], int):
            rooms, medkits, robots, seed = self.source
            place = folder / f"building-{self.group}-{self.task}"
            if not place.exists():
                serendipity.generate_usar(place, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
            return serendipity.load(place)
        domain, problem, human, *robots = self.source
        return serendipity.load_pddl(domain, problem, human, robots)


@dataclass(frozen=True, slots=True)
class Row:
    """What came of one answer; times in seconds, memory in MiB."""

    group: str
    task: str
    mode: str
    status: str
    objective: str
    plan_seconds: float
    verdict: str = ""
    method: str = ""
    seconds: float = 0.0
    load_seconds: float = 0.0
    memory: float = 0.0
    reason: str = ""


def main() -> None:
    """Plan, verify, print a line for each answer and a table."""
    arguments = _arguments()
    arguments.answers.mkdir(parents=True, exist_ok=True)
    rows = []
    for asked in _all_asked(arguments):
        if arguments.only not in asked.name:
            continue
        row = _measured(asked, arguments)
        rows.append(row)
        if row.status in _SETTLED or arguments.verbose:
            print(
                f"{row.group:<14}{row.task:<18}{row.mode:<15}{row.status:<11}{row.plan_seconds:>7.2f}  "
                f"{row.verdict:<10}{row.seconds:>7.2f}{row.load_seconds:>7.2f}{row.memory:>7.0f}  "
                f"{row.method} {'' if row.verdict == 'proved' else row.reason}",
                flush=True,
            )
    _table(rows)
    if arguments.csv:
        _write(arguments.csv, rows)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("answers", type=Path, help="folder with answers, made where it is absent")
    parser.add_argument("--buildings", default=_BUILDINGS, help="rooms x medkits (x robots)")
    parser.add_argument("--seeds", type=int, default=5, help="of each building")
    parser.add_argument("--suite", type=Path, default=None, help="folder of domains in MA-PDDL")
    parser.add_argument("--domains", default="", help="of the suite; all without it")
    parser.add_argument("--stride", type=int, default=1, help="every N-th problem of a domain")
    parser.add_argument("--modes", default="", help="some of " + ", ".join(MODES))
    parser.add_argument("--discount", default="0.9")
    parser.add_argument("--plan-limit", type=float, default=20.0, help="seconds for a plan")
    parser.add_argument("--time-limit", type=float, default=30.0, help="seconds for a certificate")
    parser.add_argument("--method", default=None, help="of verify")
    parser.add_argument("--only", default="", help="answers with this word in their name")
    parser.add_argument("--plan-only", action="store_true", help="make answers, verify none")
    parser.add_argument("--again", action="store_true", help="verify what was verified before")
    parser.add_argument("--verbose", action="store_true", help="also what the search did not settle")
    parser.add_argument("--csv", type=Path, default=None, help="rows go here")
    return parser.parse_args()


def _all_asked(arguments: argparse.Namespace) -> Iterator[Asked]:
    chosen = [name for name in arguments.modes.split(",") if name]
    for name in filter(None, arguments.buildings.split(",")):
        rooms, medkits, robots = (*map(int, name.split("x")), 1)[:3]
        for seed in range(1, arguments.seeds + 1):
            for mode in chosen or ("serendipity", "serendipity-k0", "communication"):
                yield Asked(name, f"seed{seed}", mode, (rooms, medkits, robots, seed))
    if arguments.suite is not None:
        domains = [name for name in arguments.domains.split(",") if name]
        for problem in problems(arguments.suite, domains, arguments.stride):
            who = _apart(_roles, problem)
            source = (str(problem.domain_file), str(problem.problem_file), who.human, *who.robots)
            for mode in chosen or MODES:
                yield Asked(problem.domain, problem.name, mode, source)


def _roles(problem: Problem) -> Roles:
    return roles(problem, 2, may_alone)


def _measured(asked: Asked, arguments: argparse.Namespace) -> Row:
    file = arguments.answers / f"{asked.name}-{arguments.discount}.json"
    if not file.exists():
        file.write_text(json.dumps({**_apart(_planned, asked, arguments), "source": asked.source}))
    answer = json.loads(file.read_text())
    result = answer["result"]
    asked = replace(asked, source=tuple(answer.get("source", asked.source)))
    row = {
        "group": asked.group,
        "task": asked.task,
        "mode": asked.mode,
        "status": result["status"],
        "objective": str(result.get("objective", "")),
        "plan_seconds": answer["seconds"],
    }
    if row["status"] not in _SETTLED or arguments.plan_only:
        return Row(**row)
    return Row(**row, **_verdict(asked, result, arguments))


def _verdict(asked: Asked, result: dict[str, Any], arguments: argparse.Namespace) -> dict[str, Any]:
    """What came of verifying an answer under these settings, now or in an earlier run."""
    settings = {"time_limit": arguments.time_limit, "method": arguments.method}
    file = arguments.answers / f"{asked.name}-{arguments.discount}.verdict.json"
    known = json.loads(file.read_text()) if file.exists() and not arguments.again else {}
    if known.get("settings") != settings or known.get("result") != result:
        found = _apart(_verified, asked, result, arguments)
        known = {"settings": settings, "result": result, "found": found}
        file.write_text(json.dumps(known))
    return dict(known["found"])


def _planned(asked: Asked, arguments: argparse.Namespace) -> dict[str, Any]:
    try:
        task = asked.load(arguments.answers)
        started = perf_counter()
        options = {**MODES[asked.mode], "discount": arguments.discount}
        result = serendipity.plan(task, time_limit=arguments.plan_limit, **options)
    except SerendipityError as error:
        return {"result": {"status": f"refused: {error}"}, "seconds": 0.0}
    return {"result": result.to_dict(), "seconds": perf_counter() - started}


def _verified(asked: Asked, data: dict[str, Any], arguments: argparse.Namespace) -> dict[str, Any]:
    import verify.certificate.certify  # noqa: F401 - loading the solvers is not what is measured

    result = Result.from_dict(data)
    started = perf_counter()
    task = asked.load(arguments.answers)
    loaded = perf_counter()
    method = {} if arguments.method is None else {"method": arguments.method}
    certificate = serendipity.verify(task, result, time_limit=arguments.time_limit, **method)
    seconds = perf_counter() - loaded
    open_claims = [claim for claim in certificate.claims if claim.verdict != "proved"]
    slowest = max(certificate.claims, key=lambda claim: claim.seconds)
    told = open_claims[0] if open_claims else slowest
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss + _children()
    return {
        "verdict": certificate.verdict,
        "method": str(getattr(slowest, "method", "") or ""),
        "seconds": seconds,
        "load_seconds": loaded - started,
        "memory": memory / (2**20 if sys.platform == "darwin" else 1024),
        "reason": f"{told.claim}: {told.reason}",
    }


def _children() -> int:
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss


def _apart(work: Callable[..., Any], *arguments: Any) -> Any:
    """Do something in a process of its own, whose memory is its own."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as apart:
        return apart.submit(work, *arguments).result()


def _table(rows: list[Row]) -> None:
    print(f"\n{'':<16}{'mode':<15}{'settled':>8}{'proved':>8}{'refuted':>9}{'p50':>8}{'max':>8}{'MiB':>7}")
    for group, mode in dict.fromkeys((row.group, row.mode) for row in rows):
        settled = [r for r in rows if (r.group, r.mode) == (group, mode) and r.status in _SETTLED]
        if settled:
            print(f"{group:<16}{mode:<15}{_summary(settled)}")
    settled = [row for row in rows if row.status in _SETTLED]
    if settled:
        print(f"{'all':<31}{_summary(settled)}")
        print(_said(settled))


def _said(rows: list[Row]) -> str:
    """How many answers are proved, in a line."""
    verdicts = [row.verdict for row in rows]
    proved, refuted = verdicts.count("proved"), verdicts.count("refuted")
    rest = len(rows) - proved - refuted
    share = 100 * proved / len(rows)
    return f"proved {proved} of {len(rows)} ({share:.1f} %), undecided {rest}, refuted {refuted}"


def _summary(rows: list[Row]) -> str:
    verdicts = [row.verdict for row in rows]
    times = [row.seconds for row in rows]
    return (
        f"{len(rows):>8}{verdicts.count('proved'):>8}{verdicts.count('refuted'):>9}"
        f"{median(times):>8.2f}{max(times):>8.2f}{max(row.memory for row in rows):>7.0f}"
    )


def _write(path: Path, rows: list[Row]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)


if __name__ == "__main__":
    main()
