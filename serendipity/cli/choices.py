"""Options of commands, each declared as help shows it."""

import re
from typing import Any

import typer


def option(shown: str, help: str, **more: Any) -> Any:  # noqa: A002 - typer's word
    """An option as typer has it.

    Args:
        shown: its names, and what stands for its value: ``-o, --output FILE``.  Legal values are separated
            by ``|``, and completed by shells; those in capitals stand for many, such as ``N``.
    """
    words = re.split(r",? +", shown)
    names = [word for word in words if word.startswith("-")]
    metavar = " ".join(words[len(names) :])
    if "|" in metavar:
        values = [value for value in metavar.split("|") if not value.isupper()]
        more["autocompletion"] = lambda: values
    return typer.Option(*names, metavar=metavar or None, help=help, **more)
