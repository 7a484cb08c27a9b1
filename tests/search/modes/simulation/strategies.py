"""Strategies of plans for humans who replan; they only build."""

from dataclasses import dataclass, replace
from itertools import islice

from hypothesis import strategies as st

from serendipity.model import Condition, HumanPlan, Options, Step, Task, surroundings
from serendipity.model.task.actions import State
from serendipity.model.task.visibility import Visible
from serendipity_testing.oracle import Alone, Moment, human_plans
from serendipity_testing.oracle.epochs import after, usable
from serendipity_testing.strategies import tasks


@dataclass(frozen=True, slots=True)
class Played:
    """A task, a plan for it, and a human."""

    task: Task
    options: Options
    human_plan: HumanPlan
    steps: tuple[Step, ...]
    horizon: int | None
    human_model: str
    visible: Visible | None


@st.composite
def sights(draw: st.DrawFn, task: Task) -> Visible:
    """What is visible: the default, or facts that depend on which fact is true."""
    if surroundings(task).located and draw(st.booleans()):
        return surroundings(task).visible
    facts = range(len(task.facts))
    always = draw(st.frozensets(st.sampled_from(facts)))
    shown_by = {f: draw(st.sampled_from(facts)) for f in facts}

    def visible(agent: int, fact: int, state: State) -> bool:
        return fact in always or shown_by[fact] in state

    return visible


@st.composite
def played(draw: st.DrawFn) -> Played:
    """Plans that make sense for a while, with a step now and then that does not."""
    task = draw(tasks())
    plans = list(islice(human_plans(task), 4))
    human_plan = draw(st.sampled_from(plans)) if plans else ()
    model = draw(st.sampled_from(["observant", "local", "local"]))
    options = Options(
        discount=draw(st.sampled_from(["0", "0.5", "0.9"])),  # type: ignore[arg-type]
        interference=draw(st.sampled_from(["paper", "paper", "strict"])),
    )
    epochs = draw(st.integers(1, max(2, len(human_plan))))
    return Played(
        task,
        options,
        human_plan,
        draw(_steps(task, human_plan, epochs)),
        draw(st.sampled_from([None, epochs, epochs + 2])),
        model,
        draw(sights(task)) if model == "local" else None,
    )


@st.composite
def _steps(draw: st.DrawFn, task: Task, human_plan: HumanPlan, epochs: int) -> tuple[Step, ...]:
    """A walk in which the human does what they can of their plan, and robots what they like."""
    steps = []
    state, left = task.init, list(human_plan)
    alone = Alone(task)
    others = [i for i in range(len(task.actions)) if i not in task.human_actions]
    for epoch in range(1, epochs + 1):
        possible = [i for i in others if usable(task.actions[i], state)]
        if draw(st.integers(0, 7)) == 0:
            possible = others
        chosen = draw(st.lists(st.sampled_from(possible), max_size=2, unique=True)) if possible else []
        steps += [Step(epoch, i) for i in chosen]
        if left and usable(task.actions[left[0]], state):
            chosen.append(left.pop(0))
        elif ways := alone.best(Moment(state)):
            chosen.append(ways[0].action)
        state = after(state, [task.actions[i] for i in chosen if usable(task.actions[i], state)])
    return tuple(steps)


@dataclass(frozen=True, slots=True)
class Reaction:
    """A planning call under a human model, small enough for brute force."""

    task: Task
    options: Options
    human_plan: HumanPlan
    given: bool
    visible: Visible


@st.composite
def reactions(draw: st.DrawFn, human_model: str) -> Reaction:
    """Calls in which the human has a plan; it is given where it is not the canonical one."""
    task = draw(tasks())
    plans = list(islice(human_plans(task), 4))
    if not plans:
        facts = range(len(task.facts))
        task = replace(task, goal=Condition(tuple(f for f in facts if f in task.init)[:1], ()))
        plans = list(islice(human_plans(task), 4))
    plan = draw(st.sampled_from(plans))
    options = Options(
        discount=draw(st.sampled_from(["0", "0.5", "0.9", "1"])),  # type: ignore[arg-type]
        interference=draw(st.sampled_from(["paper", "paper", "strict"])),
        horizon=draw(st.sampled_from([None, len(plan), len(plan) + 1])) if plan else 1,
        human_model=human_model,
        no_block=draw(st.sampled_from([None, None, True, False])),
    )
    return Reaction(task, options, plan, plan != plans[0], draw(sights(task)))
