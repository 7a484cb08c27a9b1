"""Options where the human's goal is not known (semantics 8)."""

from pathlib import Path
from typing import Annotated

from serendipity.cli.choices import option

Goals = Annotated[
    Path | None,
    option("--goals FILE", "Goals that the human may have: JSON, or 'prior: fact, fact' on each line."),
]
Observed = Annotated[
    Path | None, option("--observed FILE", "What the human has done so far, an action a line.")
]
Beta = Annotated[
    str | None, option("--beta B", "How strictly the human saves cost; 0 and more. [default: 1]")
]
