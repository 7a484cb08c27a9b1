"""Time of a certificate, and what is proved: on folders of tasks, buildings of any size, suites of domains.

    python -m benchmarks.certificates [FOLDER] [--buildings 84x3,84x3x2,210x6] [--suite FOLDER] [OPTIONS]

A building is named by its rooms, medkits and robots; there are five of each.  A task is read, planned, read
again and verified.  What a limit left unplanned is left out.  ``seconds`` are from the second reading to the
verdict, of processor time, the solver's included, which other work on the machine leaves as it is; ``by the
clock`` is the certificate alone; ``decided by`` is the method of the claim that took longest (a program
without calls: pruning).  With ``--apart`` all is done in processes of their own, whose memory is told;
``--methods`` leaves methods out, or all but some (``verify.calls.methods``): what each is good for.

With ``--proofs`` a proof is written: ``write`` is all of ``verify --proof``, reading included;
``check`` is the checker alone, from the file to its verdict, as in a process that has started; and
``compare`` is ``check-proof`` with task and result, which reads the task and makes the programs again;
``form`` is writing the same in the field's form, of which ``OPB`` are the problems and ``pbp`` the proofs of
version 2.0. With ``--veripb`` VeriPB checks each program's proof, of version 1.1 if it knows no other.
"""

import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Annotated, Any, Final, NamedTuple

import typer

import serendipity
from benchmarks.problems import Record, Source, load, of_suite, run
from serendipity import Result, SerendipityError
from serendipity.evaluation.benchmark.contenders import MODES
from serendipity.evaluation.measuring.figures import children_memory, peak_memory, percentile, timed
from serendipity.evaluation.measuring.record import apart, measured
from serendipity.evaluation.measuring.suites import folders, may_alone
from serendipity.evaluation.measuring.tables import Cell, Row, as_markdown, counted, grouped, spreads, table
from serendipity.model.telling import Grid, Line
from serendipity.writing.together import write_together
from serendipity.writing.veripb import in_the_fields_form
from verify.certificate.certify import certify
from verify.proofs import checker

FIGURES = ("write", "KiB", "check", "compare", "form", "OPB", "pbp", "columns", "rows", "leaves")
_DOUBTS: Final = ("did not claim", "unjustified", "NO CONCLUSION")  # beside exit code 0: nothing is shown


class Asked(NamedTuple):
    """A planning call about a task of a group."""

    group: str
    source: Source
    mode: str
    discount: str
    limit: float | None


@dataclass(frozen=True, slots=True)
class Job:
    """A certificate to be made: of which answer, and how."""

    asked: Asked
    how: tuple[tuple[str, Any], ...]
    proofs: bool
    veripb: str
    answer: Row = field(repr=False)


def main(
    folder: Annotated[Path | None, typer.Argument()] = None,
    human: str | None = None,
    buildings: str = "",
    suite: Path | None = None,
    stride: int = 1,
    modes: str = "serendipity,communication",
    discounts: str = "0,0.5,0.9",
    plan_limit: float | None = None,
    time_limit: float | None = None,
    encoding: str = "automata",
    solver: str = "highs",
    method: str = "auto",
    methods: str = "",
    proofs: bool = False,
    veripb: str = "",
    separate: Annotated[bool, typer.Option("--apart")] = False,
    record: Record = None,
) -> None:
    """Plan, verify, print a table."""
    how = {"encoding": encoding, "solver": solver, "method": method, "time_limit": time_limit}
    how |= {"methods": tuple(methods.split(","))} if methods else {}
    plan, verify = (partial(apart, work) if separate else work for work in (planned, verified))
    asked = calls(sources_of(folder, human, buildings, suite, stride), modes, discounts, plan_limit)
    jobs = (
        Job(each, tuple(how.items()), proofs, veripb, answer)
        for each, answer in measured(asked, plan, record)
        if answer["status"] in ("optimal", "infeasible")
    )
    rows = []
    for job, row in measured(jobs, verify, record):
        group, source, mode, discount, _ = job.asked
        rows.append({"group": group, "mode": mode, "discount": discount, **row})
        if not proofs and row["verdict"] != "proved":
            print(f"{source} {mode} {discount}: {row['verdict']}: {row['reason']}", flush=True)
    if not rows:
        raise SystemExit("nothing to verify: name a folder of tasks, --buildings or --suite that has answers")
    print(as_markdown(_proofs(rows) if proofs else [_certificates(rows)]), end="")


def calls(of: Iterable[tuple[str, Source]], modes: str, discounts: str, limit: float | None) -> list[Asked]:
    """A call in each of the modes and at each of the discounts, about each task with its group."""
    grid = product(of, modes.split(","), discounts.split(","))
    return [Asked(*task, mode, discount, limit) for task, mode, discount in grid]


def sources_of(
    folder: Path | None, human: str | None, buildings: str, suite: Path | None, stride: int
) -> Iterator[tuple[str, Source]]:
    """Tasks, each with its group."""
    for place in folders(folder, stride) if folder else ():
        yield place.parent.name, (str(place), human)
    for name, seed in product(filter(None, buildings.split(",")), range(1, 6)):
        yield name, (*(*map(int, name.split("x")), 1)[:3], seed)
    for problem, _, source in of_suite(suite, may_alone, stride=stride) if suite else ():
        yield problem.domain, source


