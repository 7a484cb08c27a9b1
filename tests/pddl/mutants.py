"""PDDL files with something wrong, or something odd, in them: raw damage, and damage that still parses.

A mutant is made of its number alone, so whoever has the number has the mutant.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from random import Random
from typing import NamedTuple

from serendipity.scenarios.examples import DATA as SHIPPED
from tests.pddl.texts import DATA, pair

Piece = Callable[[str, Random], tuple[int, int]]
"""Finds a piece of a text."""

Change = Callable[[str, Random], str]

TOKEN = re.compile(r"\(|\)|;[^\n]*|[^\s();]+|\s+")


class Files(NamedTuple):
    """A domain and a problem, and who is who in them."""

    domain: str
    problem: str
    human: str
    robots: tuple[str, ...]

    def write(self, folder: Path) -> tuple[Path, Path]:
        texts = (text.encode("utf-8", "surrogateescape") for text in (self.domain, self.problem))
        return pair(folder, *texts)


def _original(folder: Path, problem: str, human: str, *robots: str) -> Files:
    texts = [(folder / name).read_text() for name in ("domain.pddl", f"{problem}.pddl")]
    return Files(*texts, human, robots)


ORIGINALS = (
    _original(DATA / "office", "problem", "ann", "bot"),
    _original(DATA / "ward", "problem", "eva", "carta"),
    _original(DATA / "delivery", "problem", "w"),
    _original(SHIPPED / "usar", "room2", "commx", "robot"),
)

_WORDS = "(and|(or|(not (|forall|(= |1e9|0.|-1|1e-400|" + "9" * 40 + "|noop|object|either"
NOISE = (*"()?-;=:\n\r\t\x00", "\x1b[2J", *"\u202e\ufefféİſ\x85", *_WORDS.split("|"))

_ODD = """
(and)|(or)|()|(not (and))|(= {x} {y})|(not (= {x} {y}))|(total-cost)|(noop)
(forall (?z) {f})|(exists (?z) {f})|(forall (?z - {t}) (exists (?u - {t}) {f}))|(imply {f} {g})
(or {f} {g})|(not {f})|(not (or {f} (not {g})))|(when {f} {g})|(when (or {f} {g}) (not {g}))
(forall (?z - {t}) (when {f} {g}))|(and {f} {g} {f})|(increase (total-cost) {n})|(and {f} (not {f}))
(increase (total-cost) (total-cost))|(= (total-cost) {n})|(at 5 {f})|(preference p {f})|(> {n} 1)
(forall (?a ?b ?c ?d ?e ?f - {t}) {f})|(exists (?a ?b ?c ?d ?e ?f - {t}) (or {f} (= ?a ?b) (= ?c ?f)))
(:action noop :parameters () :effect {f})|(:requirements :adl {w})|(:private {x} {f})|(either {t} {t})
"""
ODD = tuple(_ODD.strip().replace("\n", "|").split("|"))
"""Groups to put in: ``f``, ``g`` stand for groups of the file, the others for words, types and a number."""


def mutant(number: int, originals: Sequence[Files] = ORIGINALS) -> Files:
    """The mutant of a number: one to four changes, raw ones or such of whole tokens and groups."""
    random = Random(number)
    original = random.choice(originals)
    texts = [original.domain, original.problem]
    for _ in range(random.choice((1, 1, 1, 2, 3, 4))):
        file = random.randrange(2)
        change = random.choice(RAW if random.random() < 0.25 else MEANT)
        texts[file] = change(texts[file], random)
    return Files(*texts, original.human, original.robots)


def _stretch(text: str, random: Random) -> tuple[int, int]:
    start = random.randint(0, len(text))
    return start, min(len(text), start + random.choice((1, 1, 2, 5, 20, 200)))


def _token(text: str, random: Random, but: str = "") -> tuple[int, int]:
    """A token, neither blanks nor a comment."""
    found = [
        t.span() for t in TOKEN.finditer(text) if not t[0].isspace() and t[0][0] != ";" and t[0] not in but
    ]
    return random.choice(found or [(0, len(text))])


_word = partial(_token, but="()")


def _group(text: str, random: Random) -> tuple[int, int]:
    return random.choice(_groups(text))


def _without(piece: Piece) -> Change:
    def change(text: str, random: Random) -> str:
        start, end = piece(text, random)
        return text[:start] + text[end:]

    return change


def _twice(piece: Piece) -> Change:
    def change(text: str, random: Random) -> str:
        start, end = piece(text, random)
        return f"{text[:end]} {text[start:end]}{text[end:]}"

    return change


def _instead(piece: Piece) -> Change:
    """A piece of the file in place of another."""

    def change(text: str, random: Random) -> str:
        (start, end), (other, stop) = piece(text, random), piece(text, random)
        return text[:start] + text[other:stop] + text[end:]

    return change


def _noise(text: str, random: Random) -> str:
    place = random.randint(0, len(text))
    return text[:place] + random.choice(NOISE) + text[place:]


def _odd_group(text: str, random: Random) -> str:
    """A construct around a group, or in place of one."""
    groups = _groups(text)
    small = [group for group in groups if group[1] - group[0] < 80] or groups
    start, end = random.choice(small)
    other, stop = random.choice(small)
    words = [text[slice(*_word(text, random))] for _ in range(3)]
    parts = {
        "f": text[start:end],
        "g": text[other:stop],
        **dict(zip("xyw", words, strict=True)),
        "t": random.choice([*_types(text), "object"]),
        "n": random.choice(("0", "2", "-1", "0.5", "1e3")),
    }
    return text[:start] + random.choice(ODD).format(**parts) + text[end:]


def _new_number(text: str, random: Random) -> str:
    numbers = [*re.finditer(r"(?<=[\s(])-?\d+\.?\d*(?=[\s)])", text)]
    if not numbers:
        return _instead(_word)(text, random)
    found = random.choice(numbers)
    number = random.choice(("0", "-1", "0.1", "1e5", "1e99", "1/3", "x", "7"))
    return text[: found.start()] + number + text[found.end() :]


def _many_objects(text: str, random: Random) -> str:
    typed = [*re.finditer(r"([\w-]+) - ([\w-]+)", text)]
    if not typed:
        return _instead(_word)(text, random)
    found = random.choice(typed)
    name, kind = found.groups()
    more = " ".join(f"{name}{i}" for i in range(random.choice((2, 5, 12))))
    return f"{text[: found.start()]}{name} {more} - {kind}{text[found.end() :]}"


def _groups(text: str) -> list[tuple[int, int]]:
    """Where the bracketed groups of a text are; the whole of it where there is none."""
    return [*_closed(text)] or [(0, len(text))]


def _closed(text: str) -> Iterator[tuple[int, int]]:
    opened: list[int] = []
    for found in TOKEN.finditer(text):
        if found.group() == "(":
            opened.append(found.start())
        elif found.group() == ")" and opened:
            yield opened.pop(), found.end()


def _types(text: str) -> list[str]:
    return re.findall(r"- ([\w-]+)", text)


RAW: tuple[Change, ...] = (_without(_stretch), _twice(_stretch), _instead(_stretch), _noise)

MEANT: tuple[Change, ...] = (
    *(_without(_token), _twice(_token), _instead(_word), _without(_group), _twice(_group), _instead(_group)),
    *(_odd_group, _odd_group, _new_number, _many_objects, *[_odd_group] * 6),
)
