"""Tasks in which places are alike: agents go about and see to them, with tools of their own."""

from dataclasses import replace
from random import Random

from serendipity.model import Task
from serendipity.testing.builders import Builder


def survey(dice: Random, places: int, robots: int) -> Task:
    """Places to see to, most of which can be exchanged for one another.

    Args:
        dice: decides everything but sizes.
        places: how many, the one included where everybody starts.
        robots: how many; each has some tools, of which it can hold one or all.
    """
    agents = ("h", "r", "s")[: robots + 1]
    builder = Builder(agents, "survey")
    names = [f"p{k}" for k in range(places)]
    both = dice.random() < 0.2
    kinds = {name: ("rock", "soil") if both else (dice.choice(("rock", "rock", "soil")),) for name in names}
    sights = {name: [f"seen:{name}:{kind}" for kind in kinds[name]] for name in names}
    dear = dice.sample(names, dice.choice((0, 0, 1)))
    for who, agent in enumerate(agents):
        price = "1" if dice.random() < 0.6 else dice.choice(("0.5", "2"))
        tools = dice.choice((["rock", "soil"], ["rock", "soil"], ["rock"])) if who else ["rock", "soil"]
        holds_one = dice.random() < 0.5
        for tool in tools:
            if who or dice.random() < 0.3:
                empty = f"!free:{agent}" if holds_one else ""
                builder.action(f"take {tool}", (who,), f"free:{agent}", f"has:{agent}:{tool} {empty}", price)
                builder.action(
                    f"drop {tool}", (who,), f"has:{agent}:{tool}", f"!has:{agent}:{tool} free:{agent}", price
                )
                tool_needed = {tool: f"has:{agent}:{tool}"}
            else:
                tool_needed = {}
            for name in names:
                if tool in kinds[name]:
                    needs = f"at:{agent}:{name} {tool_needed.get(tool, '')}"
                    cost = "3" if name in dear else price
                    builder.action(f"see {name} {tool}", (who,), needs, f"seen:{name}:{tool}", cost)
        if who and dice.random() < 0.3:
            pair = " ".join(sights[name][0] for name in names[:2])
            builder.action("see both", (who,), f"at:{agent}:{dice.choice(names)}", pair, price)
        ring = dice.random() < 0.25
        for k, here in enumerate(names):
            for there in [names[(k + 1) % places]] if ring else names:
                if there != here:
                    where = f"at:{agent}:{here}"
                    builder.action(f"go {here} {there}", (who,), where, f"at:{agent}:{there} !{where}", price)
    start = [f"free:{agent}" for agent in agents]
    start += [f"at:{agent}:{dice.choice(names[:2])}" for agent in agents]
    start += [sights[name][0] for name in names if dice.random() < 0.1]
    wanted = [name for name in names if dice.random() < 0.85] or names
    goal = [sight for name in wanted for sight in sights[name]]
    task = builder.task(" ".join(start), " ".join(goal))
    return replace(
        task,
        facts=tuple(fact.replace(":", " ") for fact in task.facts),
        known_variables=task.variables,
    )
