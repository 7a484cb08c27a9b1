"""``serendipity reproduce``: a folder of tasks through modes x discounts."""

import logging
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.manner import is_quiet
from serendipity.cli.streams.stderr import broken_tasks, is_terminal, tell
from serendipity.model.options import limit_of
from serendipity.model.printable import message
from serendipity.model.telling import json_of
from serendipity.writing.csv_text import as_csv
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written

if TYPE_CHECKING:
    from serendipity.evaluation.reproduction import Reproduction
    from serendipity.evaluation.reproduction.tables import Tables

log = logging.getLogger("serendipity.reproduce")

_FORMATS: Final = ("table", "csv", "json", *(form for form in ROWS if form != "csv"))
_FORMAT: Final = output.formats(_FORMATS, "By default after -o's name, else table.")


def reproduce(
    *,
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER",
            help="Folder of tasks: testN, each with a folder per agent and superagent/.",
            show_default=False,
        ),
    ],
    modes: Annotated[
        str, option("--modes MODE,...", "Modes to solve each task in.")
    ] = "individual,serendipity,communication,composite",
    discounts: Annotated[str, option("--discounts D,...", "Discounts, 0 to 1.")] = "0,0.1,0.3,0.5,0.7,0.9",
    jobs: Annotated[int, option("-j, --jobs N", "Processes.")] = 1,
    dask: Annotated[
        str | None,
        option("--dask ADDRESS|local", "Work on a Dask cluster (needs serendipity-planner[dask])."),
    ] = None,
    time_limit: Annotated[
        str | None, option("--time-limit SECONDS", "Seconds for each row, and for reading each task.")
    ] = None,
    memory_limit: Annotated[
        str | None, option("--memory-limit MIB", "MiB of memory for each process.")
    ] = None,
    journal: Annotated[
        Path | None,
        option(
            "--journal FILE", "Append finished tasks to FILE and skip those in it; by default OUTPUT.journal."
        ),
    ] = None,
    report: Annotated[
        Path | None,
        option("--report FILE.html", "Also write tables, and charts with matplotlib, to one page."),
    ] = None,
    tables: Annotated[
        Path | None, option("--tables PREFIX", "Also write Table I and II to PREFIX1.csv and PREFIX2.csv.")
    ] = None,
    to: Annotated[output.Destination, _FORMAT],
) -> int:
    """Run a folder of tasks through modes and discounts. A run that was killed goes on where it was."""
    form = to.prepare(_FORMATS)
    for name, file in (("--report", report), ("--journal", journal), ("--tables", tables)):
        output.check_output(file, name)
    from serendipity.evaluation.reproduction import reproduce as run_all
    from serendipity.evaluation.reproduction.tables import tables as tables_of

    kept = journal
    if kept is None and to.output_file is not None:
        kept = to.output_file.with_name(f"{to.output_file.name}.journal")
    with progress.counting("tasks") as on_progress:
        run = run_all(
            folder,
            modes=_listed(modes),
            discounts=_listed(discounts),
            jobs=jobs,
            journal=kept,
            dask=dask,
            on_progress=lambda made: on_progress(made.done, made.total, opportunities=made.opportunities),
            time_limit=None if time_limit is None else limit_of("time_limit", time_limit, "seconds"),
            memory_limit=None if memory_limit is None else limit_of("memory_limit", memory_limit, "MiB"),
        )
    found = tables_of(run)
    answers = [output.Answer(_answer(form, run, found), to.output_file), *_extras(report, tables, run, found)]
    output.write_answers(answers)
    if journal is None and kept is not None and not run.errors:
        kept.unlink(missing_ok=True)  # the answer holds all of it
    for answer in answers:  # on a terminal, or in the log
        if answer.file is not None and is_terminal() and not is_quiet():
            tell(f"Wrote {answer.file}")
        elif answer.file is not None:
            log.info("wrote %s", message(str(answer.file)))
    if run.errors:
        return broken_tasks(run.errors)
    known = any(row.status != "unknown" for row in run.rows)
    return ExitCode.ANSWERED if known else ExitCode.UNDECIDED


def _listed(text: str) -> list[Any]:
    return [part for part in text.replace(",", " ").split() if part]


def _answer(form: str, run: "Reproduction", tables: "Tables") -> str | bytes:
    from serendipity.evaluation.reproduction.rows import COLUMNS
    from serendipity.evaluation.reproduction.tables import as_json

    if form == "csv":
        return as_csv(COLUMNS, (row.cells() for row in run.rows))
    if form == "json":
        return json_of(as_json(run, tables))
    return written(run.table(), form) if form in ROWS else _text(run, tables)


def _text(run: "Reproduction", tables: "Tables") -> str:
    from serendipity.cli.text.render import rendered
    from serendipity.evaluation.reproduction.report import titled
    from serendipity.evaluation.reproduction.rows import COLUMNS, SHORT
    from serendipity.model.telling import Grid, Line

    parts: list[Line | Grid] = [Grid(COLUMNS[:SHORT], [row.cells()[:SHORT] for row in run.rows])]
    if run.unproved:
        late = f"{run.unproved} of {len(run.rows)} rows are not proved: a limit came first"
        parts.append(Line(late, "yellow"))
    for title, grid in titled(tables):
        parts += [Line(), Line(title, "bold"), grid]
    return rendered(parts)


def _extras(
    report: Path | None, prefix: Path | None, run: "Reproduction", tables: "Tables"
) -> Iterator[output.Answer]:
    """What was asked for besides the answer."""
    from serendipity.evaluation.reproduction.report import html_report
    from serendipity.evaluation.reproduction.tables import table_as_csv

    if report is not None:
        yield output.Answer(html_report(run, tables), report, "--report")
    if prefix is not None:
        for number, lines in ((1, tables.costs), (2, tables.times)):
            file = prefix.with_name(f"{prefix.name}{number}.csv")
            yield output.Answer(table_as_csv(lines), file, "--tables")
