"""Why an edited result may still be proved: what an edit must be for that, and nothing else."""

from dataclasses import replace
from typing import Any, Final

import serendipity
from serendipity.model import Result, SerendipityError, UsageError, Window
from tests.verify.edits.corpus import Good
from tests.verify.edits.edits import Edit

NO_CLAIM: Final = (
    *("options.time_limit", "options.memory_limit", "options.strategies", "options.max_ties"),
    *("policy.floors", "realised", "statistics.ties.*.realised", "version"),
    *("statistics.constraints", "statistics.kernel", "statistics.elapsed_seconds", "statistics.encoding"),
    *("statistics.expanded", "statistics.gap", "statistics.generated", "statistics.optimal_plans"),
    *("statistics.solver", "statistics.solver_calls", "statistics.strategies", "statistics.variables"),
)
"""Fields without a claim, and what is below them; ``realised`` may say less than it could."""

_WEAKER: Final = (("optimal", "feasible"),)
"""A status that claims less of the same answer."""


def explained(good: Good, data: dict[str, Any], result: Result, edits: tuple[Edit, ...]) -> str | None:
    """Why the edited result is right; None if there is no reason.

    Args:
        good: what was edited.
        data: the edited JSON.
        result: what was read from it.
        edits: what was changed.
    """
    original = good.result.to_dict()
    if _meaning(data) == _meaning(original):
        return "it says the same"
    same = _meaning({**data, "exact": 0}) == _meaning({**original, "exact": 0})
    if same and _fewer(data.get("exact"), original.get("exact")):
        return "it says the same in figures that are rounded"
    if _without_options(data) == _without_options(original) and _same_answer(good, result):
        return "the options don't change the answer"
    if _claims_less(good, result):
        return "it claims less"
    if "goals" in good.asked and result.goals is None and _same_answer(good, result):
        return "it is the answer for the task's own goal, too"
    if all(edit.path[:2] == ("statistics", "goals") for edit in edits) and _other_windows(good, result):
        return "other windows that are as long"
    if _same_library(good, data, result):
        return "the library is another one, and the answer is that for it"
    if _beliefs(result) is not None and _same_recognition(good, data, result):
        return "the posterior is another one, and the answer is that for it"
    if {edit.path[0] for edit in edits} == {"human_plan_times"} and _same_answer(good, result, times=True):
        return "the human may have planned so, too"
    if {edit.path[0] for edit in edits} <= {"plan", "policy", "window"} and _another_answer(good, result):
        return "another answer of the same worth"
    return None


def _fewer(said: Any, figures: Any) -> bool:
    """Whether some exact figures are missing, which else are as they were."""
    if said is None or not isinstance(said, dict) or not isinstance(figures, dict):
        return said is None or bool(said == figures)
    return all(name in figures and _fewer(value, figures[name]) for name, value in said.items())


def _meaning(data: dict[str, Any]) -> Any:
    """What a result says, without fields that carry no claim and without order that means nothing."""
    return _plain(data, "")


def _plain(value: Any, where: str) -> Any:
    if isinstance(value, dict):
        fields = {key: _plain(item, f"{where}.{key}".strip(".")) for key, item in value.items()}
        kept = {key: item for key, item in fields.items() if not _claimless(f"{where}.{key}".strip("."), key)}
        if where.endswith("goals.*") and "posterior" in kept and not kept["posterior"]:
            kept["name"] = ""  # of a goal that is impossible
        return {**kept, **({"policy": None} if not where and "policy" not in kept else {})}
    if isinstance(value, list):
        items = [_plain(item, f"{where}.*") for item in value]
        unordered = (
            where.endswith(("plan", "agents", "states", "ties", "goals")) and "human_plan" not in where
        )
        return sorted(items, key=repr) if unordered else items
    return value


def _claimless(where: str, key: str) -> bool:
    return key == "more" or any(where == name or where.startswith(f"{name}.") for name in NO_CLAIM)


def _without_options(data: dict[str, Any]) -> Any:
    return _meaning({key: value for key, value in data.items() if key != "options"})


def _asked(good: Good, result: Result, *, times: bool = False) -> Result | None:
    """What the call is answered under the edited result's options; None where it can't be asked so.

    Args:
        times: with the human's plan as the result has it, too.
    """
    options = {key: value for key, value in result.options.to_dict().items() if not key.endswith("_limit")}
    wanted = ("human_plan", *(("goals", "observed", "plans") if result.goals is not None else ()))
    given = {key: value for key, value in good.asked.items() if key in wanted}
    if times:
        options, given = options | {"head_start": 0}, {"human_plan": result.human_entries}
    try:
        return serendipity.plan(good.task, **options, **given)
    except (UsageError, SerendipityError):
        return None


def _same_answer(good: Good, result: Result, *, times: bool = False) -> bool:
    """Whether the call under the edited options is answered just so, or better known by now."""
    again = _asked(good, result, times=times)
    if again is None:
        return result.status == "infeasible"  # a horizon that is too short for others, say
    figures = ("human_cost", "cost", "objective", "opportunity", "saving", "saving_alone", "reason")
    if result.status in ("optimal", "infeasible"):
        return again.status == result.status and all(
            getattr(again, name) == getattr(result, name) for name in figures
        )
    return _bounded(result, again)


