"""Words of certificates: the reasons that claims are given, all in one place.

What a broken rule says is with the rule (``verify.rules``), what is wrong with a recognition or a
policy with those who read them.  Braces stand for figures and words that whoever makes the claim fills in, in
this order; an amount comes as text, in the domain's unit.
"""

from collections.abc import Mapping
from typing import Final

from serendipity.model import Claim, Window

# -- the rules are followed, or nobody looked

FOLLOWED: Final[Mapping[str, str]] = {
    "replay": "every step follows the rules and the goals hold at the end",
    "cost": "every figure is the sum of what it consists of",
    "window": "prefix, window and suffix are as the mode demands",
}
"""What ``verify`` says of a plan that breaks no rule, by claim."""

FOLLOWED_SO_FAR: Final[Mapping[str, str]] = {**FOLLOWED, "cost": "every cost is the sum of its actions'"}
"""The same for ``check``, which proves no saving."""

FOLLOWED_BY_ALL: Final[Mapping[str, str]] = {
    "replay": "{}; robots act by what they have seen, and no plan is broken",
    "cost": "every figure is what it consists of",
    "window": "each scenario's prefix, window and suffix are as the mode demands",
    "lower_bound": "it is consistent with status and objective",
}
"""The same for an answer over scenarios; braces say where these come from."""

POSTERIOR: Final = "the posterior is right"
ALL_OPTIMAL: Final = "the plans are the human's optimal ones"
NO_GOALS_TOLD: Final = "the answer does not say which goals can't be reached alone"
GIVEN_PLANS: Final = "plans and probabilities are taken as given"

FOLLOWED_BY_POLICY: Final = "closed under what the human may do, and every run ends"

NOT_EXAMINED: Final = "not examined"
NEEDS_OPTIMISER: Final = "not examined: the rules alone can't prove it"
NEEDS_MORE_THAN_A_WALK: Final = (
    "not examined: it takes more than a walk through the policy; verify looks at it"
)
NOT_IN_TIME: Final = "not examined in time: suffixes of pi_H and preserved states over scenarios"
NOTHING_TO_EXAMINE: Final = "there is no answer to examine"
RESULT_BREAKS_RULE: Final = "the result breaks a rule already"
ANSWER_BREAKS_RULE: Final = "the answer breaks a rule already"
RULE_BESIDE_EACH: Final = "the best answer beside each optimal plan, under the rule for that plan"
RULE_OVER_TIES: Final = "the best answers beside each optimal plan, under the rule, were not all found"
HUMAN_PAYS: Final = "nobody-pays (semantics 12): the human pays {:.12g}, and {:.12g} without help"
PRICED: Final = {
    True: "no plan that keeps any of what is priced, and pays for the rest, is better",
    False: "a plan that leaves other things changed is better",
    None: "whether another plan is better, with what it leaves, was not examined",
}
"""By what was found out of prices of what is left (semantics 12)."""
LEFT_TOO_DEAR: Final = "leftovers (semantics 12): with what it leaves, help costs no less than none"
UNNOTICED: Final = "noticed (semantics 14): the human has not seen '{}' in time"
DISTURBS: Final = "disturbance (semantics 13): help disturbs the human by {:.12g}, and may by {:.12g}"
LEFT_CHANGED: Final = "nobody-pays (semantics 12): at the end it is not as it would be without help: {}"
NO_REPLAY: Final = "the plan can't be replayed"
NO_REPLAYS: Final = "the plans can't be replayed"
POLICY: Final = "a policy, not a plan"
NO_WINDOW_FOR_HIM: Final = "a human who replans is not bound to a window"


LIKE: Final = "as '{}': {}"


def same_as(claim: Claim) -> str:
    """What holds for one claim holds for another."""
    return LIKE.format(claim.claim, claim.reason)


# -- the human's own plan

PI_H_IS_CANONICAL: Final = "; pi_H is the human's canonical optimal plan"
PI_H_IS_OPTIMAL: Final = "; pi_H is an optimal plan of the human, not the canonical one: taken as given"
PI_H_IS_GIVEN: Final = "; pi_H is not optimal: taken as given"
NOT_ALONE: Final = "the goal can't be reached alone"
NO_GOAL_ALONE: Final = "no goal that is possible can be reached alone"
ALL_VISITED: Final = "all states that the human reaches alone were visited"
HE_HAS_A_PLAN: Final = "the human has a plan alone"
LEAST_ALONE: Final = "the least cost alone is {:.12g}"

# -- counter-examples, and what else refutes

BETTER: Final = "a better plan"
OPPORTUNITY: Final = "an opportunity"
BELOW_BOUND: Final = "a plan below the bound"
PLAN: Final = "a plan"
NOTHING_IS_BETTER: Final = "doing nothing is better"
AS_WELL_ALONE: Final = "the human does as well without a robot"
LEFT_ALONE_IS_DEARER: Final = "leaving the human alone costs more"
NOTHING_TO_COMPARE: Final = "a saving, though doing nothing is no answer"
POLICY_ENDS: Final = "there is a policy that ends"
ONE_ROBOT: Final = "mode 'assistance' is for one robot"


