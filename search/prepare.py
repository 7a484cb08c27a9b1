"""What can be done for a task before anybody asks for a plan."""

from search.clock import Clock
from search.encoding import encoding
from search.provision import AllActs
from serendipity.model.task import Task


def prepare(task: Task, *, afresh: bool = False) -> None:
    """Pack a task, and look up what robots' actions mention: what takes time linear in the files.

    The first planning call does it otherwise, within its time limit.

    Args:
        task: the task.
        afresh: forget first what earlier calls have left with it.
    """
    if afresh:
        task.forget_derived()
    clock = Clock()
    encoding(task, clock).derived(AllActs, clock)
