"""Planning calls as values, and seeded random ones."""

from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from random import Random
from typing import Any

from serendipity.model import Condition, GroundAction, Task

_COSTS = ("1", "1", "1", "2", "3", "0", "0.5", "0.1", "2.5")
_DISCOUNTS = ("0", "0.25", "0.5", "0.6", "0.9", "1")
_CHOICES: dict[str, tuple[str, ...]] = {
    "window_weight": ("1000", "1000", "0", "0.25", "0.75", "2"),
    "max_window": ("", "", "1", "2"),
    "suffix": ("", "", "subplan"),
    "preservation": ("", "", "", "state"),
    "interference": ("", "", "strict"),
    "max_cost": ("", "", "", "human", "3"),
    "ties": ("", "", "", "optimistic", "robust", "expected"),
}


@dataclass(frozen=True)
class PlanCall:
    """A task and the options of ``plan`` that are not the default, as text.

    Attributes:
        human_plan: names of the actions of ``pi_H`` where it is given.
    """

    task: Task
    options: dict[str, str] = field(default_factory=dict)
    human_plan: tuple[str, ...] | None = None

    def keywords(self) -> dict[str, Any]:
        """The options as the facade takes them."""
        return {
            name: value == "true" if name == "keep_prefix" else value for name, value in self.options.items()
        }


def random_call(seed: int) -> PlanCall:
    """A small random task with random options; equal seeds give equal calls."""
    # Dice of their own: the calls of other seeds are what they were without errands.
    errands = Random(f"errands {seed}")
    if errands.random() < 0.2:
        return PlanCall(_errands(errands), _options(errands))
    dice = Random(f"crosscheck {seed}")
    task = _corridor(dice) if dice.random() < 0.6 else _strips(dice)
    return PlanCall(task, _options(dice))


def _options(dice: Random) -> dict[str, str]:
    mode = dice.choice(("serendipity", "serendipity", "communication", "composite", "individual"))
    chosen = {"mode": mode, "discount": dice.choice(_DISCOUNTS)}
    for name, values in _CHOICES.items():
        value = dice.choice(values)
        if value:
            chosen[name] = value
    if mode == "communication":
        chosen["communication_weight"] = dice.choice(("0", "0.25", "1"))
        if dice.random() < 0.3:
            chosen["keep_prefix"] = "true"
    if dice.random() < 0.4 and mode != "individual":
        chosen["horizon"] = dice.choice(("3", "4", "5", "6"))
    return chosen


class _Builder:
    """Facts by name, numbered as they come up."""

    def __init__(self, agents: tuple[str, ...]) -> None:
        self.agents = agents
        self.facts: list[str] = []
        self.actions: list[GroundAction] = []

    def fact(self, name: str) -> int:
        if name not in self.facts:
            self.facts.append(name)
        return self.facts.index(name)

    def action(self, name: str, agents: tuple[int, ...], pre: str, effects: str, cost: str) -> None:
        """An action; ``!`` in front of a fact negates it."""
        needs, changes = self._literals(pre), self._literals(effects)
        delete = tuple(f for f in changes.negative if f not in changes.positive)
        who = " ".join(self.agents[i] for i in agents)
        ground = GroundAction(
            f"{name} {who}", agents, needs.positive, needs.negative, changes.positive, delete, Fraction(cost)
        )
        self.actions.append(ground)

    def task(self, init: str, goal: str, robot_goal: str = "") -> Task:
        wanted, own = self._literals(goal), self._literals(robot_goal)
        return Task(
            name="random",
            agents=self.agents,
            human=0,
            init=frozenset(self._literals(init).positive),
            goal=wanted,
            robot_goal=own,
            facts=tuple(self.facts),
            actions=tuple(sorted(self.actions, key=lambda action: action.key)),
        )

    def _literals(self, text: str) -> Condition:
        words = text.split()
        positive = {self.fact(word) for word in words if word[0] != "!"}
        negative = {self.fact(word[1:]) for word in words if word[0] == "!"}
        return Condition(tuple(sorted(positive)), tuple(sorted(negative - positive)))


