"""Rules on figures: costs, objective, savings, and what follows from them (semantics 1, 3)."""

from fractions import Fraction

from serendipity.model.numbers import agrees, as_written, excess
from verify.rules.case import CheckedResult, RuleFault


def human_cost(case: CheckedResult) -> RuleFault | None:
    """The reported cost of ``pi_H`` is the sum of its actions' costs."""
    return _differs("human_cost", case.result.human_cost, case.human_cost)


def step_cost(case: CheckedResult) -> RuleFault | None:
    """Each step costs what its action costs the team: discounted without the human."""
    steps = sorted(case.result.plan or (), key=lambda step: step.epoch)
    done = (i for chosen in case.replay.sets.values() for i in chosen)
    for step, i in zip(steps, done, strict=True):
        if not agrees(step.cost, case.price(i)):
            message = f"costs {float(case.price(i)):g}, the result says {step.cost:g}"
            return RuleFault(message, step.epoch, step.action)
    return None


def total_cost(case: CheckedResult) -> RuleFault | None:
    """The cost is the sum of the actions' costs; a joint action counts once."""
    return None if case.result.plan is None else _differs("cost", case.result.cost, case.cost)


def agent_costs(case: CheckedResult) -> RuleFault | None:
    """A joint action's cost is shared equally among its participants."""
    if case.result.plan is None:
        return None
    paid = case.shares
    for name in case.result.agent_costs:
        if name not in paid:
            return RuleFault(f"agent_costs: there is no agent {name:.50}")
    for name, share in paid.items():
        found = _differs(f"agent_costs of {name}", case.result.agent_costs.get(name), share)
        if found is not None:
            return found
    return None


def objective(case: CheckedResult) -> RuleFault | None:
    """Cost plus ``K`` for each epoch of the window plus communication."""
    if case.result.plan is None:
        return None
    window = case.result.window
    expected = case.cost + case.talk
    if window is not None and case.result.options.windowed:
        expected += case.result.options.window_weight * len(window)
    return _differs("objective", case.result.objective, expected)


def most_cost(case: CheckedResult) -> RuleFault | None:
    """No plan but ``pi_H`` costs more than ``max_cost`` (eq. 11)."""
    limit = case.result.options.max_cost
    is_pi_h = case.human_plan is not None and not case.result.opportunity
    if case.result.plan is None or limit is None or is_pi_h:
        return None
    if limit == "human":
        limit = _baseline(case)
    if limit is None or case.cost <= Fraction(limit):
        return None
    return RuleFault(f"the plan costs {float(case.cost):g}, max_cost is {float(limit):g}")


def saving(case: CheckedResult) -> RuleFault | None:
    """What the answer costs less than doing nothing; none without ``pi_H``."""
    result = case.result
    if case.human_plan is None:
        return None if result.saving is None else RuleFault("a saving without pi_H")
    if result.plan is None:
        return None
    if not result.opportunity:
        unknown = case.robots_goal and result.saving is None  # whether there is a baseline
        return None if unknown else _differs("saving", result.saving, Fraction(0))
    if case.robots_goal:
        return _saving_with_robots_goal(case)
    return _differs("saving", result.saving, _sure(case.human_cost) - case.cost)


def saving_alone(case: CheckedResult) -> RuleFault | None:
    """What the human gains without robots: nothing if ``pi_H`` is optimal, never more than it is off."""
    said = case.result.saving_alone
    if not said:
        return None  # nothing is claimed; ``None`` and 0 are the same
    ruled = case.result.statistics.get("rule_binds")  # then goals may be what help has to keep
    if case.human_plan is None or (case.robots_goal and not ruled):
        return RuleFault("a saving alone, though there is nothing to compare it with")
    optimum = case.alone.optimum(case.task.init)  # a window may open in a head start
    most = _sure(case.human_cost) - (optimum[0] if optimum else Fraction(0))
    if said > 0 and excess(said, most) <= 0:
        return None
    return RuleFault(f"saving_alone is {said:g}, pi_H costs only {float(most):g} more than an optimal plan")


def opportunity(case: CheckedResult) -> RuleFault | None:
    """An opportunity costs less than doing without robots; one acts if ``pi_H`` is not optimal."""
    result = case.result
    if result.plan is None:
        return None
    if case.human_plan is None:
        return RuleFault("an opportunity, though there is no pi_H to improve") if result.opportunity else None
    baseline = _baseline(case)
    without = None if baseline is None else baseline - as_written(result.saving_alone or 0)
    if result.opportunity:
        helped = any(not case.own(i) for _, i in case.steps())
        if not helped and case.improvable:
            return RuleFault("an opportunity in which no robot acts")
        if without is not None and case.cost >= without:
            return RuleFault(
                f"an opportunity that costs {float(case.cost):g}; without robots {float(without):g}"
            )
    elif without is not None and result.saving_alone is not None and case.cost < without:
        return RuleFault(
            f"the answer costs {float(case.cost):g}, without robots {float(without):g}: an opportunity"
        )
    return None


def _saving_with_robots_goal(case: CheckedResult) -> RuleFault | None:
    """The baseline is unknown here, but it costs no less than ``pi_H``; None: there is none."""
    said = case.result.saving
    if said is None:
        return None
    least = _sure(case.human_cost) - case.cost
    if said <= 0 or excess(said, least) < 0:
        return RuleFault(
            f"saving is {said:g}, but doing nothing costs at least {float(_sure(case.human_cost)):g}"
        )
    return None


def _baseline(case: CheckedResult) -> Fraction | None:
    """What doing nothing costs; with a robots' goal, as the result's own saving implies."""
    if not case.robots_goal:
        return case.human_cost
    return None if case.result.saving is None else case.cost + as_written(case.result.saving)


def _sure(cost: Fraction | None) -> Fraction:
    assert cost is not None, "rules on pi_H come first"
    return cost


def _differs(name: str, said: float | None, expected: Fraction | None) -> RuleFault | None:
    if agrees(said, expected):
        return None
    right = "absent" if expected is None else f"{float(expected):.12g}"
    return RuleFault(f"{name} is {right}, the result says {'nothing' if said is None else f'{said:.12g}'}")
