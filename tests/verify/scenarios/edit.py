"""Changes to answers as JSON."""

from collections.abc import Callable
from typing import Any

Edit = Callable[[dict[str, Any]], None]


def edit(path: str, value: object) -> Edit:
    """Set what a path like ``statistics.goals.0.cost`` leads to; a callable gets the old value."""

    def change(answer: dict[str, Any]) -> None:
        *way, last = [int(part) if part.isdigit() else part for part in path.split(".")]
        at: Any = answer
        for part in way:
            at = at[part]
        at[last] = value(at[last]) if callable(value) else value

    return change