def _bounded(result: Result, again: Result) -> bool:
    """Whether the optimum lies where an unfinished answer says."""
    if result.mode == "assistance" and again.status == "optimal":
        assert result.bounds is not None
        assert again.bounds is not None
        return result.bounds.lower <= again.bounds.lower
    if again.cost is None or again.objective is None or result.lower_bound is None:
        return result.lower_bound in (None, 0.0)
    least = again.objective
    if again.window is not None and not result.opportunity:  # such a bound is net of one epoch
        least = again.cost + float(result.options.window_weight) * (len(again.window) - 1)
    most = float("inf") if result.objective is None else result.objective
    return result.lower_bound <= least + 1e-9 and least <= most + 1e-9


def _beliefs(result: Result) -> dict[str, Any] | None:
    """The recognition that an answer for several goals rests on."""
    return None if result.goals is None or result.recognition is None else result.recognition.to_dict()


def _same_recognition(good: Good, data: dict[str, Any], result: Result) -> bool:
    """Whether the call with the beliefs that the edited result states is answered just so."""
    said = _beliefs(result)
    assert said is not None
    goals = [{key: goal[key] for key in ("name", "goal", "prior")} for goal in said["goals"]]
    options = {key: value for key, value in result.options.to_dict().items() if not key.endswith("_limit")}
    again = serendipity.plan(good.task, goals=goals, observed=said["observed"], beta=said["beta"], **options)
    return bool(_meaning(again.to_dict()) == _meaning(data))


def _other_windows(good: Good, result: Result) -> bool:
    """Whether only windows are elsewhere: help is within them, and the rest is as it would be anyway."""
    for one, before in zip(result.goals or (), good.result.goals or (), strict=True):
        window = one.window or Window(1, 1)
        if replace(one, window=before.window) != before or len(window) != len(before.window or ()):
            return False
        state, rest = set(good.task.init), list[str]()
        for step in sorted(one.plan or (), key=lambda step: step.epoch):
            action = good.task.actions[good.task.named[step.action][0]]
            if step.epoch < window.start and step.agents == (result.human,):
                if step.action != (one.human_plan or ())[step.epoch - 1]:
                    return False
            elif step.epoch >= window.end:
                rest.append(step.action)
                continue
            state = state.difference(action.delete).union(action.add)
        alone = serendipity.plan(replace(good.task, init=frozenset(state)), mode="individual")
        if tuple(rest) != alone.human_plan:
            return False
    return True


def _same_library(good: Good, data: dict[str, Any], result: Result) -> bool:
    """Whether the call with the plans that the edited result takes as given is answered just so."""
    if result.goals is None or result.recognition is not None or result.options.ties == "watched":
        return False
    plans = [
        {"name": one.name, "probability": one.probability, "plan": one.human_plan} for one in result.goals
    ]
    options = {key: value for key, value in result.options.to_dict().items() if not key.endswith("_limit")}
    again = serendipity.plan(good.task, plans=plans, **options)
    return bool(_meaning(again.to_dict()) == _meaning(data))


def _claims_less(good: Good, result: Result) -> bool:
    """Whether only a bound or a status changed, to something weaker or to something else that is true."""
    before = good.result
    weaker = before.status == result.status or (before.status, result.status) in _WEAKER
    same = replace(result, status=before.status, lower_bound=before.lower_bound, reason=before.reason)
    if before.bounds is not None:
        same = replace(same, bounds=before.bounds)
    if before.ties is not None:  # the answers that were looked at
        same = replace(same, ties=before.ties)
    if result.status == "feasible" and result.saving_alone is None:  # not known by then
        same = replace(same, saving_alone=before.saving_alone)
    if not weaker or _meaning(same.to_dict()) != _meaning(before.to_dict()):
        return False
    if result.status == "unknown" and before.reason and not result.reason:
        return True
    if result.status == "optimal":  # some of the answers that were looked at are not listed
        return before.ties is not None and result.lower_bound == before.lower_bound
    again = _asked(good, result)
    return again is not None and result.status != "infeasible" and _bounded(result, again)


def _another_answer(good: Good, result: Result) -> bool:
    """Whether the plan, executed here, costs the same and reaches the goals; a policy is worth the same."""
    before = good.result
    if result.mode == "assistance":
        return result.agent_costs == before.agent_costs and result.status == before.status
    task, state, cost = good.task, set(good.task.init), 0.0
    steps = sorted(result.plan or (), key=lambda step: step.epoch)
    for epoch in sorted({step.epoch for step in steps}):
        chosen = [task.actions[task.named[step.action][0]] for step in steps if step.epoch == epoch]
        if not all(action.applicable(state) for action in chosen):
            return False
        state = state.difference(*(action.delete for action in chosen)).union(*(a.add for a in chosen))
        cost += sum(step.cost for step in steps if step.epoch == epoch)
    return task.goal.holds(state) and abs(cost - (before.cost or 0)) < 1e-9