def described(example: str, cost: str, objective: str, window: Window | None) -> str:
    """A counter-example with its figures."""
    words = f"{example}: cost {cost}, objective {objective}"
    return words if window is None else f"{words}, window [{window.start}, {window.end})"


EXAMPLE_BREAKS: Final = "the counter-example breaks a rule: {}"
EXAMPLE_UNCHECKED: Final = "a counter-example could not be checked: {}"
OPTIMUM_IS_CHEAPER: Final = "the optimum costs less than {}, robots idle"
NO_CHEAPER: Final = "the plan costs no less than {}, robots idle"
NOTHING_COSTS: Final = "doing nothing costs {}"
NOTHING_HAS_OBJECTIVE: Final = "doing nothing has the objective {}"
WITHOUT_ROBOTS: Final = "without robots it costs {}"
FIGURE: Final = "{} is {:g}, the result says {}"
EXPECTED_SAVING_ALONE: Final = "saving_alone is {:.12g}, the answer says {}"
BETTER_POLICY: Final = "a better policy: cost {:.12g}, objective {:.12g}"
BOUND_EXPECTED: Final = "lower_bound: expected {:g}"

# -- proofs

CLOSED: Final = "; closed by reachability and shortest paths, no solver call"
NO_SOLUTION: Final = "no solution"
NO_LESS_THAN_ALONE: Final = "the optimum costs no less than the answer without robots"
BEST_NO_LESS_THAN_ALONE: Final = "the best plan costs no less than the answer without robots"
NOTHING_SATISFIES: Final = "no plan satisfies the program"
ALL_PLAYED: Final = "everything that robots can do was played"
ALL_POLICIES: Final = "every policy of the robots was looked at"
EACH_ADDS_UP: Final = "the best answers to each scenario by itself come to it"
RUNS_FOR_EVER: Final = "whatever the supporter does, a run may go on for ever"
FLOORS_REACH: Final = "lower bounds that prove each other reach the policy's value"
TOGETHER_MIGHT: Final = "both together, without turns, might pay less"


def no_better(amount: str, *, tie: bool) -> str:
    """No plan has a better score; ``tie``: there might be one of the same objective at a lower cost."""
    words = f"no plan has an objective below {amount}"
    return f"{words}, or the same at a lower cost" if tie else words


def solved(solver: str, calls: int, columns: int, rows: int) -> str:
    """What a solver was given; what it answered follows."""
    programs = "1 program" if calls == 1 else f"{calls} programs, the largest"
    return f"; {solver} solved {programs} of {columns:,} columns and {rows:,} rows: "


APART: Final = "; robots looked at one by one, {:,} states that they leave behind or lead to"
SEARCHED: Final = "; {:,} states searched exhaustively"


def optimum(objective: str, cost: str) -> str:
    """What a program allows at best."""
    return f"optimum {cost}" if objective == cost else f"objective {objective}, optimum cost {cost}"


NONE_BELOW: Final = "no plan has an objective below {:.12g}"
KNOWN_BOUND: Final = "; no answer has an objective below {:.12g}"
ALL_CHEAPER_PLAYED: Final = "everything that robots can do for less than {} was played"
WHATEVER_HAPPENS: Final = "no joint plan costs less than {}, whatever the human does"
PLAYED_AGAIN: Final = "played again, {}: as the result says"
POLICY_VALUES: Final = "each value is what a round and the values after it make: {}"
POLICY_AT_MOST: Final = "doing nothing is worth {} at most"
TOGETHER_PAY: Final = "both together pay at least {}"

# -- all optimal plans of the human at once

NOT_OPTIMAL_TIE: Final = "statistics.ties lists a plan that is not an optimal one of the human"
TIE_WITHOUT_ITS_PLAN: Final = "statistics.ties lists an answer that is not the best one, without its plan"
TIES_MISSING: Final = "a mean that was not proved lists an answer for each optimal plan of the human"
ONE_OF_SEVERAL: Final = "the answer beside one of several optimal plans is not the mean over all of them"
TIE_WITHOUT_PLAN: Final = "with some optimal pi_H there is no plan"
OVER_TIES: Final = "the {} cost over {} optimal plans of the human is {:.12g}"
NO_TIE_IS_DEARER: Final = (
    "robust over {} optimal plans of the human: none is dearer than leaving them alone, {:.12g}"
)
NO_TIE_IS_CHEAPER: Final = "whichever of {} optimal plans the human is on, nothing costs less than {:.12g}"
TIES_BOUND: Final = "{}, and lower_bound is beyond what {} ties prove"
TIES_SAVINGS: Final = "{}; expected saving and saving_alone to be {} and {}"


def tie_costs(human_plan: tuple[str, ...], cost: float | None) -> str:
    """One of the answers listed is wrong."""
    return f"statistics.ties: with pi_H = {', '.join(human_plan)} the cost is {cost}"


def tie_breaks(human_plan: tuple[str, ...], why: object) -> str:
    """An answer that is listed is none."""
    return f"statistics.ties: with pi_H = {', '.join(human_plan)}: {why}"
