"""What planted bugs break, by role, and where that is in the code today.

Who renames or moves something edits its line here and nothing else: bugs speak of roles only.
``tests/verify/test_roles_resolve.py`` names the role whose line is out of date.
"""

import inspect
import re
from importlib import import_module
from typing import Any, NamedTuple

PLACES = {
    # the model's rules
    "whether an action is applicable": "serendipity.model.task.actions:GroundAction.applicable",
    "whether two actions conflict": "serendipity.model.task.actions:conflicting",
    "whether an action disables another": "serendipity.model.task.actions:disables",
    # the packed task
    "whether an operator is applicable": "search.packed.operators:applicable",
    "operators that an index offers": "search.packed.operator_index:OperatorIndex.candidates",
    "packing an action": "search.packed.packed_task:PackedTask._pack_action",
    "packing conditions": "search.packed.packed_task:PackedTask._literals",
    "actions relevant to the goals": "search.packed.packed_task:relevant_to_goals",
    "whether two actions may share an epoch": "search.packed.packed_task:PackedTask.compatible",
    "whether the goal holds": "search.packed.packed_task:PackedGoal.holds",
    "variables of the human's own actions": "search.packed.packed_task:PackedTask.own_mask",
    "variables that robots change": "search.packed.packed_task:PackedTask.outside",
    "what an action does, while a plan is put into epochs": "search.packed.parallelise:_deeds",
    # successors
    "what robots do beside the human": "search.packed.successor_generator:Successors.with_robots",
    "robots' joint actions": "search.packed.successor_generator:Successors.robots",
    "joint actions with the human": "search.packed.successor_generator:Successors.joint",
    "whether an action fits beside others": "search.packed.due:Due.fits",
    "whether a set can be done in some order": "search.packed.successor_generator:Successors.sequential",
    "sets of a team that need one epoch": "search.classical.team:circles",
    # costs and orders
    "weights of operators": "search.packed.cost_vector:Weights.__init__",
    "cost of a joint action": "search.packed.cost_vector:Weights.team",
    "cost of communicating a suffix": "search.packed.cost_vector:CostLayout.announce",
    "cost vector of an action": "search.packed.cost_vector:CostLayout.of_action",
    "whether a cost exceeds max_cost": "search.packed.cost_vector:CostLayout.exceeds",
    "cost vector of a window's start": "search.packed.cost_vector:CostLayout.of_start",
    "dominance between labels": "search.engine.dominance:ParetoFront._covered",
    "limits in dominance": "search.engine.dominance:ParetoFront.__init__",
    # the human: the suffix, the plan alone
    "cost of a replanned suffix": "search.human.suffix_rules:Replan.key",
    "cost of a suffix from pi_H": "search.human.suffix_rules:Subplan.key",
    "goals of a suffix from pi_H": "search.human.suffix_rules:Subplan.__init__",
    "steps of pi_H where a preserved suffix may begin": "search.human.suffix_rules:Preserved._fitting",
    "the canonical plan": "search.human.individual_planner:PlanGraph.canonical",
    "search for the human's plan alone": "search.human.individual_planner:IndividualPlanner._search",
    "distances in the pattern database": "search.human.pattern_database:backward",
    "actions in the pattern database": "search.human.pattern_database:_transitions",
    # spaces
    "prefix that follows pi_H": "search.spaces.windowed:InLayers.options",
    "prefix of actions of pi_H": "search.spaces.windowed:AnyOfPlan.options",
    "opening a window": "search.spaces.windowed:Windowed._open",
    "ending a window": "search.spaces.windowed:Windowed._end",
    "limits of the window space": "search.spaces.windowed:Windowed.__init__",
    "limits of the unrestricted space": "search.spaces.unrestricted:Unrestricted.__init__",
    "limits of the space of a fixed plan": "search.spaces.fixed_human_plan:FixedHumanPlan.__init__",
    "longest window that may pay": "search.spaces.factory:_reach",
    # the planner
    "best-first search": "search.strategies.windows:best_first",
    "whether an answer is an opportunity": "search.strategies.outcome:helps",
    "whether a given plan can be improved": "search.strategies.human_plan:_is_dearer",
    # lower bounds
    "whether an action is an interaction": "search.bounds.interactions:Interactions.is_interaction",
    "private distances": "search.bounds.private_distances:PrivateDistances.explore",
    "bound of the first interaction": "search.bounds.first_interaction:FirstInteraction.__call__",
    "a need that may pay": "search.bounds.first_interaction:_Promise.__init__",
    "needs that may still pay": "search.bounds.first_interaction:survivors",
    "bound if the window opens now": "search.bounds.prefix_bounds:FirstInteractionOnTheWay.opening",
    "bound if the window opens later": "search.bounds.prefix_bounds:FirstInteractionOnTheWay.later",
    "epochs that a cost takes": "search.bounds.achievers:Achievers.epochs",
    "achievers of a need": "search.bounds.achievers:Achievers.provided",
    "phases of pi_H": "search.bounds.achievers:Achievers.phases",
    "cost to achieve a need": "search.bounds.achiever_costs:AchieverCosts.__call__",
    "edges of the achiever automaton": "search.bounds.achiever_automaton:AchieverAutomaton._changes",
    "what pi_H changes in the achiever automaton": (
        "search.bounds.achiever_automaton:AchieverAutomaton.__init__"
    ),
    "slack of the achiever automaton": "search.bounds.achiever_automaton:AchieverAutomaton.distances",
    "robots' walks in the transition graph": "search.robots.transition_graphs:TransitionGraph.__init__",
    # decoupled walks
    "whether a walk ends in time": "search.packed.successor_generator:in_time",
    "length of a walk": "search.robots.decoupled:Decoupled.ways",
    "how long robots have been idle": "search.robots.decoupled:DecoupledSuccessors.rested",
    "whether pi_H asks where robots are": "search.robots.decoupled:Decoupled.touched_by",
    "writing walks down": "search.robots.decoupled:Decoupled.steps",
    # several plans of the human, and humans who replan
    "which optimal plans are looked at": "serendipity.facade.ties:until_settled",
    "which of the answers over ties counts": "serendipity.facade.ties:_extreme",
    "the mean over ties": "serendipity.facade.ties:_mean",
    "what a human who looks up decides": "search.modes.simulation.human:Human._decide",
    "whether a human takes part when asked": "search.modes.simulation.human:Human.accepts",
    "what a local human sees": "search.modes.simulation.eyes:Nearby.look",
}
"""Functions and methods that bugs replace.

A function named in the module that defines it is replaced wherever it was imported, too; one
named in a module that imports it, there only.
"""

