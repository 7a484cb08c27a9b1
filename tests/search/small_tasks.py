"""Small tasks that several tests ask about, and what is true of their packed states."""

from collections.abc import Iterable
from itertools import pairwise, product
from random import Random

from search import PreparedTask
from search.call.context import SearchContext
from search.engine.best_first import Incumbent
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedTask
from search.short_windows.question import ShortWindowQuestion
from serendipity.model import Deadline, Options, Task
from serendipity_testing.builders import task as build
from serendipity_testing.builders import usar
from serendipity_testing.generator.families import AGENTS, FAMILIES, SMALL

CORRIDOR = usar("a-b-c-d", human="a", robots={"r": "d"}, kits={"m": "d"}, triage="a")
"""The kit is at the other end."""

ONE_EPOCH = Options(mode="serendipity", max_window=1)


def of_a_family(dice: Random) -> Task:
    """A task of any family that brute force can answer."""
    family = dice.choice(sorted(FAMILIES))
    size, agents = dice.choice(SMALL[family])
    return FAMILIES[family](dice, size, AGENTS[:agents])


def tower(names: str, hands: str, goal: str = "", more: dict[str, str] | None = None) -> Task:
    """A tower to be turned over, by hands of agents; they may do more, for a goal beside it."""
    actions = {**(more or {})}
    for hand in hands:
        for x in names:
            held = f"held_{hand}_{x}"
            taken, put = f"!clear_{x} {held} !free_{hand}", f"clear_{x} free_{hand} !{held}"
            actions[f"lift {hand} {x}"] = f"clear_{x} table_{x} free_{hand} -> {taken} !table_{x}"
            actions[f"drop {hand} {x}"] = f"{held} -> {put} table_{x}"
            for y in names.replace(x, ""):
                ready = f"clear_{x} on_{x}_{y} free_{hand}"
                actions[f"take {hand} {x} {y}"] = f"{ready} -> {taken} !on_{x}_{y} clear_{y}"
                actions[f"put {hand} {x} {y}"] = f"{held} clear_{y} -> {put} on_{x}_{y} !clear_{y}"
    stands = [f"on_{above}_{below}" for above, below in pairwise(names)]
    turned = [f"on_{below}_{above}" for above, below in pairwise(names)]
    init = [*(f"free_{hand}" for hand in hands), f"clear_{names[0]}", f"table_{names[-1]}", *stands]
    return build(init=" ".join(init), goal=" ".join((*turned, goal)), actions=actions)


def fetching(dice: Random) -> Task:
    """Things to be brought from places to places; some are alike, and now and then one of them is not."""
    places, agents = "abc"[: dice.randint(2, 3)], ["h", "r", "q"][: dice.randint(2, 3)]
    things = "tuvw"[: dice.randint(2, 4 if len(agents) == 2 else 3)]
    price, sealed = {place: dice.choice((1, 1, 2)) for place in places}, dice.choice(f"{places}   ")
    actions = {f"open {agent}": "!open -> open" for agent in agents}
    for agent in agents:
        actions[f"go {agent}"] = f"!busy_{agent} -> busy_{agent}"
        for thing, place in product(things, places):
            held, there, cost = f"{thing}_by_{agent}", f"{thing}_in_{place}", price[place]
            ready = f"busy_{agent} {'open' if place == sealed else ''}"
            actions[f"take_{thing}_{place} {agent}"] = f"{there} {ready} -> {held} !{there} @ {cost}"
            actions[f"put_{thing}_{place} {agent}"] = (
                f"{held} {ready} -> {there} !{held} !busy_{agent} @ {cost}"
            )
    if dice.random() < 0.3:
        there, elsewhere = (f"{things[0]}_in_{place}" for place in dice.sample(places, 2))
        actions[f"throw {agents[0]}"] = f"{there} -> {elsewhere} !{there}"
    init = [f"{thing}_in_{dice.choice(places[:2])}" for thing in things]
    goals = [f"{thing}_in_{dice.choice(places[-1] * 3 + places)}" for thing in things if dice.random() < 0.9]
    return build(agents=" ".join(agents), init=" ".join(init), goal=" ".join(goals), actions=actions)


def packed_of(task: Task) -> PackedTask:
    return PreparedTask(task).plain(Deadline()).packed


def reached(packed: PackedTask, operators: Iterable[Operator], most: int = 10**9) -> list[int]:
    """States that operators lead to one after another, in breadth-first order, until there are so many."""
    found, seen, operators = [packed.init], {packed.init}, [*operators]
    for state in found:
        for op in operators:
            if applicable(op, state) and (after := state & op.keep | op.put) not in seen:
                seen.add(after)
                found.append(after)
        if len(found) > most:
            break
    return found


def beside_the_plan(
    task: Task, options: Options
) -> tuple[SearchContext, Incumbent, ShortWindowQuestion] | None:
    """The question of short windows, with ``pi_H`` as the incumbent; None without any step of theirs."""
    context = SearchContext(PreparedTask(task), options, Deadline())
    optimal = context.canonical_plan()
    if optimal is None or not optimal.actions:
        return None
    keys, plan = context.keys, optimal.actions
    idle = sum(option.weight for _, option in context.followed(plan)) + keys.epoch_weight
    incumbent = Incumbent(idle + keys.of_start(len(plan), len(plan)))
    return context, incumbent, ShortWindowQuestion(context, plan, len(plan), incumbent)
