"""Changes to answers, and to anything else in JSON, and what the verifier says of them."""

import json
from collections.abc import Callable
from typing import Any

import serendipity
from serendipity.model import Certificate, Claim, Result, Task

Edit = Callable[[dict[str, Any]], object]


def edit(path: str, value: object) -> Edit:
    """Set what a path like ``statistics.goals.0.cost`` leads to; a callable gets the old value."""

    def change(answer: dict[str, Any]) -> None:
        *way, last = [int(part) if part.isdigit() else part for part in path.split(".")]
        at: Any = answer
        for part in way:
            at = at[part]
        at[last] = value(at[last]) if callable(value) else value

    return change


def together(*edits: Edit) -> Edit:
    """One change after the other."""

    def change(answer: dict[str, Any]) -> None:
        for one in edits:
            one(answer)

    return change


def edited(answer: Result, *changes: Edit) -> Result:
    """What is read from an answer with these changes."""
    said = json.loads(json.dumps(answer.to_dict()))
    together(*changes)(said)
    return Result.from_dict(said)


def certified(task: Task, answer: Result, *changes: Edit) -> Certificate:
    """What the verifier says of an answer with these changes."""
    return serendipity.verify(task, edited(answer, *changes))


def assert_refuted(certificate: Certificate, claim: str, words: str = "") -> Claim:
    """The first claim that is refuted, which has to be this one."""
    refuted = certificate.refuted
    assert refuted is not None
    assert (refuted.claim, words in refuted.reason) == (claim, True), refuted
    return refuted
