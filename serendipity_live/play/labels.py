"""Words that people read instead of PDDL: sentences for a domain's actions and goals, nouns for things."""

import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from string import Formatter
from typing import Annotated, Final, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError

from serendipity.model import GroundAction, InputError, PlanStep, Task
from serendipity.model.task.execution import actions_named
from serendipity.pictures.map.names import parts, without
from serendipity.pictures.map.places import Places
from serendipity.pictures.scene.finder import Finder
from serendipity.scenarios.examples import DATA

_FILE: Final = "labels.toml"

Parsed = tuple[str, tuple[str, ...]]
"""The name of a schema, and its arguments."""


def _sentences(given: object) -> list[str]:
    told = [given] if isinstance(given, str) else given
    if not isinstance(told, list) or not told or not all(isinstance(sentence, str) for sentence in told):
        raise ValueError("expected a sentence")
    for sentence in told:
        try:
            list(_numbers(sentence))
        except ValueError:
            raise ValueError(f"expected {{0}}, {{1}} ... only, got '{sentence}'") from None
    return told


Sentences = Annotated[list[str], BeforeValidator(_sentences)]
"""What each who takes part does, or one sentence for all."""


class DomainLabels(BaseModel):
    """Words for a domain, as a file has them.

    Attributes:
        about: paragraphs on what one does there.
        things: a phrase for a thing or robot, by its name, or by what stands before the number in it;
            ``{}`` is the name.
        actions: what each who takes part does, in the order of the arguments; ``{0}`` is the first of these.
        goals: what to do for a fact to hold, likewise.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    about: list[str] = []
    things: dict[str, str] = {}
    actions: dict[str, Sentences] = {}
    goals: dict[str, Sentences] = {}

    def thing(self, name: str) -> str:
        """A thing or a robot."""
        return self.things.get(name, self.things.get(name.rstrip("0123456789"), "{}")).replace("{}", name)

    def action(self, name: str) -> tuple[list[str], tuple[str, ...]] | None:
        """The sentences of an action, and its arguments; None without a label."""
        schema, arguments = _parsed(name, self.actions)
        return None if schema not in self.actions else (self.actions[schema], arguments)

    def goal(self, fact: str) -> tuple[str, tuple[str, ...]] | None:
        """The sentence of a fact that is wanted, and its arguments; None without a label."""
        schema, arguments = _parsed(fact, self.goals)
        return None if schema not in self.goals else (self.goals[schema][0], arguments)

    def complete(self, task: Task) -> bool:
        """Whether everything that can be done or is wanted in a task has its sentence."""
        wanted = (*task.goal.positive, *task.goal.negative)
        told = {schema for schema, _ in _schemas(task, self.actions)} <= self.actions.keys()
        return told and all(self.goal(task.facts[fact]) for fact in wanted) and self.fault(task) is None

    def fault(self, task: Task) -> str | None:
        """The first sentence that asks for an argument that there is not."""
        named = [(self.actions.get(s, []), a, f"actions.{s}") for s, a in _schemas(task, self.actions)]
        for fact in (*task.goal.positive, *task.goal.negative):
            schema, arguments = _parsed(task.facts[fact], self.goals)
            named.append((self.goals.get(schema, []), arguments, f"goals.{schema}"))
        for sentences, arguments, where in named:
            most = max((number for s in sentences for number in _numbers(s)), default=-1)
            if most >= len(arguments):
                return f"{where}: there is no {{{most}}}, only {len(arguments)} arguments"
        return None


def labels_for(task: Task, file: Path | None = None) -> DomainLabels:
    """The labels of a file, or else those that are shipped for the task's domain, if any are."""
    if file is not None:
        labels = read_settings(file, DomainLabels)
        if fault := labels.fault(task):
            raise InputError(fault, file)
        return labels
    shipped = (read_settings(file, DomainLabels) for file in sorted(DATA.glob(f"*/{_FILE}")))
    return next((labels for labels in shipped if labels.complete(task)), DomainLabels())


def _numbers(sentence: str) -> Iterator[int]:
    for _, name, form, conversion in Formatter().parse(sentence):
        if name is not None:
            if form or conversion or not name.isdecimal():
                raise ValueError(name)
            yield int(name)


