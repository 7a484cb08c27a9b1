"""Problems and plans of unified-planning that mean something here, and the place of the engine in it."""

from typing import Final

from unified_planning import environment
from unified_planning.engines import factory
from unified_planning.model import AbstractProblem, DurativeAction, ProblemKind
from unified_planning.model.problem_kind_versioning import LATEST_PROBLEM_KIND_VERSION
from unified_planning.plans import PlanKind

from serendipity.model import InputError

ENGINE: Final = "serendipity"
"""The name of the engine."""

_MODULE: Final = "serendipity_up.engine"
_CLASS: Final = "SerendipityEngine"


def register() -> None:
    """Make the engine known to the factory that is in use, if there is one, and to those to come.

    Where ``up.ini`` names it, it is the factory that imports this: so none is made here.
    """
    factory.DEFAULT_ENGINES[ENGINE] = (_MODULE, _CLASS)
    if ENGINE not in factory.DEFAULT_ENGINES_PREFERENCE_LIST:
        factory.DEFAULT_ENGINES_PREFERENCE_LIST.append(ENGINE)
    current = environment.GLOBAL_ENVIRONMENT
    if current is not None and ENGINE not in current.factory.engines:
        current.factory.add_engine(ENGINE, _MODULE, _CLASS)


_FEATURES: Final = (
    "ACTION_BASED",
    "ACTION_BASED_MULTI_AGENT",
    "FLAT_TYPING",
    "HIERARCHICAL_TYPING",
    "OBJECT_FLUENTS",
    "NEGATIVE_CONDITIONS",
    "DISJUNCTIVE_CONDITIONS",
    "EQUALITIES",
    "EXISTENTIAL_CONDITIONS",
    "UNIVERSAL_CONDITIONS",
    "CONDITIONAL_EFFECTS",
    "FORALL_EFFECTS",
    "STATIC_FLUENTS_IN_BOOLEAN_ASSIGNMENTS",
    "FLUENTS_IN_BOOLEAN_ASSIGNMENTS",
    "STATIC_FLUENTS_IN_OBJECT_ASSIGNMENTS",
    "FLUENTS_IN_OBJECT_ASSIGNMENTS",
    "ACTIONS_COST",
    "PLAN_LENGTH",
    "STATIC_FLUENTS_IN_ACTIONS_COST",
    "INT_NUMBERS_IN_ACTIONS_COST",
    "REAL_NUMBERS_IN_ACTIONS_COST",
    "AGENT_SPECIFIC_PRIVATE_GOAL",
    "AGENT_SPECIFIC_PUBLIC_GOAL",
    "CONTINUOUS_TIME",
    "TIMED_EFFECTS",
    "SELF_OVERLAPPING",
    "DURATION_INEQUALITIES",
    "STATIC_FLUENTS_IN_DURATIONS",
    "INT_TYPE_DURATIONS",
    "REAL_TYPE_DURATIONS",
)

PLANS: Final = (PlanKind.SEQUENTIAL_PLAN, PlanKind.PARTIAL_ORDER_PLAN)
"""Kinds of plans that are written and validated."""


_HELPED: Final = {
    "STATE_INVARIANTS": "the compiler STATE_INVARIANTS_REMOVING",
    "TRAJECTORY_CONSTRAINTS": "the compiler TRAJECTORY_CONSTRAINTS_REMOVING",
    "OVERSUBSCRIPTION": "the engine oversubscription[serendipity]",
}
"""What of unified-planning itself turns problems that have a feature into problems without it."""


def supported_kind() -> ProblemKind:
    """All that a problem may have."""
    return ProblemKind(_FEATURES, version=LATEST_PROBLEM_KIND_VERSION)


def require_supported(problem: AbstractProblem) -> None:
    """Refuse a problem of another kind."""
    kind = problem.kind
    if not kind <= supported_kind():
        beyond = sorted(f for f in kind.features if f not in _FEATURES)
        helps = dict.fromkeys(_HELPED[feature] for feature in beyond if feature in _HELPED)
        hint = f"; {' and '.join(helps)} of unified-planning may help" if helps else ""
        raise refusal(problem, f"{', '.join(beyond)}: not supported{hint}")


def in_time(problem: AbstractProblem) -> bool:
    """Whether there are durative actions or timed effects: plans say when actions begin."""
    teams = getattr(problem, "agents", None) or [problem]
    durative = (isinstance(action, DurativeAction) for team in teams for action in team.actions)
    return bool(getattr(problem, "timed_effects", ())) or any(durative)


def refusal(problem: AbstractProblem, message: str) -> InputError:
    """An error about a problem."""
    name = "" if problem.name is None else f" '{problem.name}'"
    return InputError(f"unified-planning problem{name}: {message}")


def with_metric(problem: AbstractProblem) -> bool:
    """Whether the problem says what an optimal plan is."""
    return bool(getattr(problem, "quality_metrics", ()))