PARTS = {
    "task": "search.packed.packed_task:PackedTask.task",
    "bits of a fact": "search.packed.packed_task:PackedTask.fact_bits",
    "single facts": "search.packed.packed_task:PackedTask.boolean",
    "own operators": "search.packed.packed_task:PackedTask.own",
    "variables that operators change": "search.packed.packed_task:PackedTask.changed_by",
    "operator": "search.packed.packed_task:PackedTask.op",
    "the human's bit": "search.packed.packed_task:PackedTask.human_bit",
    "index of operators": "search.packed.operator_index:OperatorIndex.by_value",
    "indexed variable": "search.packed.operator_index:OperatorIndex.field",
    "layout": "search.packed.cost_vector:Weights.keys",
    "human's weights": "search.packed.cost_vector:Weights.human",
    "robots' weights": "search.packed.cost_vector:Weights.robots",
    "the human's bit in weights": "search.packed.cost_vector:Weights._human_bit",
    "order of limits": "search.engine.dominance:ParetoFront._no_worse",
    "planner of a replanned suffix": "search.human.suffix_rules:Replan.alone",
    "layout of a replanned suffix": "search.human.suffix_rules:Replan.keys",
    "steps of a suffix from pi_H": "search.human.suffix_rules:Subplan._steps",
    "goals": "search.human.suffix_rules:Subplan._goals",
    "steps of a preserved suffix": "search.human.suffix_rules:Preserved._ops",
    "whether the rest works": "search.human.suffix_rules:Preserved._works",
    "all plans": "search.human.individual_planner:PlanGraph.plans",
    "known costs alone": "search.human.individual_planner:IndividualPlanner._known",
    "steps of pi_H": "search.spaces.windowed:InLayers._layers",
    "successors": "search.spaces.windowed:AnyOfPlan._successors",
    "actions": "search.spaces.windowed:AnyOfPlan._actions",
    "names of pi_H": "search.spaces.windowed:AnyOfPlan._planned",
    "predicted plan": "search.strategies.call:Call.plan",
    "incumbent": "search.strategies.call:Call.best",
    "best with robots idle": "search.strategies.call:Call.idle",
    "layout of the call": "search.strategies.call:Call.keys",
    "packed task": "search.bounds.interactions:Interactions._packed",
    "steps after a need": "search.bounds.private_distances:PrivateDistances.steps_after",
    "latest epoch of a need": "search.bounds.first_interaction:_Promise.latest",
    "bounds along pi_H": "search.bounds.prefix_bounds:FirstInteractionOnTheWay._openings",
    "bounds without help": "search.bounds.prefix_bounds:PrefixBounds.without",
    "spent along pi_H": "search.bounds.prefix_bounds:FirstInteractionOnTheWay._spent",
    "cost of achievers": "search.bounds.achievers:Provided.cost",
    "steps of achievers": "search.bounds.achievers:Provided._steps",
    "what pi_H changes": "search.bounds.achiever_automaton:AchieverAutomaton._flips",
    "walks": "search.robots.transition_graphs:TransitionGraph.walks",
}
"""Attributes of objects that bugs look at or change."""


