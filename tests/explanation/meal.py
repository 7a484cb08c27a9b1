"""A meal, which a robot can make cheaper."""

from serendipity import Task
from serendipity.testing.builders import task


def meal() -> Task:
    """As in worked case 5 of semantics 10.5: a robot two moves away brings what somebody would fetch."""
    return task(
        init="far",
        goal="full",
        actions={
            "fetch h": " -> food @ 3",
            "eat h": "food -> full @ 1",
            "come r": "far -> near !far @ 1",
            "bring r": "near -> food @ 10",
        },
    )
