"""Tasks of three rooms for what a person sees of help."""

from fractions import Fraction

from hypothesis import strategies as st

from serendipity import Condition, GroundAction, Script, Task, Timing
from serendipity.testing.generator.in_time import with_durations
from serendipity.testing.strategies.tasks import DICE

_PLACED = tuple(f"{what} p{i}" for what in ("at h", "at r", "lit") for i in range(3))
_FACTS = (*_PLACED, "done")
_IDS = {name: i for i, name in enumerate(_FACTS)}


def action(
    name: str, who: tuple[int, ...], pre: str, add: str, delete: str = "", cost: int = 1
) -> GroundAction:
    def ids(text: str) -> tuple[int, ...]:
        return tuple(sorted(_IDS[fact.strip()] for fact in text.split(",") if fact.strip()))

    return GroundAction(name, who, ids(pre), (), ids(add), ids(delete), Fraction(cost))


@st.composite
def rooms(draw: st.DrawFn, *, timed: bool = True) -> Task:
    """Three rooms in a row, in which both walk; work is quick where a robot has lit a lamp, or helps.

    Args:
        draw: chooses.
        timed: whether walks may take two epochs.
    """
    found, slow = [], timed and draw(st.booleans())
    for agent, name in enumerate("hr"):
        for p, q in ((0, 1), (1, 2), (1, 0), (2, 1)):
            walk = f"move {name} p{p} p{q}"
            found.append(action(walk, (agent,), f"at {name} p{p}", f"at {name} p{q}", f"at {name} p{p}"))
            if slow and draw(st.booleans()):
                left = Timing(2, start_delete=found[-1].delete)
                found[-1] = GroundAction(walk, (agent,), found[-1].pre, (), found[-1].add, (), timing=left)
    for p in range(3):
        where = f"at r p{p}" if draw(st.booleans()) else ""
        found.append(action(f"light r p{p}", (1,), where, f"lit p{p}", cost=draw(st.integers(0, 1))))
    goal, lamp, desk = (draw(st.integers(0, 2)) for _ in range(3))
    found.append(action(f"work h p{goal}", (0,), f"at h p{goal}", "done", cost=5))
    found.append(action(f"work-lit h p{goal}", (0,), f"at h p{goal}, lit p{lamp}", "done"))
    found.append(action(f"give h r p{desk}", (0, 1), f"at h p{desk}, at r p{desk}", "done"))
    start = frozenset({_IDS[f"at h p{draw(st.integers(0, 2))}"], _IDS[f"at r p{draw(st.integers(0, 2))}"]})
    actions = tuple(sorted(found, key=lambda each: each.key))
    return Task("rooms", ("h", "r"), 0, _FACTS, start, Condition((_IDS["done"],)), actions)


@st.composite
def rooms_in_time(draw: st.DrawFn) -> Task:
    """The same, where anything may take its time, and lamps go on and off by themselves."""
    task = with_durations(draw(DICE), draw(rooms()), (1, 1, 1, 2))
    lamps = st.sampled_from([f"{true}lit p{room}" for true in ("", "!") for room in range(3)])
    changes = draw(st.dictionaries(st.integers(1, 5), lamps, max_size=2))
    return task.with_script(Script(facts=changes.items()))
