"""Towers that several hands or arms build."""

from itertools import permutations
from random import Random
from typing import Final

from serendipity.model import Task
from serendipity_testing.builders import Builder
from serendipity_testing.generator.families.parts import negated, pairs, prices, with_goals

_TABLE: Final = "table"
_SHELF: Final = "shelf"


def blocks(dice: Random, size: int, agents: tuple[str, ...]) -> Task:
    """Towers to build, with hands that hold a block or with arms that move it at once.

    Some can't lift every block; one block may take two arms, and hands may give blocks to each other.
    There may be a shelf beside the table, which leaves a choice.  The human is the first agent.
    """
    price, hands = prices(dice), dice.random() < 0.5
    world = _Blocks(dice, agents, size)
    heavy = dice.choice(world.names) if not hands and dice.random() < 0.3 else ""
    for who in range(len(agents)):
        able = world.names if dice.random() < 0.7 else dice.sample(world.names, dice.randint(1, size))
        for block in able:
            if hands:
                world.hold(block, who, price(), price())
            elif block != heavy:
                world.move(block, (who,), price())
    if heavy:
        world.move(heavy, dice.choice(pairs(agents)), price())
    if hands and dice.random() < 0.4:
        world.hand_over(dice.choice(pairs(agents)), price())
    now = _towers(dice, world.names)
    then = max((_towers(dice, world.names) for _ in range(3)), key=lambda towers: len(_moved(now, towers)))
    if then == now:
        then = _another(now)
    start = world.look_of(now)
    if hands:
        start += [literal for agent in agents if (literal := world.free(agent))[0] != "!"]
    asked = {dice.choice(_moved(now, then)), *dice.sample(world.names, dice.randint(1, size))}
    goal, wishes = list[str](), list[str]()
    for block in world.names:
        (goal if block in asked else wishes).append(world.sits(block, then[block]))
    buried = sorted({*now.values()} & {*world.names})
    if buried and dice.random() < 0.3:
        goal = [world.clear(dice.choice(buried))]
    return with_goals(dice, world.builder, start, goal, wishes)


class _Blocks:
    """Literals and actions; a fact says that nothing is on a block, or that something is."""

    def __init__(self, dice: Random, agents: tuple[str, ...], size: int) -> None:
        self.builder = Builder(agents, "blocks")
        self.names = [chr(ord("a") + i) for i in range(size)]
        self._ground = dice.choice(((_TABLE,), (_TABLE, _SHELF)))
        self._clear = dice.choice(("clear_{}", "clear_{}", "!under_{}"))
        self._free = dice.choice(("free_{}", "free_{}", "!full_{}"))

    def sits(self, block: str, below: str) -> str:
        """A block is on another or the table."""
        return f"on_{block}_{below}"

    def clear(self, block: str) -> str:
        """Nothing is on it; no literal for the table and the shelf."""
        return "" if block in self._ground else self._clear.format(block)

    def free(self, agent: str) -> str:
        """The agent holds nothing."""
        return self._free.format(agent)

    def look_of(self, towers: dict[str, str]) -> list[str]:
        """The facts about blocks."""
        tops = [x if x not in towers.values() else "" for x in towers]
        literals = [self.clear(x) if x in tops else negated(self.clear(x)) for x in towers]
        literals += [self.sits(x, below) for x, below in towers.items()]
        return [literal for literal in literals if literal[0] != "!"]

    def places(self, block: str) -> list[str]:
        """The places of a block."""
        return [*self._ground, *(x for x in self.names if x != block)]

    def move(self, block: str, who: tuple[int, ...], cost: str) -> None:
        """From everywhere to everywhere, at once."""
        for below, onto in permutations(self.places(block), 2):
            here, there = self.sits(block, below), self.sits(block, onto)
            self.builder.action(
                f"move_{block}_{below}_{onto}",
                who,
                f"{here} {self.clear(block)} {self.clear(onto)}",
                f"{there} !{here} {self.clear(below)} {negated(self.clear(onto))}",
                cost,
            )

    def hold(self, block: str, who: int, up: str, down: str) -> None:
        """Taken up from everywhere, and put down everywhere."""
        agent = self.builder.agents[who]
        held = f"hold_{agent}_{block}"
        for place in self.places(block):
            there = f"{self.sits(block, place)} {self.clear(block)} {self.free(agent)}"
            below = self.clear(place)
            self.builder.action(
                f"lift_{block}_{place}", (who,), there, f"{held} {below} {negated(there)}", up
            )
            put = f"{there} !{held} {negated(below)}"
            self.builder.action(f"put_{block}_{place}", (who,), f"{held} {below}", put, down)

    def hand_over(self, pair: tuple[int, int], cost: str) -> None:
        """Any block, from the one to the other and back."""
        agents = [self.builder.agents[who] for who in pair]
        for giver, taker in permutations(agents):
            for block in self.names:
                given = f"hold_{giver}_{block} {self.free(taker)}"
                taken = f"hold_{taker}_{block} {self.free(giver)}"
                way = "give" if giver == agents[0] else "take"
                self.builder.action(f"{way}_{block}", pair, given, f"{taken} {negated(given)}", cost)


def _towers(dice: Random, names: list[str]) -> dict[str, str]:
    """The block or place below each block."""
    below, tops = dict[str, str](), list[str]()
    for block in dice.sample(names, len(names)):
        below[block] = dice.choice((_TABLE, *tops, *tops))
        tops = [*(top for top in tops if top != below[block]), block]
    return below


def _moved(now: dict[str, str], then: dict[str, str]) -> list[str]:
    """The blocks that are somewhere else, in alphabetical order."""
    return [block for block in sorted(now) if now[block] != then[block]]


def _another(towers: dict[str, str]) -> dict[str, str]:
    """The same but for a block that nothing is on: put on the table, or on another one."""
    *others, top = (block for block in towers if block not in towers.values())
    return towers | {top: _TABLE if towers[top] != _TABLE else others[0]}
