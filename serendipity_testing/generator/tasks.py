"""Random small tasks: walks with short cuts, errands, plain STRIPS, families; equal dice give equal tasks."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from random import Random

from serendipity.model import Condition, Task
from serendipity_testing.builders import Builder
from serendipity_testing.generator.families import AGENTS, FAMILIES, SMALL
from verify.base.optimal_plans import OptimalPlans

COSTS = ("1", "1", "1", "2", "3", "0", "0.5", "0.1", "2.5")
_LONGEST = 6
"""Actions of the human's plan in a task of a family."""


def random_task(dice: Random, family: str = "") -> Task:
    """A task with one or two robots, of which a person could work out the answers on a page.

    Args:
        dice: decides everything.
        family: one of ``FAMILIES``, or none of them.
    """
    if family:
        task = _of_family(dice, family)
    else:
        task = dice.choice((corridor, corridor, corridor, strips, strips, errands))(dice)
    task = varied(dice, task, robots_want=0.08 if family else 0.25)
    if dice.random() < (0.02 if family else 0.05):
        task = replace(task, init=task.init.union(task.goal.positive).difference(task.goal.negative))
    return task


def varied(dice: Random, task: Task, *, robots_want: float = 0.25) -> Task:
    """The task, now and then with actions in variants, and with a goal of the robots' own."""
    for _ in range(dice.choice((0, 0, 0, 0, 1, 2))):
        task = _with_variants(dice, task)
    return _with_robot_goal(dice, task) if dice.random() < robots_want else task


def _of_family(dice: Random, family: str) -> Task:
    """A small task whose human needs no long plan: to prove what is best beside one may take a minute."""
    while True:
        size, agents = dice.choice(SMALL[family])
        task = FAMILIES[family](dice, size, AGENTS[:agents])
        worth = OptimalPlans(task).alone.optimum(task.init)
        if worth is None or worth[1] <= _LONGEST:
            return task


def split(task: Task, action: int, fact: int) -> Task:
    """The same task with an action as two variants: where a fact is true, and where it is false."""
    whole = task.actions[action]
    where = replace(whole, pre=_with(whole.pre, fact)), replace(whole, neg=_with(whole.neg, fact))
    return replace(task, actions=(*task.actions[:action], *where, *task.actions[action + 1 :]))


def _with(facts: tuple[int, ...], fact: int) -> tuple[int, ...]:
    return tuple(sorted((*facts, fact)))


def _with_variants(dice: Random, task: Task) -> Task:
    """An action as a disjunctive condition makes it, or a conditional effect."""
    i, fact = dice.randrange(len(task.actions)), dice.randrange(len(task.facts))
    action = task.actions[i]
    if fact in (*action.pre, *action.neg, *action.add, *action.delete):
        return task
    if dice.random() < 0.5:
        other = replace(action, pre=(fact,), neg=())
        varied = replace(task, actions=(*task.actions[: i + 1], other, *task.actions[i + 1 :]))
        return varied if unambiguous(varied) else task
    more = dice.randrange(len(task.facts))
    if more in (*action.add, *action.delete):
        return task
    parted = split(task, i, fact)
    adds = replace(parted.actions[i], add=_with(action.add, more))
    varied = replace(parted, actions=(*parted.actions[:i], adds, *parted.actions[i + 1 :]))
    return varied if unambiguous(varied) else task


def unambiguous(task: Task) -> bool:
    """Whether variants of one action do the same wherever some state allows them both, as PDDL's do."""
    return all(
        (a.add, a.delete) == (b.add, b.delete)
        or not (set(a.pre).isdisjoint(b.neg) and set(b.pre).isdisjoint(a.neg))
        for ids in task.named.values()
        for a, b in combinations([task.actions[i] for i in ids], 2)
    )


def _with_robot_goal(dice: Random, task: Task) -> Task:
    """A goal of robots' on something that they change, and maybe the human, too; it may hold already."""
    theirs = {f for a in task.actions if a.participants != (task.human,) for f in (*a.add, *a.delete)} - {
        *task.goal.positive,
        *task.goal.negative,
    }
    if not theirs:
        return task
    fact = dice.choice(sorted(theirs))
    true = (fact in task.init) == (dice.random() < 0.2)
    return replace(task, robot_goal=Condition((fact,), ()) if true else Condition((), (fact,)))


def corridor(dice: Random, crowds: Sequence[int] = (2, 2, 3), sizes: tuple[int, int] = (3, 6)) -> Task:
    """A walk between places; robots open shortcuts, block ways, or take part in a carry.

    Args:
        crowds: how many agents, one of these.
        sizes: how many places, from and to.
    """
    agents = AGENTS[: dice.choice(crowds)]
    builder = Builder(agents)
    places = [f"at{i}" for i in range(dice.randint(*sizes))]
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
            f"jump{k}", (0,), f"{places[i]} open{k}", f"{places[j]} !{places[i]}", dice.choice(COSTS)
        )
        robot = dice.randrange(1, len(agents))
        needs = dice.choice(("", "ready", "!tired", "!shut"))
        builder.action(
            f"open{k}",
            (robot,),
            needs,
            f"open{k} {dice.choice(('', 'tired', '!ready'))}",
            dice.choice(COSTS),
        )
    for robot in range(1, len(agents)):
        effects = dice.choice(("ready", "shut", "!shut", "ready tired", "!open0"))
        builder.action("prepare", (robot,), "", effects, dice.choice(COSTS))
    if dice.random() < 0.5:
        i, j = sorted(dice.sample(range(len(places)), 2))
        team = tuple(sorted((0, dice.randrange(1, len(agents)))))
        builder.action("carry", team, places[i], f"{places[j]} !{places[i]}", dice.choice(COSTS))
    return builder.task(f"{places[0]} {dice.choice(('', 'ready', 'tired'))}", places[-1])


