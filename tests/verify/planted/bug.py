"""A bug to plant, and the tools to plant it with."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from inspect import ismodule
from typing import Any

import pytest

Change = Callable[[Any], Any]
"""What stands in a place now -> what stands there with the bug."""


@dataclass(frozen=True, slots=True)
class Bug:
    """A bug in the planner.

    Attributes:
        owner: the class or module of what is broken.  A function of the module that defines it is replaced
            wherever it was imported, too; one of a module that imports it, there only.
        attribute: its name.
        what: what is wrong.
        change: makes it wrong.
    """

    owner: Any
    attribute: str
    what: str
    change: Change

    @property
    def name(self) -> str:
        """What is broken, and how."""
        return f"{self.owner.__name__.rpartition('.')[2]}.{self.attribute}: {self.what}"

    def plant(self, patch: pytest.MonkeyPatch) -> None:
        """Plant it."""
        now = getattr(self.owner, self.attribute)
        wrong = self.change(now)
        for owner in (self.owner, *self._importers(now)):
            patch.setattr(owner, self.attribute, wrong)

    def _importers(self, function: Any) -> list[Any]:
        """The modules of the program that have imported a function from the one that defines it."""
        if not ismodule(self.owner) or getattr(function, "__module__", None) != self.owner.__name__:
            return []
        return [
            module
            for where, module in list(sys.modules.items())
            if where.partition(".")[0] in ("serendipity", "search", "verify")
            and module is not self.owner
            and getattr(module, self.attribute, None) is function
        ]


def replaced(value: Any) -> Change:
    """Replaced, whatever it was."""
    return lambda _: value


def always(value: Any) -> Callable[..., Any]:
    """A function that gives ``value`` whatever it is asked."""
    return lambda *_, **__: value


def wrapped(around: Callable[..., Any]) -> Change:
    """A function or method replaced by ``around(original, *arguments)``."""

    def change(original: Any) -> Any:
        def broken(*arguments: Any, **keywords: Any) -> Any:
            return around(original, *arguments, **keywords)

        return broken

    return change


def afterwards(**fields: Callable[[Any], Any]) -> Change:
    """A constructor after which fields of its object become what is made of it."""

    def around(original: Any, self: Any, *arguments: Any, **keywords: Any) -> Any:
        found = original(self, *arguments, **keywords)
        for name, value in fields.items():
            setattr(self, name, value(self))
        return found

    return wrapped(around)


def returning(other: Callable[[Any], Any]) -> Change:
    """A function or method that returns something else instead of what it finds."""
    return wrapped(lambda original, *arguments, **keywords: other(original(*arguments, **keywords)))


def asked(**others: Callable[[Any], Any]) -> Change:
    """A function or method whose keyword arguments are others than those given."""

    def around(original: Any, *arguments: Any, **keywords: Any) -> Any:
        return original(*arguments, **keywords | {name: say(keywords[name]) for name, say in others.items()})

    return wrapped(around)
