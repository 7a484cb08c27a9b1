"""What is asked of an integer program: one minimum, under one mode's rules.

A :class:`Subproblem` holds all that decides which plans are allowed and what they cost;
both encodings answer it.  Costs become integers here: all are multiplied by the least
common multiple of their denominators, so that cheaper means cheaper by at least 1.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import TypeVar

from serendipity.model import Condition, Deadline, HumanPlan, Options, Step, Task, Window
from verify.base.execution import idling, price
from verify.base.plan_graph import OptimalPlanGraph

Amount = TypeVar("Amount", int, tuple[int, int])

FREE, WINDOW, EXACT, ALONE = "free", "window", "exact", "alone"
"""Rules for the human: anything (semantics 3.4), a window (3.1), exactly ``pi_H``, their own actions only."""


@dataclass(frozen=True, slots=True)
class IntegerPrices:
    """Integer costs of one question, in units of ``1 / scale``.

    Attributes:
        scale: units per unit of the domain's cost; 0 where only the order of sums is kept.
        team: cost of each action to the team, discounted (semantics 1).
        talk: what each action adds to the objective for communication (Def. 3.2).
        epoch: ``K``: what an epoch of the window adds to the objective.
    """

    scale: int
    team: tuple[int, ...]
    talk: tuple[int, ...]
    epoch: int

    def units(self, amount: Fraction) -> int:
        """The largest number of units that is at most ``amount``."""
        return (amount * self.scale).__floor__()

    def cost(self, units: int) -> Fraction:
        """The cost that a number of units is."""
        return Fraction(units, self.scale)


@dataclass(frozen=True, slots=True)
class PricedPlan:
    """A plan that answers a question, replayed; costs in the question's units."""

    steps: tuple[Step, ...]
    window: Window | None
    objective: int
    cost: int


@dataclass(frozen=True)
class Subproblem:
    """Minimise the objective over the plans that a rule allows.

    Attributes:
        options: discount, interference, suffix and the other options in force.
        rule: ``free``, ``window``, ``exact`` or ``alone``.
        human_plan: ``pi_H``; empty where there is none.
        any_of: where the human may be on any of their optimal plans: these; ``human_plan`` is one of them.
        robots: whether robots (and joint actions) take part at all.
        robots_goal: whether ``G_R`` has to be reached.
        most: the objective may not exceed this many units, or None.
        most_cost: the cost may not exceed this many units, or None.
    """

    task: Task
    options: Options
    rule: str
    human_plan: HumanPlan
    horizon: int
    prices: IntegerPrices
    any_of: OptimalPlanGraph | None = None
    robots: bool = True
    robots_goal: bool = True
    most: int | None = None
    most_cost: int | None = None
    deadline: Deadline = field(default_factory=Deadline, compare=False, repr=False)

    def but(self, **changes: object) -> "Subproblem":
        """This question with some fields changed."""
        return replace(self, **changes)  # type: ignore[arg-type]

    def below(self, most: int | None, most_cost: int | None = None) -> "Subproblem":
        """The same with tighter limits on objective and cost (eq. 11)."""
        return replace(self, most=least(self.most, most), most_cost=least(self.most_cost, most_cost))

    @cached_property
    def an_epoch(self) -> int:
        """An epoch adds no more than this to the objective."""
        dearest = max(self.prices.team, default=0) + max(self.prices.talk, default=0)
        return len(self.task.agents) * dearest + self.prices.epoch

    @property
    def largest(self) -> int:
        """No plan that is asked for has a larger objective: the limit, or what fits into the horizon."""
        whole = self.horizon * self.an_epoch
        return whole if self.most is None else min(self.most, whole)

    @property
    def replans(self) -> bool:
        """Whether suffixes have to be optimal plans of the human's own (Def. 2.0a)."""
        options = self.options
        return self.rule == WINDOW and options.suffix == "replan" and options.preservation == "kernel"

    @property
    def has_plain_windows(self) -> bool:
        """Whether ``pi_H`` is followed up to a window and replanned after it, and robots have no goals."""
        followed = bool(self.human_plan) and not self.options.keep_prefix
        return self.replans and followed and not (self.robots_goal and self.task.robot_goal)

    @property
    def is_free(self) -> bool:
        """Whether the window of all epochs is as good as any: no epoch of it costs, and none is too many.

        There is neither prefix nor suffix then, so that every plan fits it.
        """
        options, longest = self.options, self.options.max_window
        whole = longest is None or longest >= self.horizon
        kernel = options.preservation == "kernel" and not options.keep_prefix
        return self.rule == WINDOW and not self.prices.epoch and whole and bool(self.human_plan) and kernel

    @cached_property
    def goal(self) -> Condition:
        """What has to hold in the end: ``G_H``, ``G_R`` where it is asked for, and nobody is at anything."""
        his, theirs = self.task.goal, self.task.robot_goal if self.robots_goal else Condition()
        return Condition(his.positive + theirs.positive + self.task.at_rest, his.negative + theirs.negative)

    def allowed(self) -> list[int]:
        """Ids of the actions that may occur at all."""
        if self.rule == ALONE or not self.robots:
            return sorted({*self.task.human_actions, *self.task.of_bystanders})
        return list(range(len(self.task.actions)))

    def measure(self, steps: Iterable[Step], window: Window | None) -> tuple[int, int]:
        """Objective and cost of a plan in units."""
        steps = tuple(steps)
        cost = sum(self.prices.team[step.action] for step in steps)
        talk = sum(self.prices.talk[step.action] for step in steps)
        return cost + talk + (self.prices.epoch * len(window) if window else 0), cost


