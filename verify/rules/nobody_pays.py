"""The rule that nobody pays for help, and that it leaves little behind (semantics 12), as goals of a task.

What bystanders need for the rest of their plans is worked out backward, from the end of each plan to ``T``.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final, NamedTuple

from serendipity.model import Claim, Condition, Deadline, HumanPlan, Options, PlanError, Result, Task
from serendipity.model.answers.certificate import Verdict
from serendipity.model.numbers import as_written
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.disturbance import disturbance_from
from serendipity.model.task.gate import is_bound, nobody_pays
from serendipity.model.task.leftovers import leftovers
from serendipity.model.task.protected import interfering_plainly
from serendipity.model.task.visibility import surroundings
from verify.base import wording
from verify.base.beside_script import alone_of
from verify.base.due import waited
from verify.base.execution import State, after, is_calm, is_last, met
from verify.base.obligations import is_tied, needed
from verify.base.optimal_plans import OptimalPlans
from verify.base.plan_graph import plan_graph
from verify.rules.layers import Layers
from verify.rules.leftovers import LeftoversCheck, Prices, left, unpriced
from verify.rules.noticed import unnoticed
from verify.rules.replay import Replay, replay, replay_human

Literals = dict[int, bool]
"""By fact whether it has to be true."""


class LastStateRule(NamedTuple):
    """What the last state and the human's payments have to be like.

    Attributes:
        facts: of the last state.
        most: that the human may pay; None: anything.
        prices: of facts that may be left otherwise, with what they are without help.
    """

    facts: Condition
    most: Fraction | None
    prices: Prices


Examine = Callable[[Task, Result], Iterable[Claim]]
"""Makes the claims of a task and a result without the rule."""

Solve = Callable[[Task, Options, Sequence[str] | None], Result | None]
"""The best plan for a task beside a plan of the human's, or none."""

UNPRICED: Final = ("optimal", "no_opportunity", "lower_bound")
"""Claims that prices change."""


def under_the_rule(
    task: Task,
    result: Result,
    original: Task,
    deadline: Deadline,
    examine: Examine,
    solve: Solve | None = None,
) -> tuple[Claim, ...]:
    """The claims of a result about one plan of the human's.

    Where the answer says that the rule binds, it is one to the task with the rule as goals; else the best one
    without the rule, which keeps it.

    Args:
        solve: finds the best plan for a task, for claims about what is best where leaving costs something.
    """
    if not is_bound(original, result.options) or not isinstance(result.horizon, int):
        return tuple(examine(task, result))
    if is_tied(result):
        rules = RulesOfHelp(task, result.options.but(ties="fixed"), original, deadline)
        if solve is None and result.options.leave_price is None:
            return _without_optimiser(rules, result, examine)
        return _claims_over_ties(rules, result, examine, solve)
    rules = RulesOfHelp(task, result.options, original, deadline)
    try:
        names = result.human_plan
        plan = None if names is None else replay_human(task, names, deadline)
    except PlanError:
        return tuple(examine(task, result))  # which says so
    rule = rules.of(plan, result.horizon)
    fault = rules.fault(result, rule, plan)
    if fault is not None:
        return (Claim("replay", "refuted", fault),)
    plain = replace(result, options=interfering_plainly(result.options))
    binds = result.statistics.get("rule_binds")
    if rule.prices and (binds or left(rule.prices, last_state(task, result))):
        return _priced_claims(rules, plain, rule, plan, examine, solve)
    return tuple(examine(rules.bound(rule, plan), plain) if binds else examine(task, result))


