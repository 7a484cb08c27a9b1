"""Files of candidate goals and of observed actions.

Goals: a JSON list of ``{"name": ..., "goal": [literals], "prior": ...}``, or a goal a line,
``prior: literal, literal`` (without ``prior:`` it is 1).  Observations: a list of actions, as in
the file of ``--human-plan`` (see :mod:`serendipity.pddl.parsing.lists`).
"""

from os import PathLike
from typing import Any

from serendipity.model import InputError
from serendipity.model.task.task import canonical_name
from serendipity.pddl.parsing.files import read_text
from serendipity.pddl.parsing.lists import FileItem, actions_in, json_items, lines_of, starts_json

Path = str | PathLike[str]


def read_goals(path: Path) -> list[FileItem]:
    """The goals of a file, in the form of JSON objects.

    Raises:
        InputError: it can't be read, or a line is not of either form.
    """
    text = read_text(path)
    if starts_json(text):
        return json_items(text, path)
    return [FileItem(_goal_line(bare, path, number), number) for number, bare in lines_of(text)]


def read_observed(path: Path) -> list[tuple[str, int | None]]:
    """The names of the actions of a file, each with its line.

    Raises:
        InputError: it can't be read, or a line is not one action.
    """
    return [(canonical_name(name), line) for name, line in actions_in(read_text(path), path)]


def _goal_line(bare: str, path: Path, number: int) -> dict[str, Any]:
    prior, colon, literals = bare.rpartition(":")
    facts = [text.strip() for text in literals.split(",")]
    if not all(facts):
        raise InputError(f"expected a goal as 'prior: fact, fact', got '{bare}'", path, number)
    return {"goal": facts, "prior": prior.strip() if colon else "1"}
