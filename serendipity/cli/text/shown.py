"""Answers in the format that was asked for."""

from typing import Any

from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written


def shown(answer: Any, form: str, **how: Any) -> str | bytes:
    """An answer as JSON, as rows, or as text.

    Args:
        answer: with ``to_json``, ``told`` and, where it has rows, ``table``.
        form: a format of the command.
        how: keywords of ``told``.
    """
    if form == "json":
        return str(answer.to_json())
    if form in ROWS:
        return written(answer.table(), form)
    from serendipity.cli.text.render import rendered

    return rendered(answer.told(**how))