def _claims_over_ties(
    rules: "RulesOfHelp", result: Result, examine: Examine, solve: Solve | None
) -> tuple[Claim, ...]:
    """The claims over ties: what the best answer costs beside each plan, under the rule for that plan."""
    task, asked, deadline = rules.task, rules.options, rules.deadline

    def solved(plan: HumanPlan) -> Result | None:
        """The best answer without the rule, if it keeps it, or else under it (semantics 12)."""
        rule, under = _bound_beside(rules, plan)
        if solve is None or rule.prices:
            return None
        free = solve(task, asked, named(plan))
        if free is None or rules.fault(free, rule, plan) is None:
            return free
        return solve(under, interfering_plainly(asked), named(plan))

    def named(plan: HumanPlan) -> tuple[str, ...]:
        return tuple(task.actions[i].name for i in plan)

    costs: dict[tuple[str, ...], Fraction] = {}
    plans: Iterable[HumanPlan] = ()
    if solve is not None and result.status in ("optimal", "infeasible"):
        plans = plan_graph(task, OptimalPlans(task, alone_of(task, deadline, asked)), asked).plans()
    for plan in plans:
        found = solved(plan)
        if found is not None and found.status == result.status == "infeasible":
            return (Claim("infeasible", "proved", wording.RULE_BESIDE_EACH),)
        if found is None or found.status != "optimal" or found.cost is None:
            costs.clear()
            break
        costs[named(plan)] = as_written(found.cost)
    if not costs or result.status != "optimal":
        return tuple(Claim(name, "undecided", wording.RULE_OVER_TIES) for name in needed(result))
    mean = sum(costs.values(), Fraction(0)) / len(costs)
    least = {"optimistic": min(costs.values()), "robust": max(costs.values()), "expected": mean}
    listed = {tied.human_plan: tied.cost for tied in result.ties or () if tied.cost is not None}
    told = all(costs.get(names) == as_written(cost) for names, cost in listed.items())
    right = told and result.cost is not None and as_written(result.cost) == least[result.options.ties]
    verdict: Verdict = "proved" if right else "refuted"
    claims = _of_its_plan(rules, result, examine)
    own = (Claim(name, verdict, wording.RULE_BESIDE_EACH) for name in needed(result) if name not in claims)
    return (*claims.values(), *own)


def _bound_beside(rules: "RulesOfHelp", plan: HumanPlan) -> tuple[LastStateRule, Task]:
    """The rule beside a plan of the human's, and the task that it binds."""
    rule = rules.of(plan, len(plan) if rules.options.horizon is None else int(rules.options.horizon))
    return rule, rules.bound(rule, plan)


def _of_its_plan(rules: "RulesOfHelp", result: Result, examine: Examine) -> dict[str, Claim]:
    """The claims of the plan that is followed, by themselves."""
    if result.plan is None or result.human_plan is None:
        return {}
    _, under = _bound_beside(rules, replay_human(rules.task, result.human_plan, rules.deadline))
    said = replace(
        result,
        options=interfering_plainly(rules.options),
        status="feasible",
        lower_bound=0.0,
        ties=None,
        optimal_plans=None,
    )
    return {claim.claim: claim for claim in examine(under, said) if claim.claim not in UNPRICED}


def _without_optimiser(rules: "RulesOfHelp", result: Result, examine: Examine) -> tuple[Claim, ...]:
    """What rules alone say over ties."""
    claims = _of_its_plan(rules, result, examine) or {one.claim: one for one in examine(rules.task, result)}
    names = (name for name in needed(result) if name not in claims)
    return (*claims.values(), *(Claim(name, "not_in_scope", wording.NEEDS_OPTIMISER) for name in names))


def _priced_claims(
    rules: "RulesOfHelp",
    result: Result,
    rule: LastStateRule,
    plan: HumanPlan | None,
    examine: Examine,
    solve: Solve | None,
) -> tuple[Claim, ...]:
    """The claims where leaving something costs something: the plan's by itself, and that none is better."""
    task, options = rules.task, result.options.but(leave_price=None, leave_free=None)
    if result.status == "infeasible":  # whatever it would cost
        return tuple(examine(rules.bound(rule, plan), replace(result, options=options)))
    if result.plan is None or result.objective is None:
        return tuple(Claim(name, "undecided", wording.NOT_EXAMINED) for name in needed(result))

    def solved(kept: frozenset[int]) -> tuple[Result, State] | None:
        under = rules.bound(rule, plan, kept)
        found = None if solve is None else solve(under, options, result.human_plan)
        if found is None or found.status not in ("optimal", "infeasible"):
            return None
        return found, last_state(task, found)

    idle = max(Fraction(0), as_written(result.saving_alone or 0))
    if result.opportunity and as_written(result.saving or 0) <= idle:
        return (Claim("cost", "refuted", wording.LEFT_TOO_DEAR),)
    price = sum(left(rule.prices, last_state(task, result)).values(), Fraction(0))
    alone = None if result.human_cost is None else as_written(result.human_cost) - idle
    said = unpriced(result, price, alone)
    weight = options.window_weight if options.windowed else Fraction(0)
    below = as_written(result.lower_bound or 0)
    if result.status == "optimal":
        below = as_written(result.objective) + (weight if result.window is None else 0)
    if not options.windowed or result.opportunity:
        alone = None  # then nothing is better, whatever it costs
    # first of all, since what examines may take its time
    verdict = LeftoversCheck(solved, rule.prices, weight, alone).none_below(below)
    claims = [claim for claim in examine(rules.bound(rule, plan), said) if claim.claim not in UNPRICED]
    told: dict[bool | None, Verdict] = {True: "proved", False: "refuted", None: "undecided"}
    asked = (name for name in needed(result) if name in UNPRICED)
    return (*claims, *(Claim(name, told[verdict], wording.PRICED[verdict]) for name in asked))