def in_plan(task: Task, human_plan: HumanPlan) -> frozenset[int]:
    """The actions that are in ``pi_H``: all that share a name with one of its steps.

    They are variants of one PDDL action, whose conditions are disjunctive or whose effects are conditional.
    """
    names = {task.actions[i].name for i in human_plan}
    return frozenset(i for i, action in enumerate(task.actions) if action.name in names)


def least(a: Amount | None, b: Amount | None) -> Amount | None:
    """The lesser of two amounts, or of two scores, either of which may not be there."""
    return b if a is None else a if b is None else min(a, b)


_Kind = tuple[tuple[int, int], bool, bool]
"""What an action's price depends on: its cost, whether the human takes part, whether they have to be told."""


def prices(
    task: Task, options: Options, human_plan: HumanPlan, deadline: Deadline | None = None
) -> IntegerPrices:
    """The integer costs of a call.

    Communication costs nothing outside communication mode, and ``K`` nothing without windows.
    """
    deadline, planned = deadline or Deadline(), in_plan(task, human_plan) | idling(task)
    weight = options.communication_weight if options.mode == "communication" else Fraction(0)
    epoch = options.window_weight if options.windowed else Fraction(0)
    kinds: list[_Kind] = []  # few different ones: rationals are slow
    amounts: dict[_Kind, tuple[Fraction, Fraction]] = {}
    for i, action in enumerate(deadline.each(task.actions)):
        his = task.human in action.participants
        kind = action.cost.as_integer_ratio(), his, his and i not in planned
        if kind not in amounts:
            talk = weight * action.cost if kind[2] else Fraction(0)
            amounts[kind] = price(task, action, options.discount), talk
        kinds.append(kind)
    scale = lcm(epoch.denominator, *(amount.denominator for both in amounts.values() for amount in both))
    units = {kind: (int(team * scale), int(talk * scale)) for kind, (team, talk) in amounts.items()}
    return IntegerPrices(
        scale,
        tuple(units[kind][0] for kind in deadline.each(kinds)),
        tuple(units[kind][1] for kind in deadline.each(kinds)),
        int(epoch * scale),
    )