def errands(dice: Random) -> Task:
    """Robots walk about a building of their own, and do in its rooms what helps or hinders."""
    agents = ("hum", "rob", "bot")
    builder = Builder(agents)
    places = [f"at{i}" for i in range(dice.randint(3, 5))]
    for i, (a, b) in enumerate(pairwise(places)):
        builder.action(f"walk{i}", (0,), a, f"{b} !{a}", dice.choice(("1", "2", "3")))
    rooms = range(dice.randint(2, 4))
    start = []
    for robot in (1, 2):
        step = dice.choice(COSTS)
        start.append(f"{agents[robot]}{dice.choice(rooms)}")
        for i, j in pairwise(rooms):
            for here, there in ((i, j), (j, i)):
                a, b = f"{agents[robot]}{here}", f"{agents[robot]}{there}"
                builder.action(f"go{here}{there}", (robot,), a, f"{b} !{a}", step)
        for k in range(dice.randint(1, 2)):
            needs = dice.choice(("", "", "ready", "!tired", "box"))
            effects = dice.choice(("open0", "open0", "open1", "ready", "box !ready", "open1 tired", "!open0"))
            room = f"{agents[robot]}{dice.choice(rooms)}"
            builder.action(f"deed{k}", (robot,), f"{room} {needs}", effects, dice.choice(COSTS))
    for k in range(2):
        i, j = sorted(dice.sample(range(len(places)), 2))
        jump = f"{places[j]} !{places[i]} {dice.choice(('', '', '!ready'))}"
        builder.action(f"jump{k}", (0,), f"{places[i]} open{k}", jump, dice.choice(COSTS))
    if dice.random() < 0.3:
        start.append(_pushed(dice, builder, rooms))
    if dice.random() < 0.4:
        both = " ".join(f"{agents[robot]}{dice.choice(rooms)}" for robot in (1, 2))
        effects = dice.choice(("open0", "open1", "box ready"))
        builder.action("lift", (1, 2), both, effects, dice.choice(COSTS))
    if dice.random() < 0.4:
        i, j = sorted(dice.sample(range(len(places)), 2))
        robot = dice.choice((1, 2))
        met = f"{places[i]} {agents[robot]}{dice.choice(rooms)} {dice.choice(('', '', 'box'))}"
        builder.action("carry", (0, robot), met, f"{places[j]} !{places[i]}", dice.choice(COSTS))
    init = " ".join((places[0], *start, *dice.sample(("ready", "tired", "box"), dice.randint(0, 2))))
    return builder.task(init, places[-1])


def _pushed(dice: Random, builder: Builder, rooms: range) -> str:
    """A crate that both robots move together, and what it is good for; returns where it is."""
    step = dice.choice(COSTS)
    for i, j in pairwise(rooms):
        for here, there in ((i, j), (j, i)):
            builder.action(f"push{here}{there}", (1, 2), f"crate{here}", f"crate{there} !crate{here}", step)
    needs = f"crate{dice.choice(rooms)} {dice.choice(('', 'ready', 'box'))}"
    builder.action("climb", dice.choice(((1,), (2,), (1, 2))), needs, "open0", dice.choice(COSTS))
    return f"crate{dice.choice(rooms)}"


def strips(
    dice: Random,
    sizes: tuple[int, int] = (3, 7),
    crowds: Sequence[int] = (2, 2, 3),
    costs: Sequence[str] = COSTS,
) -> Task:
    """Random actions, negative preconditions and goals included.

    Args:
        sizes: how many facts, from and to.
        crowds: how many agents, one of these.
        costs: what the human's and joint actions may cost.
    """
    agents = AGENTS[: dice.choice(crowds)]
    builder = Builder(agents)
    facts = [f"f{i}" for i in range(dice.randint(*sizes))]

    def literals(most: int, negated: float) -> str:
        chosen = dice.sample(facts, dice.randint(0, most))
        return " ".join(("!" if dice.random() < negated else "") + fact for fact in chosen)

    for k in range(dice.randint(3, 7)):
        builder.action(
            f"do{k}", (0,), literals(2, 0.25), f"{dice.choice(facts)} {literals(2, 0.6)}", dice.choice(costs)
        )
    for k in range(dice.randint(2, 5)):
        robot = dice.randrange(1, len(agents))
        builder.action(
            f"aid{k}",
            (robot,),
            literals(1, 0.25),
            f"{dice.choice(facts)} {literals(1, 0.6)}",
            dice.choice(COSTS),
        )
    for k in range(dice.randint(0, 2)):
        team = tuple(sorted(dice.sample(range(len(agents)), 2)))
        builder.action(
            f"both{k}",
            team,
            literals(1, 0.25),
            f"{dice.choice(facts)} {literals(1, 0.5)}",
            dice.choice(costs),
        )
    goal = " ".join(
        ("!" if dice.random() < 0.2 else "") + fact for fact in dice.sample(facts, dice.randint(1, 2))
    )
    init = " ".join(dice.sample(facts, dice.randint(0, 3)))
    return builder.task(init, goal)
