"""Facts that an agent sees from where it is (semantics 6, the ``local`` human).

*Parts* of a fact: its PDDL arguments; of a name without blanks, as in ground files,
everything between ``_``.  A *location fact* says where somebody or something is: its
last part is a place, the one before it who is there.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain

from serendipity.model.task.actions import GroundAction, State, apply
from serendipity.model.task.task import Task
from serendipity.model.task.variables import Variable, find_variables

Visible = Callable[[int, int, State], bool]
"""``visible(agent, fact, state)``: whether the agent sees in ``state`` if the fact is true."""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The default of what is visible: what is where the agent is.

    Places are the values of the human's position: the exactly-one group with most
    facts of the form ``predicate human place``, as if every action took one epoch.
    Where there is none, everything is in one place, and visible.

    Attributes:
        parts: per fact id the words that it is about.
        located: per location fact who or what it places, and where.
    """

    agents: tuple[str, ...]
    parts: tuple[frozenset[str], ...]
    located: Mapping[int, tuple[str, str]]

    def visible(self, agent: int, fact: int, state: State) -> bool:
        """Whether one of the fact's parts is the agent's place, or is somebody or something there."""
        if not self.located:
            return True
        return not self.parts[fact].isdisjoint(self.near(agent, state))

    def near(self, agent: int, state: State) -> frozenset[str]:
        """The agent's place, and who and what is there."""
        here = [self.located[f] for f in state if f in self.located]
        places = {place for who, place in here if who == self.agents[agent]}
        return frozenset(chain(places, (who for who, place in here if place in places)))


def _untimed() -> None:
    """No deadline."""


def surroundings(task: Task, tick: Callable[[], None] = _untimed) -> Surroundings:
    """The surroundings of a task; ``tick`` is called every so often, and what it raises ends the work."""
    task = task.in_time or task
    words, parts = [], []
    for name in task.facts:
        tick()
        said = name.split() if " " in name else name.split("_")
        words.append(said)
        parts.append(frozenset(said[1:] if " " in name else said))
    return Surroundings(task.agents, tuple(parts), dict(_location_facts(task, words, tick)))


def _variables_at_once(task: Task) -> tuple[Variable, ...]:
    """The variables if each action took one epoch: who goes for a while is at one place, then at another."""
    going_on = [_at_once(deed.variants[0]) for deed in task.script.begun(1)]
    return find_variables(task.facts, apply(task.init, *going_on), [*map(_at_once, task.actions)])


def _at_once(action: GroundAction) -> GroundAction:
    timing = action.timing
    if timing is None:
        return action
    asked = {*action.pre, *timing.over_all.positive, *timing.at_end.positive}.difference(timing.start_add)
    add = {*timing.start_add, *action.add}.difference(action.delete)
    delete = {*timing.start_delete, *action.delete}.difference(add)
    pre, add_, delete_ = (tuple(sorted(facts)) for facts in (asked, add, delete))
    return replace(action, timing=None, pre=pre, add=add_, delete=delete_)


def _location_facts(
    task: Task, words: list[list[str]], tick: Callable[[], None]
) -> Iterator[tuple[int, tuple[str, str]]]:
    """Location facts: predicates of positions, with a place of the human as the last word."""
    variables = _variables_at_once(task) if task.needs_time else task.variables
    groups = [v.facts for v in variables if not v.boolean]
    human = task.agents[task.human]
    his = [[f for f in facts if len(words[f]) > 2 and words[f][-2] == human] for facts in groups]
    position = max(his, key=len, default=[])
    if len(position) < 2:
        return
    places = Counter(words[f][-1] for f in position)
    grouped = {f for facts in groups for f in facts}
    tick()
    facts = [f for f, w in enumerate(words) if len(w) > 2 and w[-1] in places]
    predicates = {tuple(words[f][:-2]) for f in facts if f in grouped}
    for f in facts:
        tick()
        if tuple(words[f][:-2]) in predicates:
            yield f, (words[f][-2], words[f][-1])
