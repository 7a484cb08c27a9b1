"""Calls that are awaited: each works in a thread, and cancelling what awaits it ends its search.

    result = await serendipity.aio.plan(task, discount=0.6)

Whoever is cancelled goes on only once the thread has ended, some hundredths of a second later.
"""

import asyncio
import threading
from collections.abc import AsyncGenerator, Callable, Iterable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Literal, TypeVar, Unpack

from serendipity._siblings import require_siblings

require_siblings("search", "verify")

from serendipity.facade import certify, planning, session  # noqa: E402  # checked before
from serendipity.facade.planning import AnytimeOptions, SessionOptions  # noqa: E402
from serendipity.model import Certificate, Deadline, PlanStep, Result, Task, UsageError  # noqa: E402
from serendipity.model.keywords import listing  # noqa: E402
from serendipity.model.task.plans import PlanEntry  # noqa: E402

__all__ = ["Session", "plan", "plan_anytime", "verify"]

T = TypeVar("T")


@listing
async def plan(
    task: Task,
    *,
    human: Literal["any"] | None = None,
    human_plan: Iterable[PlanEntry] | None = None,
    **options: Unpack[SessionOptions],
) -> Result:
    """As :func:`serendipity.plan`; ``on_improvement`` is called in another thread.

    Args:
        task: the task.
        human: ``"any"`` for whoever can be helped best.
        human_plan: names of the actions that the human is going to do; None predicts them.
        **options: of :func:`serendipity.plan`.
    """
    stop = threading.Event()
    options["deadline"] = _within(options.get("deadline"), stop)
    return await _threaded(partial(planning.plan, task, human=human, human_plan=human_plan, **options), stop)


@listing
async def plan_anytime(
    task: Task, *, human_plan: Iterable[PlanEntry] | None = None, **options: Unpack[AnytimeOptions]
) -> AsyncGenerator[Result, None]:
    """As :func:`serendipity.plan_anytime`: ``async for answer in serendipity.aio.plan_anytime(task): ...``.

    Args:
        task: the task.
        human_plan: names of the actions that the human is going to do; None predicts them.
        **options: of :func:`serendipity.plan_anytime`.
    """
    stop = threading.Event()
    options["deadline"] = _within(options.get("deadline"), stop)
    answers = planning.plan_anytime(task, human_plan=human_plan, **options)
    while (answer := await _threaded(partial(next, answers, None), stop)) is not None:
        yield answer


async def verify(
    task: Task,
    result: Result,
    *,
    solver: Literal["highs", "cbc"] = "highs",
    encoding: Literal["automata", "paper"] = "automata",
    method: Literal["auto", "program", "exhaustive"] = "auto",
    proof: str | Path | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Certificate:
    """As :func:`serendipity.verify`."""
    stop = threading.Event()
    return await _threaded(
        partial(
            certify.verify,
            task,
            result,
            solver=solver,
            encoding=encoding,
            method=method,
            proof=proof,
            time_limit=time_limit,
            memory_limit=memory_limit,
            deadline=_within(deadline, stop),
        ),
        stop,
    )


class Session:
    """A :class:`serendipity.Session` whose calls are awaited, one after another.

    What a call that was cancelled has found is not lost: the next one begins with it.

    Args:
        task: where things stand.
        human_plan: names of the actions that the human is going to do, or None to predict them.
        **options: defaults of every call, as for :func:`serendipity.plan`.
    """

    @listing
    def __init__(
        self, task: Task, *, human_plan: Iterable[PlanEntry] | None = None, **options: Unpack[SessionOptions]
    ) -> None:
        self._hold(session.Session(task, human_plan=human_plan, **options), options.get("deadline"))

    def _hold(self, held: session.Session, deadline: Deadline | None) -> None:
        self._session = held
        self._deadline = deadline
        self._calling = asyncio.Lock()

    @property
    def task(self) -> Task:
        """The task from the present state."""
        return self._session.task

    @property
    def human_plan(self) -> tuple[PlanEntry, ...] | None:
        """The plan of the human; None until it is given or predicted."""
        return self._session.human_plan

    @property
    def rest(self) -> tuple[PlanStep, ...] | None:
        """See :attr:`serendipity.Session.rest`."""
        return self._session.rest

    @listing
    async def plan(self, **options: Unpack[SessionOptions]) -> Result:
        """The best answer from the present state; a second call waits for the first."""
        stop = threading.Event()
        async with self._calling:
            options["deadline"] = _within(options.get("deadline", self._deadline), stop)
            return await _threaded(partial(self._session.plan, **options), stop)

    @listing
    async def plan_anytime(self, **options: Unpack[AnytimeOptions]) -> AsyncGenerator[Result, None]:
        """Answers as they get better; other calls wait until they end, or are closed."""
        stop = threading.Event()
        async with self._calling:
            options["deadline"] = _within(options.get("deadline", self._deadline), stop)
            answers = self._session.plan_anytime(**options)
            while (answer := await _threaded(partial(next, answers, None), stop)) is not None:
                yield answer

    def cancel(self) -> None:
        """End the running call; it returns the incumbent."""
        self._session.cancel()

    def execute(self, actions: Iterable[str]) -> None:
        """See :meth:`serendipity.Session.execute`.

        Raises:
            UsageError: a call is under way; or an action is unknown, or not applicable.
        """
        self._idle().execute(actions)

    def change(self, facts: Mapping[str, bool]) -> None:
        """See :meth:`serendipity.Session.change`.

        Raises:
            UsageError: a call is under way; or there is no such fact.
        """
        self._idle().change(facts)

    def follow(self, names: Iterable[PlanEntry] | None) -> None:
        """See :meth:`serendipity.Session.follow`.

        Raises:
            UsageError: a call is under way.
        """
        self._idle().follow(names)

    def set_goal(self, goal: Iterable[str]) -> None:
        """See :meth:`serendipity.Session.set_goal`.

        Raises:
            UsageError: a call is under way; or there is no such fact.
        """
        self._idle().set_goal(goal)

    def snapshot(self) -> dict[str, Any]:
        """See :meth:`serendipity.Session.snapshot`.

        Raises:
            UsageError: a call is under way; or what the human sees is a function.
        """
        return self._idle().snapshot()

    @classmethod
    def restore(cls, task: Task, snapshot: Mapping[str, Any], **options: Unpack[SessionOptions]) -> "Session":
        """See :meth:`serendipity.Session.restore`; either kind of session takes the other's snapshots.

        Raises:
            InputError: the snapshot is of another task, or none.
        """
        restored = cls.__new__(cls)
        restored._hold(session.Session.restore(task, snapshot, **options), options.get("deadline"))
        return restored

    def _idle(self) -> session.Session:
        if self._calling.locked():
            raise UsageError("session: a call is under way; cancel it, or await it first")
        return self._session


def _within(deadline: Deadline | None, stop: threading.Event) -> Deadline:
    """A deadline that a flag ends, too."""
    return (deadline or Deadline()).within(cancelled=stop)


async def _threaded(work: Callable[[], T], stop: threading.Event) -> T:
    """The result of work in a thread, which a flag ends: whoever is cancelled sets it, and waits for that."""
    working = asyncio.ensure_future(asyncio.to_thread(work))
    try:
        return await asyncio.shield(working)
    except asyncio.CancelledError:
        stop.set()
        while not working.done():
            with suppress(asyncio.CancelledError):  # whoever is cancelled again waits as well
                await asyncio.wait([working])
        if not working.cancelled():
            working.exception()  # nobody asks for it any more
        raise
