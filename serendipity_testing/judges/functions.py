"""A Python function that plans.

    def joint(task, discount): ...              # asked for joint plans: composite, "inf", strict interference
    def any_mode(task, options, human_plan): ...  # asked for whatever there is

Both give None where there is no plan, or names of actions: one after another, or a list for each epoch.
One that has a window to tell gives an :class:`Answer`.  What it can't answer it refuses by raising
``NotImplementedError``.
"""

import inspect
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Any, Final

from serendipity.model import Deadline, Task, UsageError
from serendipity.model.numbers import exact
from serendipity_testing.asking import call_of, settled
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges.claims import TIME_LIMIT, OutsideJudge, Proposal, action_of, plan_of

_ALARM: Final = hasattr(signal, "setitimer")
_JOINT: Final = 2
_EVERY_MODE: Final = 3
_GIVEN: Final = "human_plan"


@dataclass(frozen=True, slots=True)
class Answer:
    """A plan with the window in which the human is not bound to theirs.

    Attributes:
        epochs: names of the actions of each epoch, from the first on.
        window: ``(xi1, xi2)``, epochs from ``xi1`` to ``xi2 - 1``; None: no help.
    """

    epochs: Sequence[Sequence[str]]
    window: tuple[int, int] | None = None


def by_function(function: Callable[..., Any], name: str = "") -> OutsideJudge:
    """A function as a judge.

    Args:
        function: of ``(task, discount)``, or of ``(task, options, human_plan)``: the task, a fraction or
            the :class:`Options` in force with the horizon filled in, and the names of the actions of
            ``pi_H`` (None where the human has no plan alone).
        name: what it is called; by default by the function's own name.

    Raises:
        UsageError: it takes neither two nor three arguments.
    """
    called = name or getattr(function, "__name__", type(function).__name__)
    takes = _takes(function, called)

    def answer(call: PlanCall, deadline: Deadline) -> Proposal:
        try:
            if takes == _JOINT:
                share = exact(call.options.get("discount", "0"), "discount")
                with _ended_after(deadline.left()):
                    said = function(call.task, share)
                return _joint(call.task, said)
            asked = settled(call_of(call))
            with _ended_after(deadline.left()):
                said = function(call.task, asked.options, asked.human_plan_names)
            return _in_epochs(call.task, said)
        except NotImplementedError as error:
            return Proposal("unknown", words=f"not implemented{f': {error}' if str(error) else ''}")
        except _HangsError:
            return Proposal("unknown", words=TIME_LIMIT)

    return OutsideJudge(called, answer, every_mode=takes == _EVERY_MODE)


class _HangsError(BaseException):
    """The time of a function is over; no exception that it would catch."""


@contextmanager
def _ended_after(seconds: float | None) -> Iterator[None]:
    """End a function that takes too long, where signals can: in the main thread, on Unix."""
    if seconds is None or threading.current_thread() is not threading.main_thread() or not _ALARM:
        yield
        return

    def end(_number: int, _frame: FrameType | None) -> None:
        raise _HangsError

    before = signal.signal(signal.SIGALRM, end)
    somebody_elses = signal.setitimer(signal.ITIMER_REAL, max(seconds, 1e-6))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, *somebody_elses)


def _takes(function: Callable[..., Any], name: str) -> int:
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return _JOINT  # what is not written in Python tells nothing
    places = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    needed = sum(p.default is p.empty for p in places)
    if needed <= _EVERY_MODE and _GIVEN in (p.name for p in places):
        return _EVERY_MODE
    for count in (_JOINT, _EVERY_MODE):
        if needed == count or (needed < count and any(p.kind == p.VAR_POSITIONAL for p in parameters)):
            return count
    raise UsageError(
        f"judge '{name}': expected a function of (task, discount) or of (task, options, human_plan),"
        f" got one of {needed} arguments"
    )


def _joint(task: Task, said: Any) -> Proposal:
    return Proposal("infeasible") if said is None else Proposal("optimal", plan_of(task, list(said)))


def _in_epochs(task: Task, said: Any) -> Proposal:
    """The claim of a function of every mode.

    Raises:
        ValueError: it is no answer, or there is no action of a name.
    """
    if said is None:
        return Proposal("infeasible")
    answer = said if isinstance(said, Answer) else Answer(said)
    window = answer.window
    if window is not None:
        start, end = (int(epoch) for epoch in window)
        if not 1 <= start < end:
            raise ValueError(f"window [{start}, {end}): expected 1 <= xi1 < xi2")
        window = (start, end)
    plan: list[int] = []
    epochs: list[int] = []
    state = task.init
    for epoch, names in enumerate(answer.epochs, start=1):
        chosen = [action_of(task, name, state) for name in ([names] if isinstance(names, str) else names)]
        plan += chosen
        epochs += [epoch] * len(chosen)
        actions = [task.actions[i] for i in chosen]
        state = state.difference(*(a.delete for a in actions)).union(*(a.add for a in actions))
    return Proposal("optimal", tuple(plan), epochs=tuple(epochs), window=window)
