"""Switches that several agents set."""

from random import Random

from serendipity.model import Condition, Task
from serendipity.model.task.actions import apply
from serendipity_testing.builders import Builder
from serendipity_testing.generator.families.parts import negated, pairs, prices


def switches(dice: Random, size: int, agents: tuple[str, ...]) -> Task:
    """Switches to set: a panel with conditions and side effects, or a circle, each disabling the next."""
    builder = Builder(agents, "switches")
    names = [f"s{k}" for k in range(size)]
    task = (_circle if dice.random() < 0.4 else _panel)(dice, builder, names)
    alone = dice.random() < 0.75
    reached = _walk(dice, task, task.human_actions if alone else range(len(task.actions)), 3 * size)
    facts = [f for f, name in enumerate(task.facts) if name in names]
    changed = [f for f in facts if (f in reached) != (f in task.init)] or facts
    asked = {*dice.sample(changed, dice.randint((len(changed) + 1) // 2, len(changed)))}
    asked |= {*dice.sample(facts, dice.randint(0, 1))}
    theirs = dice.sample(sorted({*facts} - asked), 1) if asked < {*facts} and dice.random() < 0.15 else []
    return task.with_goal(_as_in(reached, asked), _as_in(reached, theirs))


def _panel(dice: Random, builder: Builder, names: list[str]) -> Task:
    """Everybody turns some on and off."""
    price = prices(dice)

    def other(name: str, often: float) -> str:
        if dice.random() >= often:
            return ""
        return dice.choice(("", "!")) + dice.choice([n for n in names if n != name])

    for k, name in enumerate(names):
        for who in range(len(builder.agents)):
            for verb, after in (("on", name), ("off", f"!{name}")):
                if k == who == 0 or dice.random() < 0.6:
                    needs = f"{negated(after)} {other(name, 0.5)}"
                    builder.action(f"{verb}_{name}", (who,), needs, f"{after} {other(name, 0.3)}", price())
    if dice.random() < 0.4:
        chosen = dice.sample(names, 2)
        effects = " ".join(dice.choice(("", "", "!")) + name for name in chosen)
        builder.action("lever", dice.choice(pairs(builder.agents)), other("", 0.5), effects, price())
    return builder.task(" ".join(name for name in names if dice.random() < 0.3), " ".join(names))


def _circle(dice: Random, builder: Builder, names: list[str]) -> Task:
    """Pressing one disables the next, until somebody enables it again, which may undo the one before."""
    price = prices(dice)
    ready = dice.choice(("ready_{}", "!stuck_{}"))
    for k, name in enumerate(names):
        before, here, behind = names[k - 1], ready.format(name), ready.format(names[(k + 1) % len(names)])
        for who in range(len(builder.agents)):
            if k == who == 0 or dice.random() < 0.7:
                builder.action(f"press_{name}", (who,), here, f"{name} {negated(behind)}", price())
            if dice.random() < 0.5:
                undone = dice.choice(("", f"!{before}"))
                builder.action(f"enable_{name}", (who,), negated(here), f"{here} {undone}", price())
    if dice.random() < 0.4:
        both = " ".join(dice.sample(names, 2))
        builder.action("press_two", dice.choice(pairs(builder.agents)), "", both, price())
    start = [literal for name in names if (literal := ready.format(name))[0] != "!"]
    return builder.task(" ".join(start), " ".join(names))


def _walk(dice: Random, task: Task, actions: range | tuple[int, ...], steps: int) -> frozenset[int]:
    """The state after random actions."""
    state = task.init
    for _ in range(dice.randint(2, steps)):
        ways = [i for i in actions if task.actions[i].applicable(state)]
        if ways:
            state = apply(state, task.actions[dice.choice(ways)])
    return state


def _as_in(state: frozenset[int], facts: set[int] | list[int]) -> Condition:
    return Condition(tuple(sorted(state.intersection(facts))), tuple(sorted({*facts} - state)))
