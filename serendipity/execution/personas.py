"""Personas, people by name: ``observant``, ``local``, ``noisy:0.1``, ``omniscient``, ``recorded:FILE``."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from random import Random
from typing import Final

from search import PreparedTask
from serendipity.execution.faults import probability
from serendipity.execution.persons import Noisy, Omniscient, Person, Recorded, Replanner
from serendipity.model.errors import InputError, UsageError
from serendipity.model.task.task import Task
from serendipity.recognition.candidates import ObservedGiven, named_actions

PERSONAS: Final = ("recorded:FILE", "omniscient", "observant", "local", "noisy:P")
"""How people are named."""


@dataclass(frozen=True, slots=True)
class Persona:
    """Somebody who acts in a certain way, again and again.

    Attributes:
        name: ``recorded``, ``omniscient``, ``observant``, ``local`` or ``noisy``.
        probability: of ``noisy``: that they do something else in an epoch.
        actions: of ``recorded``: what was written down.
    """

    name: str
    probability: float = 0.0
    actions: tuple[str, ...] = ()

    @property
    def told(self) -> bool:
        """Whether they know the robots' plan."""
        return self.name == "omniscient"

    @property
    def human_model(self) -> str:
        """What robots take them to be, unless somebody says otherwise."""
        return self.name if self.name in ("omniscient", "local") else "observant"

    def person(
        self, task: Task, dice: Random, *, drawn: bool, prepared: PreparedTask | None = None
    ) -> Person:
        """Somebody who acts like that.

        Args:
            dice: for what they leave to chance.
            drawn: whether that includes which of their optimal plans they follow.
            prepared: the task made ready, whose tables they go on with; None: it is made ready.
        """
        if self.name == "omniscient":
            return Omniscient(task)
        if self.name == "noisy":
            return Noisy(task, self.probability, dice, ties=drawn, prepared=prepared)
        if self.name == "recorded":
            return Recorded(task, self.actions)
        return Replanner(task, self.name, dice if drawn else None, prepared)


def persona_from(task: Task, text: str) -> Persona:
    """The persona that a text names.

    Args:
        task: what they act in.
        text: as in ``PERSONAS``; what follows the name stands behind a colon or a blank.

    Raises:
        UsageError: there is no such persona.
        InputError: the file of ``recorded`` is wrong; it says where.
    """
    name, _, rest = text.strip().replace(" ", ":", 1).partition(":")
    rest = rest.strip()
    if name == "recorded" and rest:
        return Persona(name, actions=recorded_actions(task, Path(rest)))
    if name == "noisy" and rest:
        return Persona(name, probability(rest, "noisy"))
    if name in ("omniscient", "observant", "local") and not rest:
        return Persona(name)
    raise UsageError(f"human: expected one of {', '.join(PERSONAS)}, got '{text:.50}'")


def recorded_actions(task: Task, given: ObservedGiven) -> tuple[str, ...]:
    """The actions that were written down, one an epoch; ``noop`` is an epoch of waiting.

    Raises:
        InputError: a line is no action that the human takes part in.
    """
    lines = named_actions(given, "human")
    for name, line in lines:
        ids = task.named.get(name, ())
        if not task.waits(name) and all(task.human not in task.actions[i].participants for i in ids):
            where = given if isinstance(given, str | PathLike) else None
            human = task.agents[task.human]
            raise InputError(f"recorded action '{name}': expected an action of {human}'s", where, line)
    return tuple(name for name, _ in lines)
