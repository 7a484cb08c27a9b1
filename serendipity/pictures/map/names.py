"""Names as people read them: the parts of facts and actions, with or without blanks.

Ground files write ``at_commx_hall1`` where lifted ones write ``at commx hall1``; pictures
treat both alike.
"""

import re
from collections.abc import Sequence
from typing import Final

_WIDTHS: Final = {
    letter: width
    for letters, width in (
        ("ijl'|!.,:;/\\ ", 0.36),
        ("frt-()[]`I", 0.42),
        ("csz_*?J", 0.54),
        ("wABCDGHKNOQRUVX&+<=>^~#", 0.8),
        ("mMW%@", 1.0),
    )
    for letter in letters
}
_OTHER: Final = 0.64
_WIDE: Final = 0x2E80  # from here on mostly letters that are as wide as high

Parts = tuple[str, ...]


def parts(name: str) -> Parts:
    """The words of a fact's or action's name; ``_`` separates them where there is no blank."""
    return tuple(part for part in (name.split() if " " in name else name.split("_")) if part)


def find(needle: Parts, haystack: Parts) -> int:
    """Where ``needle`` begins in ``haystack``, or -1."""
    last = len(haystack) - len(needle)
    return next((i for i in range(last + 1) if haystack[i : i + len(needle)] == needle), -1)


def common_start(several: Sequence[Parts]) -> Parts:
    """The parts that all of several names begin with."""
    first, last = min(several), max(several)
    same = next((i for i, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), len(first))
    return first[:same]


def common_ends(several: Sequence[Parts]) -> tuple[Parts, Parts]:
    """The parts that all of several names begin with, and those that they end with."""
    start = common_start(several)
    rests = [name[len(start) :][::-1] for name in several]
    return start, common_start(rests)[::-1]


def without(needles: Sequence[Parts], haystack: Parts) -> Parts:
    """``haystack`` without the first occurrence of each of ``needles``."""
    for needle in needles:
        at = find(needle, haystack)
        if at >= 0:
            haystack = haystack[:at] + haystack[at + len(needle) :]
    return haystack


def spellings(name: str) -> tuple[Parts, ...]:
    """How a name can occur among parts: whole, or split at ``_`` in a ground file."""
    whole, split = (name,), tuple(part for part in name.split("_") if part)
    return (whole,) if split == whole else (whole, split)


def verb_and_rest(action: str, agents: Sequence[str]) -> tuple[str, str]:
    """An action in two short lines, without the agents: ``("hand over", "mk2 hall4")``."""
    words = parts(action)
    named = [spelling for agent in agents for spelling in spellings(agent)]
    first = min((at for at in (find(name, words) for name in named) if at > 0), default=1)
    return " ".join(words[:first]).replace("_", " "), " ".join(without(named, words[first:]))


def ems(text: str) -> float:
    """The width of a text in font sizes: good enough to fit labels into boxes, in most fonts."""
    return sum(1.0 if ord(letter) >= _WIDE else _WIDTHS.get(letter, _OTHER) for letter in text)


def shortened(text: str, room: float) -> str:
    """``text``, or as much of it, elided, as fits into so many font sizes."""
    length = len(text)
    while length > 1 and ems(elided(text, length)) > room:
        length -= 1
    return elided(text, length)


def elided(text: str, length: int) -> str:
    """``text``, or its beginning, an ellipsis and the number at its end, in at most ``length`` characters."""
    if len(text) <= length:
        return text
    number = re.search(r"[0-9][0-9-]*$", text)
    end = number[0] if number and len(number[0]) + 2 <= length else ""
    return text[: max(1, length - 1 - len(end))] + "…" + end


def natural(text: str) -> tuple[tuple[int, str], ...]:
    """A key that sorts ``room2`` before ``room10``."""
    runs: list[str] = []
    for letter in text:
        if runs and runs[-1].isdigit() == letter.isdigit():
            runs[-1] += letter
        else:
            runs.append(letter)
    return tuple((int(run), "") if run.isdecimal() else (-1, run) for run in runs)
