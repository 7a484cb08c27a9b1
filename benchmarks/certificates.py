"""Time of a certificate, and what is proved: on folders of tasks, buildings of any size, suites of domains.

    python -m benchmarks.certificates [FOLDER] [--human H] [--buildings 84x3,84x3x2,210x6] [--seeds 5]
        [--suite FOLDER] [--domains NAME,...] [--stride N] [--limit N] [--modes NAME,...] [--discounts D,...]
        [--plan-limit SECONDS] [--time-limit SECONDS] [--encoding automata] [--solver highs] [--method auto]
        [--methods=-NAME,...] [--proofs] [--apart] [--only WORD] [--record FILE]

A building is named by its rooms, medkits and robots.  Each task is read, planned, read again and verified.
What a limit left unplanned is left out.  ``seconds`` are from the second reading to the verdict, of
processor time, the solver's included, which other work on the machine leaves as it is; ``by the clock`` is
the certificate alone; ``decided by`` is the method of the claim that took longest (a program without calls:
pruning).  With ``--apart`` all is done in processes of their own, whose memory is told.

``--methods`` leaves methods out, or all but some (``verify.calls.methods``): what each is good for.

With ``--proofs`` a proof is written: ``write`` is all of ``verify --proof``, reading included;
``check`` is the checker alone, from the file to its verdict, as in a process that has started; and
``compare`` is ``check-proof`` with task and result, which reads the task and makes the programs again.

With ``--record`` answers and what comes of them are written down, and a later run with the same file goes
on where the first one stopped.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Annotated, Any

import typer

import serendipity
from benchmarks.problems import building
from serendipity import Result, SerendipityError, Task
from serendipity.evaluation.benchmark.coverage.rows import MODES
from serendipity.evaluation.measuring.figures import children_memory, peak_memory, percentile, timed
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import apart, measured
from serendipity.evaluation.measuring.suites import Problem, Roles, folders, may_alone, problems, roles
from serendipity.evaluation.measuring.tables import as_markdown, grouped, spreads, table
from serendipity.model.telling import Line
from verify.certificate.certify import certify
from verify.proofs import checker

FIGURES = ("write", "KiB", "check", "compare", "columns", "rows", "leaves")

Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Asked:
    """A planning call: a task of a group, by what makes it, and options.

    Attributes:
        source: a folder and the human; rooms, medkits, robots and seed; or files, human and robots.
    """

    group: str
    source: tuple[Any, ...]
    mode: str
    discount: str
    limit: float | None

    def load(self) -> Task:
        """The task."""
        if isinstance(self.source[0], int):
            return building(*self.source)
        if len(self.source) == 2:
            return serendipity.load(self.source[0], human=self.source[1])
        domain, problem, human, *robots = self.source
        return serendipity.load_pddl(domain, problem, human, robots)


@dataclass(frozen=True, slots=True)
class Job:
    """A certificate to be made: of which answer, and how."""

    asked: Asked
    how: tuple[tuple[str, Any], ...]
    proofs: bool


def main(
    folder: Annotated[Path | None, typer.Argument()] = None,
    human: str | None = None,
    buildings: str = "",
    seeds: int = 5,
    suite: Path | None = None,
    domains: str = "",
    stride: int = 1,
    limit: int | None = None,
    modes: str = "serendipity,communication",
    discounts: str = "0,0.5,0.9",
    plan_limit: float | None = None,
    time_limit: float | None = None,
    encoding: str = "automata",
    solver: str = "highs",
    method: str = "auto",
    methods: str = "",
    proofs: bool = False,
    separate: Annotated[bool, typer.Option("--apart")] = False,
    only: str = "",
    record: Path | None = None,
) -> None:
    """Plan, verify, print a table."""
    sources = (
        [(place.parent.name, (str(place), human)) for place in folders(folder, stride, limit)]
        if folder
        else []
    )
    sources += _buildings(buildings, seeds)
    sources += _problems(suite, domains, stride) if suite else []
    how = {"encoding": encoding, "solver": solver, "method": method, "time_limit": time_limit}
    how |= {"methods": tuple(methods.split(","))} if methods else {}
    asked = [
        Asked(group, source, mode, discount, plan_limit)
        for (group, source), mode, discount in product(sources, modes.split(","), discounts.split(","))
    ]
    rows, kept = [], Record(record)
    for each in (each for each in asked if only in repr(each)):
        answer = _once(kept, each, planned, separate)
        if answer["status"] in ("optimal", "infeasible"):
            job = Job(each, tuple(how.items()), proofs)
            row = _once(kept, job, partial(verified, answer=answer), separate)
            rows.append({"group": each.group, "mode": each.mode, "discount": each.discount, **row})
            if not proofs and row["verdict"] != "proved":
                print(
                    f"{each.source} {each.mode} {each.discount}: {row['verdict']}: {row['reason']}",
                    flush=True,
                )
    print(as_markdown(_proofs(rows) if proofs else [_certificates(rows)]), end="")


def _once(record: Record, job: Any, work: Callable[[Any], Any], separate: bool) -> Any:
    """Result of a job, in a process of its own where that is asked for."""
    ((_, found),) = measured([job], partial(apart, work) if separate else work, record)
    return found


def _buildings(names: str, seeds: int) -> Iterator[tuple[str, tuple[Any, ...]]]:
    for name in filter(None, names.split(",")):
        size = (*map(int, name.split("x")), 1)[:3]
        yield from ((name, (*size, seed)) for seed in range(1, seeds + 1))


def _problems(suite: Path, domains: str, stride: int) -> Iterator[tuple[str, tuple[Any, ...]]]:
    for problem in problems(suite, [name for name in domains.split(",") if name], stride):
        who = apart(_roles, problem)
        yield problem.domain, (str(problem.domain_file), str(problem.problem_file), who.human, *who.robots)


def _roles(problem: Problem) -> Roles:
    return roles(problem, 2, may_alone)


def planned(asked: Asked) -> dict[str, Any]:
    """An answer, as JSON has it."""
    options = {**MODES[asked.mode], "discount": asked.discount, "time_limit": asked.limit}
    try:
        return serendipity.plan(asked.load(), **options).to_dict()
    except SerendipityError as error:
        return {"status": f"refused: {error}"}


def verified(job: Job, answer: dict[str, Any]) -> dict[str, Any]:
    """Verdict and figures of a certificate."""
    result, how = Result.from_dict(answer), dict(job.how)
    if job.proofs:
        return _proof(job.asked.load, result, how["time_limit"])

    def work() -> tuple[Any, float]:
        task = job.asked.load()
        started = perf_counter()
        return certify(task, result, **how), perf_counter() - started

    (certificate, clock), seconds = timed(work)
    unproved = [claim for claim in certificate.claims if claim.verdict != "proved"]
    return {
        "verdict": certificate.verdict,
        "reason": f"{unproved[0].claim}: {unproved[0].reason}" if unproved else "",
        "seconds": seconds,
        "clock": clock,
        "memory": peak_memory() + children_memory(),
        "method": max(certificate.claims, key=lambda claim: claim.seconds).method or "rules",
        "calls": certificate.solver_calls,
        "columns": certificate.size.get("variables", 0),
        "rows": certificate.size.get("constraints", 0),
    }


def _proof(load: Callable[[], Task], result: Result, limit: float | None) -> dict[str, Any]:
    with TemporaryDirectory() as scratch:
        file = Path(scratch, "proof.json.gz")
        _, write = timed(lambda: serendipity.verify(load(), result, proof=file, time_limit=limit))
        if not file.exists():
            return {}
        programs, check = timed(lambda: checker.check(checker.read(file)))
        found, compare = timed(lambda: serendipity.check_proof(file, load(), result))
        figures = (write, file.stat().st_size / 1024, check, compare)
    columns, rows = (max(getattr(each, name) for each in programs) for name in ("columns", "rows"))
    sizes = (columns, rows, sum(each.leaves for each in programs))
    return {"accepted": found.verdict == "accepted", **dict(zip(FIGURES, (*figures, *sizes), strict=True))}


def _certificates(rows: Sequence[Row]) -> Any:
    def verdicts(of: Sequence[Row], verdict: str) -> int:
        return sum(row["verdict"] == verdict for row in of)

    def middle(of: Sequence[Row], name: str) -> str:
        return f"{median(row[name] for row in of):.0f}"

    groups = grouped(rows, lambda row: (row["group"], row["mode"], row["discount"]))
    groups |= {("all", mode, ""): of for mode, of in grouped(rows, lambda row: row["mode"]).items()}
    return table(
        ("group", "mode", "discount"),
        groups | {("all", "", ""): [*rows]},
        {
            "certificates": len,
            **{name: partial(verdicts, verdict=name) for name in ("proved", "undecided", "refuted")},
            "seconds: median": lambda of: f"{median(row['seconds'] for row in of):.3f}",
            "95 %": lambda of: f"{percentile([row['seconds'] for row in of], 0.95):.3f}",
            "longest": lambda of: f"{max(row['seconds'] for row in of):.3f}",
            "by the clock: median": lambda of: f"{median(row['clock'] for row in of):.3f}",
            "most": lambda of: f"{max(row['clock'] for row in of):.3f}",
            "MiB": lambda of: f"{max(row['memory'] for row in of):.0f}",
            "decided by": lambda of: ", ".join(grouped(of, lambda row: row["method"])),
            "calls": lambda of: sum(row["calls"] for row in of),
            **{name: partial(middle, name=name) for name in ("columns", "rows")},
        },
    )


def _proofs(rows: Sequence[Row]) -> list[Any]:
    parts: list[Any] = []
    for mode, of in [*grouped(rows, lambda row: row["mode"]).items(), ("all", rows)]:
        files = [row for row in of if "accepted" in row]
        accepted = sum(row["accepted"] for row in files)
        figures = {name: lambda row, name=name: float(row[name]) for name in FIGURES}
        parts.append(Line(f"{mode}: {len(of)} certificates, {len(files)} files, {accepted} accepted"))
        parts.append(spreads(files, figures))
    return parts


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
