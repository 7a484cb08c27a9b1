"""A bug to plant, and the tools to plant it with."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest

Plant = Callable[[pytest.MonkeyPatch], None]


@dataclass(frozen=True, slots=True)
class Bug:
    """A bug in the planner.

    Attributes:
        where: module and function.
        what: what is wrong.
        plant: plants it.
        survives: why no certificate can refute it; empty where one has to.
    """

    where: str
    what: str
    plant: Plant
    survives: str = ""


def replaced(owner: Any, name: str, value: Any) -> Plant:
    """``owner.name`` replaced."""
    return lambda patch: patch.setattr(owner, name, value)


def always(value: Any) -> Callable[..., Any]:
    """A function that gives ``value`` whatever it is asked."""
    return lambda *_, **__: value


def wrapped(owner: Any, name: str, around: Callable[..., Any]) -> Plant:
    """A function or method replaced by ``around(original, *arguments)``."""
    original = getattr(owner, name)

    def broken(*arguments: Any, **keywords: Any) -> Any:
        return around(original, *arguments, **keywords)

    return lambda patch: patch.setattr(owner, name, broken)


def everywhere(function: Callable[..., Any], broken: Callable[..., Any]) -> Plant:
    """A function replaced in every module of the program that has imported it by its name."""

    def plant(patch: pytest.MonkeyPatch) -> None:
        name = function.__name__
        for where, module in list(sys.modules.items()):
            ours = where.partition(".")[0] in ("serendipity", "search", "verify")
            if ours and getattr(module, name, None) is function:
                patch.setattr(module, name, broken)

    return plant