class Place(NamedTuple):
    """Where something is.

    Attributes:
        module: the module.
        owner: the module or the class.
        name: the attribute's.
    """

    module: Any
    owner: Any
    name: str


def place(role: str) -> Place:
    """Where what plays a role is defined.

    Raises:
        LookupError: if it is no longer there; the text names the role.
    """
    found = _place(role, PLACES[role])
    if not any(found.name in vars(owner) for owner in _owners(found)):
        raise _lost(role, PLACES[role])
    return found


def name_of(role: str) -> str:
    """The name of an attribute that plays a role.

    Raises:
        LookupError: as above.
    """
    found = _place(role, PARTS[role])
    if not any(_has(owner, found.name) for owner in _owners(found)):
        raise _lost(role, PARTS[role])
    return found.name


def part(of: Any, role: str) -> Any:
    """The attribute of an object that plays a role."""
    return getattr(of, _name(role))


def put(of: Any, role: str, value: Any) -> None:
    """Change the attribute of an object that plays a role."""
    setattr(of, _name(role), value)


def _name(role: str) -> str:
    return PARTS[role].rpartition(".")[2]


def _place(role: str, path: str) -> Place:
    where, _, dotted = path.partition(":")
    *owners, name = dotted.split(".")
    try:
        module = owner = import_module(where)
        for each in owners:
            owner = getattr(owner, each)
    except (ImportError, AttributeError):
        raise _lost(role, path) from None
    return Place(module, owner, name)


def _owners(found: Place) -> list[Any]:
    """The module, or the class and its bases."""
    return (
        [c for c in found.owner.__mro__ if c is not object]
        if found.owner is not found.module
        else [found.module]
    )


def _has(owner: Any, name: str) -> bool:
    """Whether a class has an attribute, be it in its body or in what its methods set."""
    declared = name in vars(owner) or name in getattr(owner, "__annotations__", ())
    return declared or re.search(rf"\bself\.{name}\b[^=\n()]*=[^=]", inspect.getsource(owner)) is not None


def _lost(role: str, path: str) -> LookupError:
    return LookupError(
        f"role {role!r}: not found; where is it now? (tests/verify/planted/roles.py says {path})"
    )
