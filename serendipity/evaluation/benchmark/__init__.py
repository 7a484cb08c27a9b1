"""The same calls, in one run, side by side: the search, integer programs, Fast Downward.

Times are seconds of processor time, of child processes too: every contender works in one
thread, and what else the machine does leaves them as they are.  :mod:`plot` is loaded by
who wants a plot.
"""

from serendipity.evaluation.benchmark.contenders import CONTENDERS, Contender
from serendipity.evaluation.benchmark.measure import MODES, Timing, broken, measure
from serendipity.evaluation.benchmark.report import RATIOS_HEADER, TIMES_HEADER, machine, ratios, times
from serendipity.evaluation.benchmark.scaling import AXES, Axis, Sample, planned, scale
from serendipity.evaluation.benchmark.scaling_report import (
    EXPONENTS_HEADER,
    SCALING_HEADER,
    exponents,
    scaling_table,
)
from serendipity.evaluation.benchmark.usage import peak_memory

__all__ = [
    "AXES",
    "CONTENDERS",
    "EXPONENTS_HEADER",
    "MODES",
    "RATIOS_HEADER",
    "SCALING_HEADER",
    "TIMES_HEADER",
    "Axis",
    "Contender",
    "Sample",
    "Timing",
    "broken",
    "exponents",
    "machine",
    "measure",
    "peak_memory",
    "planned",
    "ratios",
    "scale",
    "scaling_table",
    "times",
]
