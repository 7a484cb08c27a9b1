"""What came of each turn that the strategies of a search had, as a table."""

from collections.abc import Mapping, Sequence
from typing import Any

from serendipity.model.numbers import plain
from serendipity.model.telling import Grid, as_text


def table_of(tried: Sequence[Mapping[str, Any]]) -> str:
    """The rows of ``result.statistics["strategies"]``, a line for each turn.

    Args:
        tried: ``name``, ``seconds``, ``better`` (how many better answers came of it), ``bound`` (that it
            proved, or None), and whether it ``settled`` the answer.
    """
    rows = [
        [
            row["name"],
            f"{row['seconds']:.3f}",
            f"{row['better'] or ''}",
            "" if row["bound"] is None else plain(row["bound"]),
            "yes" if row["settled"] else "",
        ]
        for row in tried
    ]
    return as_text([Grid(["turn", "seconds", "better answers", "bound", "settled"], rows)])
