"""Options with a few legal values: what help shows is what the shell completes."""

from typing import Any


def choices(*values: str) -> dict[str, Any]:
    """Keywords of ``typer.Option`` for some values; those in capitals stand for many, such as ``N``."""
    return {"metavar": "|".join(values), "autocompletion": lambda: [v for v in values if not v.isupper()]}
