"""PDDL text to nested lists of words that know their lines."""

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from sys import intern
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.work import Work

MAX_DEPTH: Final = 128
"""Brackets within brackets; what reads them calls itself once or twice for each."""

_CHUNK: Final = 1 << 16
"""Characters between two looks at the deadline: some milliseconds of them."""

_TOKEN: Final = re.compile(r"[()\n]|\?[^\s();?]*|[^\s();?]+")
_COMMENT: Final = re.compile(r";[^\n]*")
_SHOWN: Final = 60
_LISTED: Final = 8


class SExpression:
    """A list in brackets.

    Attributes:
        line: of the opening bracket, from 1.
        items: words and nodes.
        breaks: how many items stand before each end of a line; None for no end of a line.
    """

    __slots__ = ("breaks", "items", "line")

    def __init__(self, line: int) -> None:
        self.line = line
        self.items: list[str | SExpression] = []
        self.breaks: list[int] | None = None  # most nodes are on one line

    @property
    def head(self) -> "str | SExpression | None":
        """The first item, None where there is nothing."""
        return self.items[0] if self.items else None

    def line_of(self, i: int) -> int:
        """The line of an item, or of the closing bracket for one that is missing."""
        return self.line if self.breaks is None else self.line + bisect_right(self.breaks, i)

    def end_lines(self, count: int) -> None:
        """Note that so many lines end after the items so far."""
        if self.breaks is None:
            self.breaks = []
        self.breaks += [len(self.items)] * count


Item = str | SExpression


def read_tree(text: str, work: Work) -> SExpression:
    """The bracketed text, in lower case, without comments, as the items of a node."""
    node = SExpression(1)
    outer: list[SExpression] = []
    line = 1
    for tokens in _tokens(text, work):
        for token in tokens:
            if token == "(":
                if node.items and not outer:
                    raise InputError("expected the end of the file after the last ')', got '('", line=line)
                outer.append(node)
                if len(outer) > MAX_DEPTH:
                    raise InputError(f"brackets are nested too deeply: at most {MAX_DEPTH}", line=line)
                node = SExpression(line)
                outer[-1].items.append(node)
            elif token == ")":
                if not outer:
                    raise InputError("expected the end of the file, got a ')' that closes nothing", line=line)
                lines = line - node.line
                node = outer.pop()
                if lines:
                    node.end_lines(lines)
            elif token == "\n":
                line += 1
                node.end_lines(1)
            else:
                node.items.append(intern(token))
    if outer:
        last = text.count("\n", 0, len(text.rstrip())) + 1
        raise InputError(f"the file ends too early: expected the ')' for line {node.line}", line=last)
    return node


def _tokens(text: str, work: Work) -> Iterator[list[str]]:
    """The words, brackets and ends of lines, some thousand at a time."""
    for part in _parts(text):
        lower = part.lower()
        yield _TOKEN.findall(_COMMENT.sub("", lower) if ";" in lower else lower)
        work.deadline.check()


def _parts(text: str) -> Iterator[str]:
    """A text in parts that end with a line, or within a very long line behind a bracket of no comment."""
    start, newline, comment = 0, -1, -1
    while start < len(text):
        if newline < start + _CHUNK:
            newline = _find(text, "\n", start + _CHUNK)
        if comment < start:
            comment = _find(text, ";", start)
        end = newline + 1
        if end > start + 2 * _CHUNK:
            bracket = _find(text, ")", start + _CHUNK)
            end = bracket + 1 if bracket < min(newline, comment) else end
        yield text[start:end]
        start = end


def _find(text: str, what: str, start: int) -> int:
    """The place of something from ``start`` on; the length of the text where it is not."""
    found = text.find(what, start)
    return len(text) if found < 0 else found


def expected(what: str, node: SExpression, i: int) -> InputError:
    """The error that item ``i`` of a node is not what it should be."""
    got = "')'" if i >= len(node.items) else shown(node.items[i])
    return InputError(f"expected {what}, got {got}", line=node.line_of(i))


def shown(item: Item) -> str:
    """A word or a node as messages quote it, shortened."""
    if isinstance(item, str):
        return quoted(item)
    words = " ".join(word if isinstance(word, str) else "(...)" for word in item.items[:4])
    return quoted(f"({words}{' ...' if len(item.items) > 4 else ''})")


def quoted(text: str) -> str:
    """A text between quotation marks, shortened."""
    return f"'{text}'" if len(text) <= _SHOWN else f"'{text[:_SHOWN]}...'"


def listed(names: Iterable[str]) -> str:
    """Names one after the other, the first few of them."""
    names = [*names]
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return ", ".join([name[:_SHOWN] for name in names[:_LISTED]]) + more


def node_at(node: SExpression, i: int, what: str) -> SExpression:
    """Item ``i`` of a node, which must be a bracketed one."""
    item = node.items[i] if i < len(node.items) else None
    if isinstance(item, SExpression):
        return item
    raise expected(what, node, i)


def name_at(node: SExpression, i: int, what: str) -> str:
    """Item ``i`` of a node, which must be a name."""
    item = node.items[i] if i < len(node.items) else None
    if isinstance(item, str) and item[0] not in "?:" and item not in ("-", "="):
        return item
    raise expected(what, node, i)


def refuse_more(node: SExpression, i: int) -> None:
    """Check that a node ends before its item ``i``."""
    if i < len(node.items):
        raise expected("')'", node, i)


@contextmanager
def naming(where: str) -> Iterator[None]:
    """Put ``where`` before the message of an error."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{where}: {error.message}", error.file, error.line) from None
