"""One tidy table of a study: a row for each round of each participant; and what its columns mean."""

from collections.abc import Iterator, Sequence
from datetime import datetime
from typing import Any, Final

from serendipity.live.play.records import Event, cell
from serendipity.live.study.design import Design
from serendipity.live.study.texts import Item
from serendipity.writing.csv_text import as_csv

COLUMNS: Final = {
    "participant": "number in the study",
    "outside_id": "what the link said of who they are elsewhere",
    "state": "of the participant: finished, withdrawn, lost (not heard of for long), under way",
    "study": "hash of the study's design; it is the same in all rows of one study",
    "condition": "none: robots do nothing; silent: they help and say nothing; announced: they say what they "
    "do; practice rounds are always none",
    "round": "place of the round in the participant's order, from 1; 0 is for practice",
    "scenario": "name of the scenario",
    "view": "what the participant sees: observant, everything; local, where they are",
    "discount": "taken off the cost of what robots do by themselves, for team_cost",
    "complete": "whether the round was played to its end: true or false",
    "reached": "whether its goal was reached: true or false",
    "epochs": "how many epochs were played",
    "human_cost": "what the participant paid",
    "team_cost": "what they and the robots paid, with the discount",
    "alone_cost": "what the best way costs without any help",
    "helped": "epochs in which robots did something",
    "offered": "epochs in which robots were ready to do something with the participant",
    "taken": "epochs in which the participant took part in it",
    "in_vain": "epochs in which the participant tried what was not possible",
    "begun": "when it began, UTC",
    "seconds": "from its beginning to the last choice",
    "thinking_seconds": "mean time for a choice, by the page where it said so",
}
"""Columns and what they mean; the answers come behind them."""


def rounds_table(design: Design, people: Sequence[tuple[Sequence[Event], str]]) -> str:
    """The table as CSV.

    Args:
        people: each one's events, and state.
    """
    answers = [name for name, _ in _answers(design)]
    columns = [*COLUMNS, *answers]
    rows = [row for events, state in people for row in _rows(events, state)]
    return as_csv(columns, [[cell(row.get(column)) for column in columns] for row in rows])


def codebook(design: Design) -> str:
    """What each column of the table means, as CSV."""
    told = ((name, f"answer to: {q.text} ({_scale(q)})") for name, q in _answers(design))
    return as_csv(("column", "meaning"), [*COLUMNS.items(), *told])


def _answers(design: Design) -> Iterator[tuple[str, Item]]:
    """The columns of answers: after each round, and at the end, where they stand in each row."""
    for kind, asked in (("answer", design.texts.questions), ("closing", design.texts.closing)):
        yield from ((f"{kind}_{number}", question) for number, question in enumerate(asked, start=1))


def _scale(question: Item) -> str:
    if question.kind == "scale":
        return f"1 {question.ends[0]}, {question.points} {question.ends[1]}"
    return "; ".join(question.choices) if question.kind == "choice" else "text"


def _rows(events: Sequence[Event], state: str) -> Iterator[Event]:
    joined = next((event for event in events if event["event"] == "joined"), {})
    closing = [e for e in events if e["event"] == "answers" and e.get("about") == "closing"]
    person = {
        "participant": joined.get("participant"),
        "outside_id": joined.get("outside_id"),
        "state": state,
        "study": joined.get("study"),
        **_answered("closing", closing),
    }
    for first in (event for event in events if event["event"] == "begun"):
        here = [event for event in events if event.get("round") == first["round"]]
        yield {**person, **_round(first, here)}


def _round(first: Event, here: Sequence[Event]) -> Event:
    epochs = [event for event in here if event["event"] == "epoch"]
    last = epochs[-1] if epochs else {"human_cost": 0, "team_cost": 0, "done": False, "reached": False}
    over = next((event for event in here if event["event"] == "round over"), {})
    ends = [datetime.fromisoformat(event["time"]) for event in (first, (epochs or [first])[-1])]
    thought = [float(event.get("page_seconds") or event["seconds"]) for event in epochs]
    return {
        **{key: first[key] for key in ("condition", "round", "scenario", "view", "discount", "alone_cost")},
        "complete": last["done"],
        "reached": last["reached"],
        "epochs": len(epochs),
        "human_cost": last["human_cost"],
        "team_cost": last["team_cost"],
        **{key: over.get(key) for key in ("helped", "offered", "taken")},
        "in_vain": sum(bool(event["in_vain"]) for event in epochs),
        "begun": first["time"],
        "seconds": round((ends[1] - ends[0]).total_seconds(), 3),
        "thinking_seconds": round(sum(thought) / len(thought), 3) if thought else None,
        **_answered("answer", [e for e in here if e["event"] == "answers"]),
    }


def _answered(kind: str, events: Sequence[Event]) -> dict[str, Any]:
    answers = events[-1]["answers"] if events else []
    return {f"{kind}_{number}": told["answer"] for number, told in enumerate(answers, start=1)}
