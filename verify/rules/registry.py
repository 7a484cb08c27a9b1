"""Every rule of the checker, in the order in which they are checked."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from verify.rules import bound, cost, execution, header, tied, window
from verify.rules.case import Case, Found


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: its name, the claim that it belongs to, its section in ``docs/semantics.md``."""

    name: str
    claim: str
    section: str
    check: Callable[[Case], Found | None]


RULES: Final[tuple[Rule, ...]] = (
    Rule("mode-and-human", "replay", "3", header.mode_and_human),
    Rule("human-plan", "replay", "1", header.human_plan_valid),
    Rule("status-and-plan", "replay", "3", header.status_and_fields),
    Rule("reason", "replay", "3.5", header.reason),
    Rule("ties", "replay", "1", tied.ties),
    Rule("infeasible", "replay", "3.5", header.infeasible),
    Rule("horizon", "replay", "2", header.horizon),
    Rule("epoch-range", "replay", "2", execution.epoch_range),
    Rule("unknown-action", "replay", "1", execution.faultless("unknown-action")),
    Rule("wrong-agents", "replay", "1", execution.faultless("wrong-agents")),
    Rule("precondition", "replay", "2", execution.faultless("precondition")),
    Rule("agent-busy-twice", "replay", "2", execution.faultless("agent-busy-twice")),
    Rule("conflict", "replay", "2", execution.faultless("conflict")),
    Rule("human-goal", "replay", "1", execution.human_goal),
    Rule("robots-goal", "replay", "3.1", execution.robots_goal),
    Rule("individual", "replay", "3", execution.individual),
    Rule("human-cost", "cost", "1", cost.human_cost),
    Rule("step-cost", "cost", "1", cost.step_cost),
    Rule("cost", "cost", "2", cost.total_cost),
    Rule("agent-costs", "cost", "2", cost.agent_costs),
    Rule("objective", "cost", "3.1", cost.objective),
    Rule("max-cost", "cost", "3.1", cost.most_cost),
    Rule("saving", "cost", "3.1", cost.saving),
    Rule("saving-alone", "cost", "1", cost.saving_alone),
    Rule("opportunity", "cost", "3.1", cost.opportunity),
    Rule("ties-mean", "cost", "1", tied.mean),
    Rule("window-presence", "window", "3.1", window.window_presence),
    Rule("idle-answer", "window", "3.1", window.idle_answer),
    Rule("window-range", "window", "3.1", window.window_range),
    Rule("window-length", "window", "3.1", window.window_length),
    Rule("joint-in-prefix", "window", "3.1", window.joint_in_prefix),
    Rule("prefix", "window", "3.1", window.prefix),
    Rule("robot-in-suffix", "window", "3.1", window.robot_in_suffix),
    Rule("suffix-replan", "window", "3.1", window.suffix_replan),
    Rule("suffix-subplan", "window", "3.1", window.suffix_subplan),
    Rule("preserved-state", "window", "3.3", window.preserved_state),
    Rule("bound-and-objective", "lower_bound", "3.1", bound.bound_and_objective),
    Rule("bound-and-status", "lower_bound", "3.1", bound.bound_and_status),
)
