"""The cases of a season: tasks, what the person may be about to do, and the proved optimum of each.

Who knows a season's name can make it again, and nobody else: seeds are hashes of it.
"""

import hashlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any, Final

from search import PreparedTask, optimal_human_plans
from serendipity.facade.planning import plan
from serendipity.model import Condition, Deadline, HumanPlan, Result, Task, UsageError
from serendipity.model.numbers import as_written
from serendipity.scenarios.generate import random_usar
from serendipity.scenarios.usar import HUMAN, random_building
from serendipity_testing.builders import Builder, usar
from serendipity_testing.generator import FAMILIES, family_task

FREE: Final[Mapping[str, Any]] = {"discount": 1, "window_weight": 0}
"""What is asked: what the person pays at least, whoever does what when; robots' work is free."""

_MOST: Final = 3
"""Plans that are possible in a case."""

LONGEST: Final = 25
"""Epochs of a plan of the person's: to prove what is best beside a longer one may take minutes."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """Something that the person may be about to do.

    Attributes:
        name: for helpers and tables.
        probability: above 0; those of a case add up to 1.
        goal: what it is for.
        plan: one of their cheapest to it, by action ids.
        alone: what it costs them.
    """

    name: str
    probability: Fraction
    goal: Condition
    plan: HumanPlan
    alone: Fraction


@dataclass(frozen=True, slots=True)
class Case:
    """A task, what the person may be about to do in it, and what they would pay at least.

    Attributes:
        name: season, family and number.
        family: ``buildings``, ``homes``, ``competition``, or ``given``.
        task: where each run begins.
        scenarios: of which one is true; a helper that knows the plan has a single one.
        result: the answer to all of them: the least that the person pays in the mean.
    """

    name: str
    family: str
    task: Task
    scenarios: tuple[Scenario, ...]
    result: Result

    @property
    def horizon(self) -> int:
        """Epochs in which the person gets there alone, whatever they want."""
        return max(len(one.plan) for one in self.scenarios)

    @property
    def torn(self) -> bool:
        """Whether different goals are possible."""
        return len({one.goal for one in self.scenarios}) > 1

    @property
    def proved(self) -> bool:
        """Whether the optimum is proved."""
        return self.result.status == "optimal"

    @property
    def optimum(self) -> Fraction:
        """What the person pays at least in the mean; without a proof, no more than that."""
        least = self.result.cost if self.proved else self.result.lower_bound
        return Fraction(0) if least is None else as_written(least)

    def library(self) -> list[dict[str, Any]]:
        """The scenarios as a library of plans."""
        return _library(self.task, self.scenarios)


def season(
    name: str,
    families: Iterable[str] | None = None,
    count: int = 10,
    tasks: Iterable[Task] = (),
    time_limit: float = 20,
) -> Iterator[Case]:
    """The cases of a season.

    Args:
        name: of the season.
        families: of ``GENERATORS``; None: all, but none where there are tasks.
        count: cases of each.
        tasks: others, each a case by itself.
        time_limit: seconds for each proof.

    Raises:
        UsageError: there is no such family.
    """
    given = tuple(tasks)
    chosen = (() if given else tuple(GENERATORS)) if families is None else tuple(families)
    for family in chosen:
        if family not in GENERATORS:
            raise UsageError(f"families: expected some of {', '.join(GENERATORS)}, got '{family:.50}'")
    for family in chosen:
        seeds = sealed(name, family)
        for number in range(1, count + 1):
            made = (_drawn(Random(seed), family) for seed in seeds)
            task, scenarios = next(one for one in made if one is not None)
            yield _case(f"{name} {family} {number}", family, task, scenarios, time_limit)
    for number, task in enumerate(given, start=1):
        dice = Random(next(sealed(name, f"given {number} {task.name}")))
        known = _scenarios(dice, task, [task.goal])
        if known is None:
            raise UsageError(f"{task.name}: expected a person who has 2 to {LONGEST} actions to do alone")
        yield _case(f"{name} given {number} {task.name}", "given", task, known, time_limit)


def sealed(name: str, of: str) -> Iterator[int]:
    """Seeds that nobody can tell who does not know the name."""
    number = 0
    while True:
        yield int.from_bytes(hashlib.sha256(f"{name}\n{of}\n{number}".encode()).digest()[:8])
        number += 1


def _case(name: str, family: str, task: Task, scenarios: tuple[Scenario, ...], time_limit: float) -> Case:
    result = plan(task, plans=_library(task, scenarios), time_limit=time_limit, **FREE)
    return Case(name, family, task, scenarios, result)


def _library(task: Task, scenarios: Iterable[Scenario]) -> list[dict[str, Any]]:
    return [
        {
            "name": one.name,
            "probability": one.probability,
            "goal": list(one.goal.literals(task.facts)),
            "plan": [task.actions[i].name for i in one.plan],
        }
        for one in scenarios
    ]


def _drawn(dice: Random, family: str) -> tuple[Task, tuple[Scenario, ...]] | None:
    """A task and its scenarios: every second time their plan is known; None where there is nothing to see."""
    task, goals = GENERATORS[family](dice)
    scenarios = _scenarios(dice, task, goals if dice.random() < 0.5 else goals[:1])
    return None if scenarios is None or not any(one.alone for one in scenarios) else (task, scenarios)


def _scenarios(dice: Random, task: Task, goals: Sequence[Condition]) -> tuple[Scenario, ...] | None:
    """A cheapest plan to each goal, drawn; None where robots want something, or nobody has a way to go."""
    if task.robot_goal:
        return None
    plans = dict[tuple[Condition, HumanPlan], None]()
    for goal in goals:
        graph = optimal_human_plans(PreparedTask(task.with_goal(goal)), Deadline())
        if graph is not None and 2 <= len(drawn := graph.drawn(dice.choice)) <= LONGEST:
            plans[goal, drawn] = None
    weights = [dice.choice((1, 1, 2, 3)) for _ in plans]
    return (
        tuple(
            Scenario(f"plan {i}", Fraction(weight, sum(weights)), goal, chosen, task.cost_of(chosen))
            for i, ((goal, chosen), weight) in enumerate(zip(plans, weights, strict=True), start=1)
        )
        or None
    )


_Drawn = tuple[Task, list[Condition]]
"""A task, and goals that the person may have in it, the task's first; one that comes twice: another way."""


