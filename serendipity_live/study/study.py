"""A study on the network: a page to join on, one for each participant, one for those who run it.

They save one tidy table of it, a row for each round of each participant, and what its columns mean.
"""

import re
import secrets
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime, timedelta
from html import escape
from pathlib import Path
from threading import Lock
from typing import Any, Final

import serendipity
from serendipity.model import InputError, UsageError
from serendipity.writing.csv_text import as_csv as csv_of
from serendipity_live.play.records import Download, Event, Records, as_csv, as_json, cell, read
from serendipity_live.study.design import Design
from serendipity_live.study.drawing import order, places
from serendipity_live.study.participant import Participant, page_facts
from serendipity_live.study.texts import Item

COLUMNS: Final = {
    "participant": "number in the study",
    "outside_id": "what the link said of who they are elsewhere",
    "state": "of the participant: finished, withdrawn, lost (not heard of for long), under way",
    "study": "hash of the study's design; it is the same in all rows of one study",
    "seed": "of the study; all draws follow from it",
    "place": "the participant's among the places drawn in balanced blocks, from 0: their condition and order",
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
    "understood": "how often the questions about the instructions were answered until all were right; never: "
    "not in as many tries as there are; empty: there are none",
    "attentive": "whether all that is expected of who attends was answered, after the round and at the end: "
    "true or false; empty: nothing is",
}
"""Columns and what they mean; the answers come behind them."""


def rounds_table(design: Design, people: Sequence[tuple[Sequence[Event], str]]) -> str:
    """The table as CSV, of each one's events and state."""
    answers = [name for name, _ in _answers(design)]
    columns = [*COLUMNS, *answers]
    rows = [row for events, state in people for row in _rows(events, state)]
    return csv_of(columns, [[cell(row.get(column)) for column in columns] for row in rows])


def codebook(design: Design) -> str:
    """What each column of the table means, as CSV."""
    told = ((name, f"answer to: {q.text} ({_scale(q)})") for name, q in _answers(design))
    return csv_of(("column", "meaning"), [*COLUMNS.items(), *told])


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
        **{key: joined.get(key) for key in ("study", "seed", "place")},
        "understood": _understood(events),
        **_answered("closing", closing),
    }
    for first in (event for event in events if event["event"] == "begun"):
        here = [event for event in events if event.get("round") == first["round"]]
        asked = [event for event in (*here, *closing) if event["event"] == "answers"]
        yield {**person, **_round(first, here), "attentive": _attentive(asked)}


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


def _understood(events: Sequence[Event]) -> int | str | None:
    tries = [e["answers"] for e in events if e["event"] == "answers" and e.get("about") == "comprehension"]
    if not tries:
        return None
    return len(tries) if all(told["right"] for told in tries[-1]) else "never"


def _attentive(asked: Sequence[Event]) -> bool | None:
    checks = [told["right"] for event in asked for told in event["answers"] if "right" in told]
    return all(checks) if checks else None


def _answered(kind: str, events: Sequence[Event]) -> dict[str, Any]:
    answers = events[-1]["answers"] if events else []
    return {f"{kind}_{number}": told["answer"] for number, told in enumerate(answers, start=1)}


_FILE: Final = re.compile(r"P(\d{3,6})\.jsonl")
_OUTSIDE: Final = ("PROLIFIC_PID", "participant", "id")
"""What of the address may say who somebody is elsewhere: the first of these that is there."""
_ID: Final = re.compile(r"[A-Za-z0-9._~@:+=-]{1,100}")


