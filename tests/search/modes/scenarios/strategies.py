"""Scenarios of small tasks, and tasks in which it pays to watch."""

from dataclasses import replace
from fractions import Fraction
from itertools import islice
from typing import Final

from hypothesis import strategies as st

from search.modes.scenarios import Candidate
from serendipity.model import Condition, HumanPlan, Options, Task
from serendipity.model.keywords import CHOICES
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import human_plans, optimal_human_plan
from serendipity_testing.strategies import plans, tasks
from tests.search.modes.goals.strategies import reachable_goals

_SHARES: Final = ((1, 1, 1), (1, 2, 3), (9, 1, 1), (1, 9, 5), (99, 1, 1))
_HELP: Final = {
    "freely": ("", ""),
    "once": ("free", "!free"),
    "one at a time": ("", "!up{other}"),
    "in its place": ("r{k}", ""),
}
"""What a robot needs to lift something, and what becomes of that."""


@st.composite
def turning_tasks(draw: st.DrawFn) -> Task:
    """The human turns off somewhere, and then it is clear what they want; robots can help with it in time."""
    ways = draw(st.integers(2, 3))
    cost = st.sampled_from(["0", "1", "1", "2"])
    robots = draw(st.sampled_from(["r", "r", "r q"])).split()
    needs, becomes = _HELP[draw(st.sampled_from(sorted(_HELP)))]
    actions: dict[str, str] = {}
    start = "a"
    if draw(st.booleans()):
        actions["walk h"], start = f"a -> b !a @ {draw(cost)}", "b"
    late = draw(st.booleans())
    for k in range(ways):
        other = (k + 1) % ways
        actions[f"turn{k} h"] = f"{start} -> c{k} !{start} @ {draw(cost)}"
        if late:
            actions[f"go{k} h"] = f"c{k} -> d{k} !c{k} @ {draw(cost)}"
        here = f"d{k}" if late else f"c{k}"
        actions[f"do{k} h"] = f"{here} -> x{k} @ {draw(st.sampled_from('3456'))}"
        actions[f"quick{k} h"] = f"{here} up{k} -> x{k} @ {draw(st.sampled_from('012'))}"
        then = becomes.format(other=other)
        actions[f"lift{k} {draw(st.sampled_from(robots))}"] = (
            f"{needs.format(k=k)} -> up{k} {then} @ {draw(cost)}"
        )
        actions[f"move{k} r"] = f"r{other} -> r{k} !r{other} @ {draw(cost)}"
        if draw(st.integers(0, 3)) == 0:
            actions[f"carry{k} h {draw(st.sampled_from(robots))}"] = f"{here} -> x{k} @ {draw(cost)}"
    return build(agents=" ".join(["h", *robots]), init="a free r0", goal="x0", actions=actions)


@st.composite
def scenarios(draw: st.DrawFn, *, predicted: bool = False) -> tuple[Task, list[Candidate]]:
    """A task without goals of robots' own, with 1 to 3 scenarios.

    Args:
        predicted: whether each plan is a goal's canonical one; else there are detours, and ties.
    """
    turning = draw(st.booleans())
    task = replace(draw(turning_tasks() if turning else tasks()), robot_goal=Condition())
    shares = draw(st.sampled_from(_SHARES))[: draw(st.sampled_from([1, 2, 2, 3]))]
    found: list[tuple[Condition, HumanPlan]] = []
    if not predicted and draw(st.integers(0, 3)) == 0:
        found += [(task.goal, plan) for plan in islice(human_plans(task), len(shares))]
    while len(found) < len(shares):
        goal = draw(reachable_goals(task))
        if turning:
            goal = Condition((task.facts.index(f"x{len(found) if f'x{len(found)}' in task.facts else 0}"),))
        asked = replace(task, goal=goal)
        plan = optimal_human_plan(asked) if predicted else draw(plans(asked))
        assert plan is not None, "they can get there"
        found.append((goal, plan))
    pairs = zip(found, shares, strict=True)
    return task, [
        Candidate(*pair, Fraction(share, sum(shares)), f"s{k}") for k, (pair, share) in enumerate(pairs)
    ]


@st.composite
def options_over(draw: st.DrawFn, candidates: list[Candidate]) -> Options:
    """All options of semantics 11."""
    longest = max(len(candidate.plan) for candidate in candidates)
    return Options(
        discount=draw(st.sampled_from(["0", "0.5", "0.9", "1"])),  # type: ignore[arg-type]
        window_weight=draw(st.sampled_from(["1000", "1000", "0", "0.25", "1"])),  # type: ignore[arg-type]
        horizon=draw(st.sampled_from([None, None, longest, longest + 1])),
        max_window=draw(st.sampled_from([None, None, 1, 2])),
        suffix=draw(st.sampled_from(["replan", "replan", "subplan"])),
        preservation=draw(st.sampled_from(["kernel", "kernel", "state"])),
        interference=draw(st.sampled_from(["paper", "strict"])),
        policy=draw(st.sampled_from(["watching", "watching", "fixed"])),
        risk=draw(st.sampled_from(CHOICES["risk"])),  # type: ignore[arg-type]
    )
