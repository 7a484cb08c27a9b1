"""A bug to plant, and the tools to plant it with."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest

from tests.verify.planted.roles import Place, place

Change = Callable[[Any], Any]
"""What stands in a place now -> what stands there with the bug."""


@dataclass(frozen=True, slots=True)
class Bug:
    """A bug in the planner.

    Attributes:
        role: what is broken, one of ``roles.PLACES``.
        what: what is wrong.
        change: makes it wrong.
        survives: why no certificate can refute it; empty where one has to.
        crashes: the error that the planner dies of, or with which its answer is refused; empty
            where it is refuted.
    """

    role: str
    what: str
    change: Change
    survives: str = ""
    crashes: str = ""

    @property
    def name(self) -> str:
        """Role and bug."""
        return f"{self.role}: {self.what}"

    def plant(self, patch: pytest.MonkeyPatch) -> None:
        """Plant it.

        Raises:
            LookupError: if nothing plays its role any more.
        """
        at = place(self.role)
        now = getattr(at.owner, at.name)
        wrong = self.change(now)
        for owner in (at.owner, *_importers(at, now)):
            patch.setattr(owner, at.name, wrong)


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


def _importers(at: Place, function: Any) -> list[Any]:
    """The modules of the program that have imported a function from the one that defines it."""
    if at.owner is not at.module or getattr(function, "__module__", None) != at.module.__name__:
        return []
    return [
        module
        for where, module in list(sys.modules.items())
        if where.partition(".")[0] in ("serendipity", "search", "verify")
        and module is not at.module
        and getattr(module, at.name, None) is function
    ]