def _parsed(name: str, known: Mapping[str, object]) -> Parsed:
    """The schema of a name, and what comes behind it; in ground files ``_`` stands between all of it."""
    words = tuple(name.split())
    if len(words) > 1 or words[0] in known:
        return words[0], words[1:]
    split = parts(name)
    fitting = [schema for schema in known if split[: len(parts(schema))] == parts(schema)]
    schema = max(fitting, key=len, default=split[0])
    return schema, split[len(parts(schema)) :]


def _schemas(task: Task, known: Mapping[str, object]) -> set[Parsed]:
    """One action of each schema and number of arguments."""
    found = {}
    for action in task.actions:
        schema, arguments = _parsed(action.name, known)
        found[schema, len(arguments)] = arguments
    return {(schema, arguments) for (schema, _), arguments in found.items()}


class Phrases:
    """Words for a task, said to its human; what has no label in its domain is said by its name."""

    def __init__(
        self, task: Task, places: Places, labels: DomainLabels, say: Callable[..., str] = str.format
    ) -> None:
        self._say = say
        self._task = task
        self._finder = Finder(places)
        self._labels = labels

    def target(self, action: GroundAction) -> str | None:
        """The place that an action of the human's own leads to; None where it leads nowhere."""
        return self._finder.target(action, self._task.human)

    def action(self, action: GroundAction, who: int | None = None) -> str:
        """What somebody does who takes part in an action; by default the human, or else who comes first."""
        labelled = self._labels.action(action.name)
        if labelled is not None:
            return self._labelled(action, *labelled, who)
        return " ".join(self._finder.phrase(action, self._task.agents)).rstrip()

    def _labelled(
        self, action: GroundAction, sentences: Sequence[str], arguments: Sequence[str], who: int | None
    ) -> str:
        agents, human = self._task.agents, self._task.human
        named = [name for name in arguments if name in {agents[i] for i in action.participants}]
        if who is None:
            who = human if human in action.participants else action.participants[0]
        place = named.index(agents[who]) if agents[who] in named else 0
        return sentences[min(place, len(sentences) - 1)].format(*map(self.thing, arguments))

    def step(self, step: PlanStep, who: int | None = None) -> str:
        """What a step of a plan is, as :meth:`action` says it."""
        return self.action(self._task.actions[actions_named(self._task, step.action, step.agents)[0]], who)

    def thing(self, name: str) -> str:
        """A thing, a robot, or ``you``."""
        return self._say("you") if name == self._task.agents[self._task.human] else self._labels.thing(name)

    def robots(self, step: PlanStep) -> str:
        """The robots of a step."""
        human = self._task.agents[self._task.human]
        return self._say(" and ").join(self._labels.thing(agent) for agent in step.agents if agent != human)

    def fact(self, fact: int) -> str:
        """A fact, in words."""
        return " ".join(parts(self._task.facts[fact])).replace("_", " ").replace("-", " ")

    def goal(self, known: frozenset[int]) -> list[dict[str, str | bool]]:
        """What the person wants, fact by fact, and what of it they know to hold."""
        goal = self._task.goal
        said: list[dict[str, str | bool]] = []
        for fact in (*goal.positive, *goal.negative):
            wanted = fact in goal.positive
            words = self._wish(self._task.facts[fact])
            said.append(
                {
                    "text": words if wanted else self._say("not {fact}", fact=words),
                    "holds": (fact in known) == wanted,
                }
            )
        return said

    def _wish(self, fact: str) -> str:
        labelled = self._labels.goal(fact)
        if labelled is not None:
            return labelled[0].format(*map(self.thing, labelled[1]))
        human = parts(self._task.agents[self._task.human])
        return " ".join(without([human], parts(fact))).replace("_", " ")


Held = TypeVar("Held", bound=BaseModel)


def read_settings(file: Path, model: type[Held]) -> Held:
    """What a file holds."""
    try:
        return model.model_validate(tomllib.loads(file.read_text(encoding="utf-8-sig")))
    except OSError as error:
        raise InputError(f"can't be read: {(error.strerror or '').lower()}", file) from None
    except UnicodeDecodeError:
        raise InputError("expected a text in UTF-8", file) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"expected TOML: {str(error)[:1].lower()}{str(error)[1:]}", file) from None
    except RecursionError:
        raise InputError("is nested too deeply", file) from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        said = first["msg"].removeprefix("Value error, ")
        said = said[:1].lower() + said[1:]
        raise InputError(f"{where}: {said}", file) from None
