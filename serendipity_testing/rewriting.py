"""The same call in other words: what laws ask beside it."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.model import Condition, Deed, GroundAction, HumanPlan, TimedPlan, Timeline, Timing
from serendipity_testing.call import Call

_IDLER: Final = "idler"
_MOMENT: Final = "moment_passed"
_HALF: Final = "half_done"


def renamed(call: Call) -> Call:
    """Facts, actions and agents under other names, in other places."""
    task = call.task
    facts, agents = len(task.facts), len(task.agents)
    every = {a.name for a in task.actions} | {deed.name for deed in task.script.deeds}
    names = {name: f"act{k}" for k, name in enumerate(sorted(every, reverse=True))}

    def fact_ids(ids: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(sorted(facts - 1 - f for f in ids))

    def condition(given: Condition) -> Condition:
        return Condition(fact_ids(given.positive), fact_ids(given.negative))

    def timing(given: Timing) -> Timing:
        starts = fact_ids(given.start_add), fact_ids(given.start_delete)
        return Timing(given.duration, condition(given.over_all), condition(given.at_end), *starts)

    def action(given: GroundAction) -> GroundAction:
        who = tuple(sorted(agents - 1 - agent for agent in given.participants))
        name = " ".join([names[given.name], *(f"agent{agent}" for agent in who)])
        return GroundAction(
            name,
            who,
            fact_ids(given.pre),
            fact_ids(given.neg),
            fact_ids(given.add),
            fact_ids(given.delete),
            given.cost,
            None if given.timing is None else timing(given.timing),
        )

    script = Timeline(
        tuple(replace(one, fact=facts - 1 - one.fact) for one in task.script.facts),
        tuple(
            Deed(deed.epoch, agents - 1 - deed.agent, tuple(map(action, deed.variants)))
            for deed in task.script.deeds
        ),
        frozenset(agents - 1 - agent for agent in task.script.people),
    )
    actions, places = _in_order([action(given) for given in task.actions])
    other = replace(
        task,
        agents=tuple(f"agent{agent}" for agent in range(agents)),
        human=agents - 1 - task.human,
        facts=tuple(f"fact{f}" for f in range(facts)),
        init=frozenset(facts - 1 - f for f in task.init),
        goal=condition(task.goal),
        robot_goal=condition(task.robot_goal),
        own_goals=tuple(sorted((agents - 1 - agent, condition(goal)) for agent, goal in task.own_goals)),
        actions=actions,
        script=script,
    )
    return replace(call, task=other, human_plan=_placed(call.human_plan, places))


def with_idle_robot(call: Call) -> Call:
    """One more robot, which can record that time has passed."""
    task = call.task
    name, fact = _fresh(_IDLER, task.agents), len(task.facts)
    idles = GroundAction(f"wait {name}", (len(task.agents),), (), (), (fact,), (), Fraction(1))
    actions, places = _in_order([*task.actions, idles])
    more = replace(
        task,
        agents=(*task.agents, name),
        facts=(*task.facts, _fresh(_MOMENT, task.facts)),
        actions=actions,
    )
    return replace(call, task=more, human_plan=_placed(call.human_plan, places))


def doubled(call: Call) -> Call:
    """Everything costs twice as much."""
    task, options = call.task, call.options
    actions = tuple(replace(action, cost=2 * action.cost) for action in task.actions)
    most = options.max_cost
    return replace(
        call,
        task=replace(task, actions=actions),
        options=options.but(
            window_weight=2 * options.window_weight,
            max_cost=2 * most if isinstance(most, Fraction) else most,
        ),
    )


def with_split_action(call: Call) -> Call | None:
    """The first action that costs something in two steps, of half its cost each; None if there is none."""
    task = call.task
    single = (i for i, a in enumerate(task.actions) if a.cost and len(task.named[a.name]) == 1)
    split = next((i for i in single if task.actions[i].timing is None), None)
    if split is None:
        return None
    whole, fact = task.actions[split], len(task.facts)
    half = whole.cost / 2
    first = replace(whole, name=f"begin {whole.name}", add=(fact,), delete=(), cost=half)
    second = replace(
        whole,
        name=f"end {whole.name}",
        pre=(*whole.pre, fact),
        delete=(*whole.delete, fact),
        cost=half,
    )
    given = list(task.actions)
    given[split] = first
    actions, places = _in_order([*given, second])
    more = replace(task, facts=(*task.facts, _fresh(_HALF, task.facts)), actions=actions)
    plan: list[int] = []
    for i in call.human_plan or ():
        plan += [places[i], places[-1]] if i == split else [places[i]]
    return replace(call, task=more, human_plan=None if call.human_plan is None else tuple(plan))


def _placed(plan: HumanPlan | None, places: Sequence[int]) -> HumanPlan | None:
    """A plan whose actions have other ids."""
    if plan is None:
        return None
    ids = tuple(places[i] for i in plan)
    return TimedPlan(ids, plan.starts, plan.length) if isinstance(plan, TimedPlan) else ids


def _in_order(actions: Sequence[GroundAction]) -> tuple[tuple[GroundAction, ...], list[int]]:
    """Actions as tasks have them, by name, and the place of each; those of one name stay in their order."""
    order = sorted(range(len(actions)), key=lambda i: actions[i].key)
    places = [0] * len(order)
    for place, i in enumerate(order):
        places[i] = place
    return tuple(actions[i] for i in order), places


def _fresh(name: str, taken: tuple[str, ...]) -> str:
    """The name, with as many underscores as make it new."""
    while name in taken:
        name += "_"
    return name
