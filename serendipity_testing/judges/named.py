"""Judges by what a user calls them: ``package.module:function``, ``up:ENGINE``, a command."""

import sys
from collections.abc import Callable
from contextlib import chdir
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final, cast

from serendipity.model import Deadline, UsageError
from serendipity.model.numbers import exact
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges.claims import OutsideJudge, Proposal
from serendipity_testing.judges.commands import Command
from serendipity_testing.judges.functions import by_function

_ENGINES: Final = "up"


def by_name(name: str) -> OutsideJudge:
    """A Python function, or an engine of unified-planning.

    Raises:
        UsageError: there is none of that name.
    """
    module, _, what = name.partition(":")
    if not module or not what:
        raise UsageError(f"judge: expected 'package.module:function' or 'up:ENGINE', got '{name}'")
    return _engine(name, what) if module == _ENGINES else by_function(function_named(name, "judge"), name)


def by_command(command: str) -> OutsideJudge:
    """A command line; see :class:`Command`.

    Raises:
        UsageError: there is no such program.
    """
    return OutsideJudge(command, Command(command))


def function_named(name: str, role: str) -> Callable[..., Any]:
    """A function by ``package.module:function``; modules of the working directory are found, too.

    Args:
        role: what it is for, in errors.

    Raises:
        UsageError: there is none of that name.
    """
    module, _, what = name.partition(":")
    if not module or not what:
        raise UsageError(f"{role}: expected 'package.module:function', got '{name}'")
    folder = str(Path.cwd())
    if folder not in sys.path:
        sys.path.append(folder)
    try:
        function = getattr(import_module(module), what)
    except (ImportError, AttributeError) as error:
        raise UsageError(f"{role} '{name}': {error}") from None
    if not callable(function):
        raise UsageError(f"{role} '{name}': expected a function, got {type(function).__name__}")
    return cast(Callable[..., Any], function)


def _engine(name: str, engine: str) -> OutsideJudge:
    try:
        from serendipity_up.predicting import counts_actions_only, solve_with
        from serendipity_up.writing import team_problem
    except ImportError as error:
        raise UsageError(f"judge '{name}': {error}") from None

    def answer(call: PlanCall, deadline: Deadline) -> Proposal:
        problem, _ = team_problem(call.task, exact(call.options.get("discount", "0"), "discount"))
        with TemporaryDirectory() as scratch, chdir(scratch):  # some leave files where they are called
            solved = solve_with(engine, problem, deadline.left())
        if solved.actions is not None:
            return Proposal("optimal" if solved.optimal else "feasible", solved.actions)
        return Proposal("infeasible" if solved.impossible else "unknown", words=solved.status.name)

    return OutsideJudge(name, answer, unit_costs=counts_actions_only(engine))
