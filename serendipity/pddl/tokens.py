"""PDDL text to tokens for plado's parser.

plado's own tokenizer is the slow part of reading and decides what is a keyword
without looking at its place, so an object called ``domain`` is refused.  This one
looks at the place and gives names that remember their line.
"""

import re
from typing import Final

from plado.parser.tokenizer import Category

from serendipity.model import InputError

_WORD: Final = re.compile(r"[()]|\?[^\s();?]*|[^\s();?]+")
_NUMBER: Final = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?")

HEADS: Final = {
    "and": Category.AND,
    "not": Category.NOT,
    "or": Category.OR,
    "imply": Category.IMPLY,
    "exists": Category.EXISTS,
    "forall": Category.FORALL,
    "when": Category.WHEN,
    "probabilistic": Category.PROBABILISTIC,
    "assign": Category.ASSIGN,
    "scale-up": Category.SCALE_UP,
    "scale-down": Category.SCALE_DOWN,
    "increase": Category.INCREASE,
    "decrease": Category.DECREASE,
    "=": Category.EQUAL,
    "<": Category.LT,
    "<=": Category.LE,
    ">": Category.GT,
    ">=": Category.GE,
    "+": Category.PLUS,
    "*": Category.TIMES,
    "/": Category.DIVIDE,
    "-": Category.MINUS,
}
"""Words that are keywords directly after an opening bracket."""

_SECTIONS: Final = {
    ":parameters": Category.PARAMETERS,
    ":precondition": Category.PRECONDITION,
    ":effect": Category.EFFECT,
    "-": Category.MINUS,
}
"""Words that are keywords anywhere else."""

_AFTER_METRIC: Final = {"minimize": Category.MINIMIZE, "maximize": Category.MAXIMIZE}


class Word(str):
    """A word of the text that knows its line, from 1."""

    __slots__ = ("line",)
    line: int


class Token:
    """A token as plado reads it: category ``cat`` and text ``tok``."""

    __slots__ = ("cat", "tok")

    def __init__(self, cat: Category, tok: Word) -> None:
        self.cat = cat
        self.tok = tok

    def __repr__(self) -> str:
        return f"'{self.tok}'"


def tokenize(text: str) -> list[Token]:
    """The tokens of a text, in lower case, without comments."""
    tokens: list[Token] = []
    findall = _WORD.findall
    previous = ""
    for number, line in enumerate(text.lower().split("\n"), start=1):
        for word in findall(line.partition(";")[0]):
            located = Word(word)
            located.line = number
            tokens.append(Token(_category(word, previous), located))
            previous = word
    return tokens


def _category(word: str, previous: str) -> Category:
    if word == "(":
        return Category.LBRACK
    if word == ")":
        return Category.RBRACK
    if word[0] == "?":
        return Category.VARIABLE
    if previous == "(":
        return HEADS.get(word, Category.NAME)
    if word in _SECTIONS:
        return _SECTIONS[word]
    if previous == ":metric" and word in _AFTER_METRIC:
        return _AFTER_METRIC[word]
    if not word[0].isalpha() and _NUMBER.fullmatch(word):
        return Category.CONSTANT
    return Category.NAME


class TokenStream:
    """The tokens with a cursor: what plado's parser calls a lookahead streamer."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self.position = 0

    def __iter__(self) -> "TokenStream":
        return self

    def __next__(self) -> Token:
        position = self.position
        self.position = position + 1
        try:
            return self.tokens[position]
        except IndexError:
            raise self.end_of_file() from None

    def __getitem__(self, ahead: int) -> Token:
        try:
            return self.tokens[self.position + ahead]
        except IndexError:
            raise self.end_of_file() from None

    at = __getitem__

    def shift(self, n: int) -> list[Token]:
        """The next ``n`` tokens, consumed."""
        return [next(self) for _ in range(n)]

    def expect(self, text: str) -> Token:
        """Consume a token that must read ``text``."""
        token = next(self)
        if token.tok != text:
            raise InputError(f"expected '{text}', got '{token.tok}'", line=token.tok.line)
        return token

    def expect_name(self, what: str) -> Word:
        """Consume a name; ``what`` is how an error calls it."""
        token = next(self)
        if token.cat is not Category.NAME:
            raise InputError(f"expected {what}, got '{token.tok}'", line=token.tok.line)
        return token.tok

    def end_of_file(self) -> InputError:
        """The error of a text that stops too early."""
        line = self.tokens[-1].tok.line if self.tokens else None
        return InputError("the file ends too early: expected ')'", line=line)

    def last(self) -> Token:
        """The token consumed last, or the very last one of the text."""
        return self.tokens[max(0, min(self.position, len(self.tokens)) - 1)]
