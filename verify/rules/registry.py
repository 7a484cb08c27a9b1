"""Every rule of the checker, in the order in which they are checked."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from serendipity.model import Window
from verify.rules import bound, cost, execution, header, tied, window
from verify.rules.case import CheckedResult, RuleFault
from verify.rules.execution import Rule


@dataclass(frozen=True, slots=True)
class NamedRule:
    """A rule: its name, the claim that it belongs to, its section in ``docs/semantics.md``."""

    name: str
    claim: str
    section: str
    check: Rule


def _of_window(rule: Callable[[CheckedResult, Window], RuleFault | None]) -> Rule:
    """A rule that is kept where there is no window."""

    def check(case: CheckedResult) -> RuleFault | None:
        return None if case.result.window is None else rule(case, case.result.window)

    return check


RULES: Final[tuple[NamedRule, ...]] = (
    NamedRule("mode-and-human", "replay", "3", header.mode_and_human),
    NamedRule("human-plan", "replay", "1", header.human_plan_valid),
    NamedRule("status-and-plan", "replay", "3", header.status_and_fields),
    NamedRule("reason", "replay", "3.5", header.reason),
    NamedRule("ties", "replay", "1", tied.ties),
    NamedRule("infeasible", "replay", "3.5", header.infeasible),
    NamedRule("horizon", "replay", "2", header.horizon),
    NamedRule("epoch-range", "replay", "2", execution.epoch_range),
    NamedRule("unknown-action", "replay", "1", execution.faultless("unknown-action")),
    NamedRule("wrong-agents", "replay", "1", execution.faultless("wrong-agents")),
    NamedRule("precondition", "replay", "2", execution.faultless("precondition")),
    NamedRule("agent-busy-twice", "replay", "2", execution.faultless("agent-busy-twice")),
    NamedRule("conflict", "replay", "2", execution.faultless("conflict")),
    NamedRule("at-rest", "replay", "10.1", execution.at_rest),
    NamedRule("human-goal", "replay", "1", execution.human_goal),
    NamedRule("robots-goal", "replay", "3.1", execution.robots_goal),
    NamedRule("individual", "replay", "3", execution.individual),
    NamedRule("human-cost", "cost", "1", cost.human_cost),
    NamedRule("step-cost", "cost", "1", cost.step_cost),
    NamedRule("cost", "cost", "2", cost.total_cost),
    NamedRule("agent-costs", "cost", "2", cost.agent_costs),
    NamedRule("objective", "cost", "3.1", cost.objective),
    NamedRule("max-cost", "cost", "3.1", cost.most_cost),
    NamedRule("saving", "cost", "3.1", cost.saving),
    NamedRule("saving-alone", "cost", "1", cost.saving_alone),
    NamedRule("opportunity", "cost", "3.1", cost.opportunity),
    NamedRule("ties-mean", "cost", "1", tied.mean),
    NamedRule("window-presence", "window", "3.1", window.window_presence),
    NamedRule("idle-answer", "window", "3.1", window.idle_answer),
    NamedRule("window-range", "window", "3.1", _of_window(window.window_range)),
    NamedRule("window-length", "window", "3.1", _of_window(window.window_length)),
    NamedRule("joint-in-prefix", "window", "3.1", _of_window(window.joint_in_prefix)),
    NamedRule("prefix", "window", "3.1", _of_window(window.prefix)),
    NamedRule("robot-in-suffix", "window", "3.1", _of_window(window.robot_in_suffix)),
    NamedRule("suffix-replan", "window", "3.1", _of_window(window.suffix_replan)),
    NamedRule("suffix-subplan", "window", "3.1", _of_window(window.suffix_subplan)),
    NamedRule("preserved-state", "window", "3.3", _of_window(window.preserved_state)),
    NamedRule("bound-and-objective", "lower_bound", "3.1", bound.bound_and_objective),
    NamedRule("bound-and-status", "lower_bound", "3.1", bound.bound_and_status),
)