def planned(asked: Asked) -> Row:
    """An answer, as JSON has it."""
    options = {**MODES[asked.mode], "discount": asked.discount, "time_limit": asked.limit}
    try:
        return serendipity.plan(load(asked.source), **options).to_dict()
    except SerendipityError as error:
        return {"status": f"refused: {error}"}


def verified(job: Job) -> Row:
    """Verdict and figures of a certificate."""
    result, how = Result.from_dict(dict(job.answer)), dict(job.how)
    if job.proofs:
        return _proof(job, result, how["time_limit"])

    def work() -> tuple[Any, float]:
        task = load(job.asked.source)
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


def _proof(job: Job, result: Result, limit: float | None) -> Row:
    source = job.asked.source
    with TemporaryDirectory() as scratch:
        file = Path(scratch, "proof.json.gz")
        _, write = timed(lambda: serendipity.verify(load(source), result, proof=file, time_limit=limit))
        if not file.exists():
            return {}
        programs, check = timed(lambda: checker.check(checker.read(file)))
        found, compare = timed(lambda: serendipity.check_proof(file, load(source), result))
        proof = checker.read(file)
        files, form = timed(lambda: in_the_fields_form(Path(scratch, "proof.pbp"), proof))
        write_together(files)
        outside = by_veripb(job.veripb, sorted(files)) if job.veripb else {}
        figures = (write, file.stat().st_size / 1024, check, compare, form)
    by_end = grouped(files, lambda path: "".join(path.suffixes))
    sizes = [sum(len(files[path]) for path in by_end[end]) / 1024 for end in (".opb", ".pbp")]
    columns, rows = (max(getattr(each, name) for each in programs) for name in ("columns", "rows"))
    figures += (*sizes, columns, rows, sum(each.leaves for each in programs))
    return {"accepted": found.verdict == "accepted", **dict(zip(FIGURES, figures, strict=True)), **outside}


def by_veripb(command: str, files: Sequence[Path]) -> Row:
    """What VeriPB says of the proofs of all programs, and how long it takes by the clock."""
    started, formulas = perf_counter(), [path for path in files if path.suffix == ".opb"]
    accepted = all(is_accepted_by_veripb(command, formula) for formula in formulas)
    return {"by VeriPB": accepted, "VeriPB": perf_counter() - started}


def is_accepted_by_veripb(command: str, formula: Path) -> bool:
    """Whether VeriPB accepts the proof of a version that it knows, and has no doubt about it."""
    for suffix in (".v1.pbp", ".pbp"):
        done = subprocess.run([command, formula, formula.with_suffix(suffix)], capture_output=True, text=True)
        told = done.stdout + done.stderr
        if "nsupported version" not in told:
            return done.returncode == 0 and not any(doubt in told for doubt in _DOUBTS)
    return False


def _certificates(rows: Sequence[Row]) -> Grid:
    def told(figure: Callable[[list[float]], float], name: str, digits: int = 3) -> Cell:
        return lambda of: f"{figure([row[name] for row in of]):.{digits}f}"

    groups = grouped(rows, lambda row: (row["group"], row["mode"], row["discount"]))
    groups |= {("all", mode, ""): of for mode, of in grouped(rows, lambda row: row["mode"]).items()}
    columns: dict[str, Cell] = {
        "certificates": len,
        **{v: counted(lambda row, v=v: row["verdict"] == v) for v in ("proved", "undecided", "refuted")},
        "seconds: median": told(median, "seconds"),
        "95 %": told(partial(percentile, share=0.95), "seconds"),
        "longest": told(max, "seconds"),
        "by the clock: median": told(median, "clock"),
        "most": told(max, "clock"),
        "MiB": told(max, "memory", 0),
        "decided by": lambda of: ", ".join(grouped(of, lambda row: row["method"])),
        "calls": counted(lambda row: row["calls"]),
        "columns": told(median, "columns", 0),
        "rows": told(median, "rows", 0),
    }
    return table(("group", "mode", "discount"), groups | {("all", "", ""): [*rows]}, columns)


def _proofs(rows: Sequence[Row]) -> Iterator[Line | Grid]:
    for mode, of in [*grouped(rows, lambda row: row["mode"]).items(), ("all", rows)]:
        files = [row for row in of if "accepted" in row]
        accepted = sum(row["accepted"] for row in files)
        outside = [row for row in files if "VeriPB" in row]
        by_veripb = f", {sum(row['by VeriPB'] for row in outside)} by VeriPB" if outside else ""
        names = (*FIGURES, *(("VeriPB",) if outside else ()))
        figures = {name: lambda row, name=name: float(row[name]) for name in names}
        yield Line(f"{mode}: {len(of)} certificates, {len(files)} files, {accepted} accepted{by_veripb}")
        yield spreads(files, figures)


if __name__ == "__main__":
    run(main, __doc__)
