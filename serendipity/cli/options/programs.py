"""Options of the commands that ask an integer program."""

from pathlib import Path
from typing import Annotated

from serendipity.cli.choices import option

Solver = Annotated[str, option("--solver highs|cbc", "highs, or cbc as a cross-check.")]
Encoding = Annotated[str, option("--encoding automata|paper", "Agent automata, or the paper's equations.")]
Method = Annotated[
    str,
    option(
        "--method auto|program|exhaustive",
        "What proves that nothing is better; program: the solver, even where reachability could; "
        "exhaustive: a search of all states; auto: both in turns.",
    ),
]
Proof = Annotated[
    Path | None, option("--proof FILE", "Write what convinced it, for `check-proof`; .gz packs it.")
]