def last_state(task: Task, found: Result) -> State:
    """The state that a plan leads to."""
    return replay(task, found.plan or (), Deadline(), strict=found.options.strict).last


@dataclass(frozen=True, slots=True)
class RulesOfHelp:
    """What a call asks of help.

    Attributes:
        original: the task as it was given, where the other one is in single epochs.
    """

    task: Task
    options: Options
    original: Task
    deadline: Deadline

    def of(self, plan: HumanPlan | None, last: int) -> LastStateRule:
        """The rule beside a plan of the human's, or beside none.

        Args:
            plan: the human's, epoch by epoch.
            last: ``T``.
        """
        task, options, original = self.task, self.options, self.original
        state = waited(task, task.init, last, strict=options.strict, plan=plan or ())
        if state is None:
            return LastStateRule(Condition(), None, {})
        changed = task.unsettled
        kept: Literals = {}
        everybody = nobody_pays(original, options)
        if everybody:
            kept |= _bystanders_need(task, state, len(original.agents))
        prices: dict[int, tuple[bool, Fraction]] = {}
        rest = leftovers(options)
        for fact, price in enumerate(() if rest is None else rest.prices(original.facts)):
            if price is None:
                kept[fact] = fact in state
            elif price and fact in changed:
                prices[fact] = (fact in state, price)
        facts = Condition(
            tuple(sorted(fact for fact, true in kept.items() if true and fact in changed)),
            tuple(sorted(fact for fact, true in kept.items() if not true and fact in changed)),
        )
        return LastStateRule(facts, task.cost_of(plan) if everybody and plan is not None else None, prices)

    def bound(self, rule: LastStateRule, plan: HumanPlan | None, kept: Iterable[int] = ()) -> Task:
        """The task of an answer that the rules bind.

        Args:
            kept: priced facts that are kept, too.
        """
        as_idle = {fact: rule.prices[fact][0] for fact in kept}
        positive, negative = ([f for f, true in as_idle.items() if true is value] for value in (True, False))
        bound = with_goals(with_goals(self.task, rule.facts), Condition(tuple(positive), tuple(negative)))
        most = rule.most if self.task.robot_goal else None
        return Layers(bound, self.options, plan, most, self.original, self.deadline).task

    def fault(self, result: Result, rule: LastStateRule, plan: HumanPlan | None) -> str | None:
        """What a plan beside one of the human's breaks of the rules, in words; None: nothing.

        Where it can't be executed others say so.
        """
        found = replay(self.task, result.plan or (), self.deadline, strict=result.options.strict)
        words = None
        if result.plan is not None and found.fault is None:
            words = self._broken(found, rule) or self._disturbs(found, result)
        return words or unnoticed(self.task, result, plan, self.original, self.deadline)

    def _broken(self, found: Replay, rule: LastStateRule) -> str | None:
        """What a plan breaks of the rule for it."""
        task = self.task
        his = (task.actions[i] for chosen in found.sets.values() for i in chosen)
        paid = sum((one.cost for one in his if task.human in one.participants), Fraction(0))
        if rule.most is not None and paid > rule.most:
            return wording.HUMAN_PAYS.format(float(paid), float(rule.most))
        if not rule.facts.holds(found.last):
            wrong = [fact for fact in rule.facts.positive if fact not in found.last]
            wrong += [fact for fact in rule.facts.negative if fact in found.last]
            return wording.LEFT_CHANGED.format(", ".join(task.facts[fact] for fact in wrong))
        return None

    def _disturbs(self, found: Replay, result: Result) -> str | None:
        """Whether a plan disturbs the human more than it may (semantics 13)."""
        task, facts = self.task, len(self.original.facts)
        most, kinds = result.options.max_disturbance, disturbance_from(result.options.disturbance)
        if most is None:
            return None
        seen, amount, started = surroundings(self.original), Fraction(0), {i for _, i in task.due}
        for epoch, chosen in found.sets.items():
            before = found.state_after(epoch - 1)
            here = {at for f, (who, at) in seen.located.items() if f in before and who == result.human}
            for i in chosen:
                action, begins = task.actions[i], i not in started
                doers = {task.agents[agent] for agent in action.participants}
                if result.human in doers:
                    amount += kinds.ask if begins and len(doers) > 1 else 0
                elif task.script.people.isdisjoint(action.participants):
                    changes = [fact for fact in (*action.add, *action.delete) if fact < facts]
                    named = map(seen.located.get, (*action.pre, *action.add) if begins else action.add)
                    meets = any(at is not None and at[0] in doers and at[1] in here for at in named)
                    amount += kinds.sight * any(here & seen.parts[fact] for fact in changes)
                    amount += kinds.meet * meets
        return None if amount <= most else wording.DISTURBS.format(float(amount), float(most))


