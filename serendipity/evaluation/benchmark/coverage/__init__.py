"""How many tasks of a suite are decided, and how soon: the search, and Fast Downward beside it.

A suite is a folder of domains in MA-PDDL with their problems, as competitions give them.  Every
call is a process of its own, under a limit by the clock; times leave out reading and grounding on
both sides.  :mod:`plot` is loaded by who wants a plot.
"""

from serendipity.evaluation.benchmark.coverage.contenders import CONTENDERS, MODES, Call, Contender, Outcome
from serendipity.evaluation.benchmark.coverage.report import (
    Table,
    contenders_in,
    decided,
    errors,
    expansions,
    failures,
    over_time,
    seconds,
)
from serendipity.evaluation.benchmark.coverage.rows import Row, disagreements, measure
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles, is_suite, problems
from serendipity.evaluation.benchmark.coverage.table import as_table, read_rows

__all__ = [
    "CONTENDERS",
    "MODES",
    "Call",
    "Contender",
    "Outcome",
    "Problem",
    "Roles",
    "Row",
    "Table",
    "as_table",
    "contenders_in",
    "decided",
    "disagreements",
    "errors",
    "expansions",
    "failures",
    "is_suite",
    "measure",
    "over_time",
    "problems",
    "read_rows",
    "seconds",
]
