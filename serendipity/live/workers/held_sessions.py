"""Sessions that a worker has at hand; each can be put together again from what the server remembers."""

from collections import OrderedDict
from collections.abc import Mapping
from typing import Any

from serendipity.facade.call import options_from
from serendipity.facade.session import Session
from serendipity.live.workers.given_tasks import GivenTasks
from serendipity.model import Deadline, Task

Remembered = Mapping[str, Any]
"""``id`` and ``version``; ``begun``, the request that began it; ``state``, as :meth:`HeldSessions.keep`
has it, or None at the beginning."""


class HeldSessions:
    """The sessions that were used last, by id and version.

    Args:
        most: how many are held.
        tasks: reads their tasks.
    """

    def __init__(self, most: int, tasks: GivenTasks) -> None:
        self._most = most
        self._tasks = tasks
        self._held: OrderedDict[str, tuple[int, Session]] = OrderedDict()

    def session(self, remembered: Remembered, deadline: Deadline) -> Session:
        """A session as it stands; the one that is held is taken out, in case that what comes fails halfway.

        Raises:
            SerendipityError: it is new, and its task or its options are wrong.
        """
        version, held = self._held.pop(remembered["id"], (None, None))
        if held is not None and version == remembered["version"]:
            return held
        begun = remembered["begun"]
        task = self._tasks.task(begun["task"], deadline)
        options = begun["options"]
        options_from(dict(options))
        state = remembered["state"]
        if state is None:
            return Session(task, human_plan=begun["human_plan"], **options)
        session = Session(_moved(task, state), human_plan=state["human_plan"], **options)
        session._remind(state["known"])
        return session

    def keep(self, remembered: Remembered, session: Session) -> dict[str, Any]:
        """Hold a session as its next version; what has to be remembered of it."""
        self._held[remembered["id"]] = (remembered["version"] + 1, session)
        while len(self._held) > self._most:
            self._held.popitem(last=False)
        return stands(session)


def stands(session: Session) -> dict[str, Any]:
    """Where a session stands: the true facts, the human's goal, and what they are going to do, if known.

    ``known`` is what is left of its answers.
    """
    task = session.task
    return {
        "facts": [task.facts[fact] for fact in sorted(task.init)],
        "goal": [
            *(task.facts[fact] for fact in task.goal.positive),
            *(f"!{task.facts[fact]}" for fact in task.goal.negative),
        ],
        "human_plan": None if session.human_plan is None else list(session.human_plan),
        "known": session._remembered(),
    }


def _moved(task: Task, state: Mapping[str, Any]) -> Task:
    """The task from another state, with another goal."""
    fresh = Session(task)
    fresh.set_goal(state["goal"])
    true = frozenset(state["facts"])
    fresh.change({fact: fact in true for fact in task.facts})
    return fresh.task