class Study:
    """Participants, each with a link and a file of their own, and lines about faults: what can't be read."""

    def __init__(self, design: Design, folder: Path) -> None:
        self._design = design
        self._folder = folder
        self._joining = Lock()
        self._participants: dict[str, Participant] = {}
        self._unreadable: list[Event] = []
        self._visits: dict[str, Participant] = {}
        self.faults: list[str] = []
        for file in sorted(file for file in folder.iterdir() if _FILE.fullmatch(file.name)):
            events, faults = read(file)
            self.faults += faults
            try:
                self._take_in(Participant(design, Records(file.stem, file, events)))
            except InputError as error:
                self.faults.append(f"{file.name}: {error}")
                self._unreadable += events

    def room(self, token: str) -> "Participant | _Lobby | None":
        """The page to join on, or a participant's."""
        return self._participants.get(token) if token else _Lobby(self)

    def file(self, path: str) -> Download | None:
        """What those who run the study may see and save; the address ends in the secret of the study."""
        start, _, rest = path.partition("/")
        secret, _, name = rest.partition("/")
        if start != "experimenter" or not secrets.compare_digest(
            secret.encode(), self._design.secret.encode()
        ):
            return None
        people = list(self._participants.values())
        if name == "":
            return Download(self._overview(people), "text/html; charset=utf-8")
        if name == "events.json":
            return as_json(self.events(), name)
        made = {
            "events.csv": lambda: as_csv(self.events()),
            "rounds.csv": lambda: rounds_table(self._design, [(p.events(), self.state(p)) for p in people]),
            "codebook.csv": lambda: codebook(self._design),
        }
        return Download(made[name](), "text/csv; charset=utf-8", name) if name in made else None

    def events(self) -> list[Event]:
        """The events of all participants."""
        people = list(self._participants.values())  # somebody may join meanwhile
        return [event for participant in people for event in participant.events()] + self._unreadable

    def state(self, participant: Participant) -> str:
        """``finished``, ``withdrawn``, ``under way``, or ``lost``: nothing was heard of them for long."""
        if participant.over:
            return "finished" if participant.stage == "end" else "withdrawn"
        silent = datetime.now(UTC) - datetime.fromisoformat(participant.last)
        lost = silent > timedelta(minutes=self._design.texts.lost_after_minutes)
        return "lost" if lost else "under way"

    @property
    def texts(self) -> Mapping[str, str]:
        """Of the page, by the English ones."""
        return self._design.language.texts

    # -- joining

    def consent(self) -> list[str]:
        """What is agreed to."""
        return list(self._design.texts.consent)

    def join(self, message: Mapping[str, Any]) -> Participant:
        """Somebody agrees to take part; who has done so before, by what the address says, goes on."""
        if message.get("agree") is not True:
            raise UsageError("consent: nobody takes part without it")
        visit, address = message.get("visit"), message.get("address")
        visit = visit[:100] if isinstance(visit, str) else None
        known = address if isinstance(address, dict) else {}
        outside = next((_id(key, known[key]) for key in _OUTSIDE if known.get(key)), None)
        with self._joining:
            for participant in self._participants.values():
                if outside is not None and participant.joined.get("outside_id") == outside:
                    return participant
            if visit in self._visits:  # a double click
                return self._visits[visit]
            joined = self._new(outside, page_facts(message))
            if visit is not None:
                self._visits[visit] = joined
            return joined

    def _new(self, outside: str | None, page: Event) -> Participant:
        texts, names = self._design.texts, list(self._design.scenarios)
        place, condition, row = self._free()
        records = self._file()
        records.add(
            "joined",
            token=secrets.token_urlsafe(16),
            outside_id=outside,
            place=place,
            condition=condition,
            order=[names[i] for i in order(row, len(names))],
            seed=self._design.seed,
            study=self._design.mark,
            version=serendipity.__version__,
            consent=texts.consent,
            **page,
        )
        participant = Participant(self._design, records)
        self._take_in(participant)
        return participant

    def _free(self) -> tuple[int, str, int]:
        """The first place that nobody has: those who have withdrawn or are lost give theirs back."""
        held = {
            participant.joined["place"]
            for participant in self._participants.values()
            if self.state(participant) in ("finished", "under way")
        }
        drawn = places(self._design.texts.conditions, len(self._design.scenarios), self._design.seed)
        return next((i, name, row) for i, (name, row) in enumerate(drawn) if i not in held)

    def _file(self) -> Records:
        """A new file, under the next number."""
        numbers = [int(found[1]) for file in self._folder.iterdir() if (found := _FILE.fullmatch(file.name))]
        name = f"P{max(numbers, default=0) + 1:03}"
        try:
            (self._folder / f"{name}.jsonl").touch(mode=0o600, exist_ok=False)
        except OSError as error:
            raise UsageError(f"{name}.jsonl can't be made: {(error.strerror or '').lower()}") from None
        return Records(name, self._folder / f"{name}.jsonl")

    def _take_in(self, participant: Participant) -> None:
        self._participants[participant.joined["token"]] = participant

    # -- those who run it

    def _overview(self, people: list[Participant]) -> str:
        """The experimenter's page; it does not tell who has which condition."""
        rows = "".join(
            f"<tr><td>{p.name}</td><td>{escape(p.joined.get('outside_id') or '')}</td>"
            f"<td>{self.state(p)}</td><td>{p.stage} {p.round or ''}</td>"
            f"<td>{escape(p.last[:19].replace('T', ' '))}</td>"
            f'<td><a href="/s/{p.joined["token"]}">link</a></td></tr>'
            for p in people
        )
        heads = "".join(
            f"<th>{name}</th>" for name in ("", "outside id", "state", "at", "last heard of, UTC", "")
        )
        saved = " ".join(
            f'<a href="/experimenter/{self._design.secret}/{name}" download>{name}</a>'
            for name in ("rounds.csv", "events.csv", "events.json", "codebook.csv")
        )
        faults = "".join(f"<p class='banner'>{escape(fault)}</p>" for fault in self.faults)
        return (
            '<!doctype html><html lang="en"><meta charset="utf-8"><title>Study</title>'
            '<link rel="icon" href="data:,"><link rel="stylesheet" href="/page/play.css">'
            f'<main class="sheet people"><h1>Study</h1>{faults}<p>Save: {saved}</p>'
            f"<table><tr>{heads}</tr>{rows}</table><h2>Rehearsal</h2><pre>{escape(self._design.report)}</pre>"
            f"<p>Study {self._design.mark}, completion code {escape(self._design.code)}. New participants "
            "join at <a href='/'>/</a>; what stands there as ?PROLIFIC_PID=, ?participant= or ?id= is their "
            "outside id.</p></main></html>"
        )


def _id(name: str, given: object) -> str:
    """Who somebody is elsewhere; a placeholder that a site has not filled in, as ``{{%ID%}}``, is nobody."""
    if not isinstance(given, str) or not _ID.fullmatch(given):
        raise UsageError(f"{name}: expected at most 100 letters, digits or ._~@:+=-, got {given!r:.50}")
    return given


class _Lobby:
    """The page to join on."""

    def __init__(self, study: Study) -> None:
        self._study = study

    def view(self) -> dict[str, Any]:
        """What it shows."""
        return {
            "stage": "consent",
            "moment": "consent",
            "round": 0,
            "study": {"text": self._study.consent(), "participant": None},
        }

    def do(self, message: Mapping[str, Any]) -> dict[str, Any]:
        """Join."""
        if message.get("do") == "hello":
            return {}
        if message.get("do") != "join":
            raise UsageError(f"expected somebody to join, got {message.get('do')!r:.50}")
        return {"kind": "go", "to": f"/s/{self._study.join(message).joined['token']}"}
