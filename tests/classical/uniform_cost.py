"""A program in the place of SymK: uniform-cost search on SAS+, with the output of Fast Downward."""

import sys
from heapq import heappop, heappush
from itertools import count
from pathlib import Path

WORDS = iter(sys.stdin.read().split("\n"))


def number() -> int:
    return int(next(WORDS))


def pairs(size: int) -> list[tuple[int, ...]]:
    return [tuple(map(int, next(WORDS).split())) for _ in range(size)]


def until(end: str) -> None:
    while next(WORDS) != end:
        pass


until("end_metric")
for _ in range(number()):
    until("end_variable")
assert number() == 0, "no mutex groups"
assert next(WORDS) == "begin_state"
start: list[int] = []
while (word := next(WORDS)) != "end_state":
    start.append(int(word))
assert next(WORDS) == "begin_goal"
goal = pairs(number())
assert next(WORDS) == "end_goal"
operators = []
for _ in range(number()):
    assert next(WORDS) == "begin_operator"
    name = next(WORDS)
    prevail = pairs(number())
    effects = pairs(number())
    operators.append((name, prevail, effects, number()))
    assert next(WORDS) == "end_operator"

tie = count()
queue = [(0, next(tie), tuple(start), ())]
seen = set()
while queue:
    cost, _, state, plan = heappop(queue)
    if state in seen:
        continue
    seen.add(state)
    if all(state[at] == value for at, value in goal):
        Path("sas_plan").write_text("".join(f"({name})\n" for name in plan) + f"; cost = {cost}\n")
        sys.stdout.write(f"[t=0s, 1 KB] Plan cost: {cost}\nSearch time: 0.1s\nTotal time: 0.1s")
        sys.exit(0)
    for name, prevail, effects, price in operators:
        asked = [*prevail, *((at, before) for _, at, before, _ in effects if before >= 0)]
        if all(state[at] == value for at, value in asked):
            after = list(state)
            for _, at, _, value in effects:
                after[at] = value
            heappush(queue, (cost + price, next(tie), tuple(after), (*plan, name)))
sys.stdout.write("Search time: 0.1s\nTotal time: 0.1s")
sys.exit(11)