def _corridor(dice: Random) -> Task:
    """A walk between places; robots open shortcuts, block ways, or take part in a carry."""
    agents = ("hum", "rob", "bot")[: dice.choice((2, 2, 3))]
    builder = _Builder(agents)
    places = [f"at{i}" for i in range(dice.randint(3, 6))]
    for i, (a, b) in enumerate(pairwise(places)):
        cost = dice.choice(("1", "2", "3"))
        builder.action(f"walk{i}", (0,), a, f"{b} !{a}", cost)
        if dice.random() < 0.5:
            builder.action(f"back{i}", (0,), f"{b} {dice.choice(('', '!shut'))}", f"{a} !{b}", cost)
        if dice.random() < 0.3:
            builder.action(f"stroll{i}", (0,), a, f"{b} !{a}", cost)
    for k in range(dice.randint(1, 3)):
        i, j = sorted(dice.sample(range(len(places)), 2))
        builder.action(
            f"jump{k}", (0,), f"{places[i]} open{k}", f"{places[j]} !{places[i]}", dice.choice(_COSTS)
        )
        robot = dice.randrange(1, len(agents))
        needs = dice.choice(("", "ready", "!tired", "!shut"))
        builder.action(
            f"open{k}",
            (robot,),
            needs,
            f"open{k} {dice.choice(('', 'tired', '!ready'))}",
            dice.choice(_COSTS),
        )
    for robot in range(1, len(agents)):
        effects = dice.choice(("ready", "shut", "!shut", "ready tired", "!open0"))
        builder.action("prepare", (robot,), "", effects, dice.choice(_COSTS))
    if dice.random() < 0.5:
        i, j = sorted(dice.sample(range(len(places)), 2))
        team = tuple(sorted((0, dice.randrange(1, len(agents)))))
        builder.action("carry", team, places[i], f"{places[j]} !{places[i]}", dice.choice(_COSTS))
    robot_goal = "tired" if dice.random() < 0.1 else ""
    return builder.task(f"{places[0]} {dice.choice(('', 'ready', 'tired'))}", places[-1], robot_goal)


def _errands(dice: Random) -> Task:
    """Robots walk about a building of their own, and do in its rooms what helps or hinders."""
    agents = ("hum", "rob", "bot")
    builder = _Builder(agents)
    places = [f"at{i}" for i in range(dice.randint(3, 5))]
    for i, (a, b) in enumerate(pairwise(places)):
        builder.action(f"walk{i}", (0,), a, f"{b} !{a}", dice.choice(("1", "2", "3")))
    rooms = range(dice.randint(2, 4))
    start = []
    for robot in (1, 2):
        step = dice.choice(_COSTS)
        start.append(f"{agents[robot]}{dice.choice(rooms)}")
        for i, j in pairwise(rooms):
            for here, there in ((i, j), (j, i)):
                a, b = f"{agents[robot]}{here}", f"{agents[robot]}{there}"
                builder.action(f"go{here}{there}", (robot,), a, f"{b} !{a}", step)
        for k in range(dice.randint(1, 2)):
            needs = dice.choice(("", "", "ready", "!tired", "box"))
            effects = dice.choice(("open0", "open0", "open1", "ready", "box !ready", "open1 tired", "!open0"))
            room = f"{agents[robot]}{dice.choice(rooms)}"
            builder.action(f"deed{k}", (robot,), f"{room} {needs}", effects, dice.choice(_COSTS))
    for k in range(2):
        i, j = sorted(dice.sample(range(len(places)), 2))
        jump = f"{places[j]} !{places[i]} {dice.choice(('', '', '!ready'))}"
        builder.action(f"jump{k}", (0,), f"{places[i]} open{k}", jump, dice.choice(_COSTS))
    if dice.random() < 0.4:
        both = " ".join(f"{agents[robot]}{dice.choice(rooms)}" for robot in (1, 2))
        effects = dice.choice(("open0", "open1", "box ready"))
        builder.action("lift", (1, 2), both, effects, dice.choice(_COSTS))
    if dice.random() < 0.4:
        i, j = sorted(dice.sample(range(len(places)), 2))
        robot = dice.choice((1, 2))
        met = f"{places[i]} {agents[robot]}{dice.choice(rooms)} {dice.choice(('', '', 'box'))}"
        builder.action("carry", (0, robot), met, f"{places[j]} !{places[i]}", dice.choice(_COSTS))
    init = " ".join((places[0], *start, *dice.sample(("ready", "tired", "box"), dice.randint(0, 2))))
    return builder.task(init, places[-1])


def _strips(dice: Random) -> Task:
    """Random actions, negative preconditions and goals included."""
    agents = ("hum", "rob", "bot")[: dice.choice((2, 2, 3))]
    builder = _Builder(agents)
    facts = [f"f{i}" for i in range(dice.randint(3, 7))]

    def literals(most: int, negated: float) -> str:
        chosen = dice.sample(facts, dice.randint(0, most))
        return " ".join(("!" if dice.random() < negated else "") + fact for fact in chosen)

    for k in range(dice.randint(3, 7)):
        builder.action(
            f"do{k}", (0,), literals(2, 0.25), f"{dice.choice(facts)} {literals(2, 0.6)}", dice.choice(_COSTS)
        )
    for k in range(dice.randint(2, 5)):
        robot = dice.randrange(1, len(agents))
        builder.action(
            f"aid{k}",
            (robot,),
            literals(1, 0.25),
            f"{dice.choice(facts)} {literals(1, 0.6)}",
            dice.choice(_COSTS),
        )
    for k in range(dice.randint(0, 2)):
        team = tuple(sorted(dice.sample(range(len(agents)), 2)))
        builder.action(
            f"both{k}",
            team,
            literals(1, 0.25),
            f"{dice.choice(facts)} {literals(1, 0.5)}",
            dice.choice(_COSTS),
        )
    goal = " ".join(
        ("!" if dice.random() < 0.2 else "") + fact for fact in dice.sample(facts, dice.randint(1, 2))
    )
    init = " ".join(dice.sample(facts, dice.randint(0, 3)))
    return builder.task(init, goal)