def _building(dice: Random) -> _Drawn:
    map_ = random_building(dice.randint(8, 14), seed=dice.getrandbits(32))
    drawn = random_usar(map_, name="", medkits=2, robots=dice.choice((1, 1, 2)), seed=dice.getrandbits(32))
    task = usar(
        " ".join("-".join(pair) for pair in map_.connections),
        human=drawn.agents_at[0],
        human_name=HUMAN,
        robots=dict(zip(drawn.robots, drawn.agents_at[1:], strict=True)),
        kits=drawn.medkits,
        triage=drawn.triage_in,
        delivered=False,
    )
    others = dice.sample(map_.locations, _MOST - 1)
    rooms = dict.fromkeys((drawn.triage_in, *others))
    facts = {name: i for i, name in enumerate(task.facts)}
    return task, [Condition((facts[f"conducted_triage {HUMAN} {room}"],), ()) for room in rooms]


_ROOMS: Final = ("bed", "table", "cupboard", "fridge")
_BOXES: Final = _ROOMS[2:]
_THINGS: Final = ("bowl", "cereal", "milk")


def _home(dice: Random) -> _Drawn:
    """Ann uses a thing at the table that is kept in a cupboard or a fridge, which has to be shut again."""
    built = Builder(("ann", "robot"), "home")
    for thing in _THINGS:
        built.named(f"use ann {thing}", (0,), f"at_ann_table {thing}_table", f"used_{thing}")
    for who, name in enumerate(built.agents):
        for here in _ROOMS:
            for there in _ROOMS:
                if here != there:
                    effects = f"at_{name}_{there} !at_{name}_{here}"
                    built.named(f"walk {name} {here} {there}", (who,), f"at_{name}_{here}", effects)
            reach = f"at_{name}_{here} open_{here}" if here in _BOXES else f"at_{name}_{here}"
            for thing in _THINGS:
                free, there, held = f"free_{name}", f"{thing}_{here}", f"{name}_has_{thing}"
                taken, put = f"{held} !{free} !{there}", f"{free} {there} !{held}"
                built.named(f"take {name} {thing} {here}", (who,), f"{reach} {free} {there}", taken)
                built.named(f"put {name} {thing} {here}", (who,), f"{reach} {held}", put)
        for box in _BOXES:
            at = f"at_{name}_{box}"
            built.named(f"open {name} {box}", (who,), f"{at} !open_{box}", f"open_{box}")
            built.named(f"shut {name} {box}", (who,), f"{at} open_{box}", f"!open_{box}")
    things = [f"{thing}_{dice.choice(_ROOMS[:1] + _BOXES * 2)}" for thing in _THINGS]
    first, second, _ = dice.sample(_THINGS, 3)
    start = [f"at_ann_{dice.choice(_ROOMS)}", f"at_robot_{dice.choice(_ROOMS)}", "free_ann", "free_robot"]
    task = built.task(" ".join((*start, *things)), " ".join(f"!open_{box}" for box in _BOXES))
    facts = {name: i for i, name in enumerate(task.facts)}
    goals = [Condition((facts[f"used_{thing}"],), task.goal.negative) for thing in (first, second)]
    return task.with_goal(goals[0]), goals


def _competition(dice: Random) -> _Drawn:
    """A task as in planning competitions, of a family of ``serendipity crosscheck``."""
    name, seed = dice.choice(sorted(FAMILIES)), dice.getrandbits(32)
    task = family_task(name, seed, {"blocks": 3, "logistics": 2, "switches": 6}[name], dice.choice((2, 2, 3)))
    return task, [task.goal] * _MOST


GENERATORS: Final[Mapping[str, Callable[[Random], _Drawn]]] = {
    "buildings": _building,
    "homes": _home,
    "competition": _competition,
}
"""What makes the tasks of a family, of dice."""