def with_goals(task: Task, facts: Condition) -> Task:
    """The task with more goals of the robots'."""
    own = task.robot_goal
    positive, negative = {*own.positive, *facts.positive}, {*own.negative, *facts.negative}
    return task.with_goal(task.goal, Condition(tuple(sorted(positive)), tuple(sorted(negative))))


# -- bystanders


def _bystanders_need(task: Task, state: State, agents: int) -> Literals:
    """What they need of a state; those who are disturbed in it anyway need nothing."""
    rows, here = list[list[GroundAction]](), state
    while not is_calm(task, here):
        rows.append([task.actions[i] for i in met(task, here, ())])
        here = after(here, *rows[-1])
    found: Literals = {}
    goals = dict(task.own_goals)
    for agent in sorted(task.script.people):
        if agent < agents:
            needs = _needs(agent, goals.get(agent, Condition()), rows)
            if needs is not None and all((fact in state) is true for fact, true in needs.items()):
                found |= needs
    return found


def _needs(agent: int, goal: Condition, rows: Sequence[Sequence[GroundAction]]) -> Literals | None:
    """What one of them needs before epochs that go as planned; None: they are disturbed whatever holds."""
    last = max((k for k, row in enumerate(rows, start=1) if _own(agent, row)), default=0)
    needs: Literals | None = _literals(goal)
    for row in reversed(rows[:last]):
        for own in _own(agent, row):
            needs = None if needs is None else _before(needs, row, own)
        if not _own(agent, row):
            needs = None if needs is None else _before(needs, row, None)
    return needs


def _own(agent: int, row: Iterable[GroundAction]) -> list[GroundAction]:
    return [action for action in row if agent in action.participants]


def _literals(condition: Condition) -> Literals:
    return dict.fromkeys(condition.positive, True) | dict.fromkeys(condition.negative, False)


def _before(needs: Literals, row: Sequence[GroundAction], own: GroundAction | None) -> Literals | None:
    """What has to hold before an epoch for some things to hold after it, and for an action to be possible."""
    made: Literals = {}
    for last in (False, True):  # the script comes last
        now = [action for action in row if is_last(action) is last]
        made |= dict.fromkeys((fact for action in now for fact in action.delete), False)
        made |= dict.fromkeys((fact for action in now for fact in action.add), True)
    if any(made.get(fact, true) is not true for fact, true in needs.items()):
        return None
    before = {fact: true for fact, true in needs.items() if fact not in made}
    asked = {} if own is None else _literals(own.precondition)
    if any(before.get(fact, true) is not true for fact, true in asked.items()):
        return None
    return before | asked
