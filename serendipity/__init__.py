"""Serendipity: plan help for a person who did not ask, and prove that none is better.

Everything public is importable from here and loads when it is first used::

    import serendipity

    task = serendipity.example("room2")
    result = serendipity.plan(task, discount=0.6)
    certificate = serendipity.verify(task, result)
"""

from serendipity._version import __version__

TYPE_CHECKING = False  # of `typing`, which the command line need not load before it listens to Ctrl-C

if TYPE_CHECKING:
    from typing import Any

    from serendipity.evaluation.reproduction import Progress, Reproduction, Row, reproduce
    from serendipity.execution import Execution, Run, Runs, execute
    from serendipity.explanation import Explanation, PolicyExplanation, explain, explain_policy
    from serendipity.facade.bystanders import with_bystanders
    from serendipity.facade.certify import check, verify
    from serendipity.facade.front import Front, FrontPoint, front
    from serendipity.facade.interruptibility import Interruption, InterruptionReport, Removal, interruptions
    from serendipity.facade.loading import load, load_agents, load_pddl
    from serendipity.facade.planning import plan, plan_anytime
    from serendipity.facade.proofs import check_proof
    from serendipity.facade.session import Session
    from serendipity.facade.showing import Drawing, show
    from serendipity.facade.simulation import simulate
    from serendipity.lint import Finding, TaskReport, TaskTime, check_task
    from serendipity.model import (
        Certificate,
        Claim,
        Condition,
        Deadline,
        Decision,
        GapEntry,
        GoalAnswer,
        GroundAction,
        HumanModel,
        InputError,
        LimitReachedError,
        Mode,
        Options,
        PlanError,
        PlanOptions,
        PlanStep,
        PlanTimes,
        Policy,
        ProofCheck,
        RefutedProgram,
        Result,
        Script,
        SerendipityError,
        StateDelta,
        Status,
        Table,
        Task,
        TiedAnswer,
        Timing,
        Trace,
        TraceEpoch,
        TraceSkip,
        UsageError,
        Verdict,
        Window,
    )
    from serendipity.recognition import GoalPosterior, Recognition, recognise
    from serendipity.scenarios.examples import example
    from serendipity.scenarios.generate import generate_usar

__all__ = [
    "Certificate",
    "Claim",
    "Condition",
    "Deadline",
    "Decision",
    "Drawing",
    "Execution",
    "Explanation",
    "Finding",
    "Front",
    "FrontPoint",
    "GapEntry",
    "GoalAnswer",
    "GoalPosterior",
    "GroundAction",
    "HumanModel",
    "InputError",
    "Interruption",
    "InterruptionReport",
    "LimitReachedError",
    "Mode",
    "Options",
    "PlanError",
    "PlanOptions",
    "PlanStep",
    "PlanTimes",
    "Policy",
    "PolicyExplanation",
    "Progress",
    "ProofCheck",
    "Recognition",
    "RefutedProgram",
    "Removal",
    "Reproduction",
    "Result",
    "Row",
    "Run",
    "Runs",
    "Script",
    "SerendipityError",
    "Session",
    "StateDelta",
    "Status",
    "Table",
    "Task",
    "TaskReport",
    "TaskTime",
    "TiedAnswer",
    "Timing",
    "Trace",
    "TraceEpoch",
    "TraceSkip",
    "UsageError",
    "Verdict",
    "Window",
    "__version__",
    "check",
    "check_proof",
    "check_task",
    "example",
    "execute",
    "explain",
    "explain_policy",
    "front",
    "generate_usar",
    "interruptions",
    "load",
    "load_agents",
    "load_pddl",
    "plan",
    "plan_anytime",
    "recognise",
    "reproduce",
    "show",
    "simulate",
    "verify",
    "with_bystanders",
]

_HOMES = {
    "evaluation.reproduction": "Progress Reproduction Row reproduce",
    "execution": "Execution Run Runs execute",
    "explanation": "Explanation PolicyExplanation explain explain_policy",
    "facade.bystanders": "with_bystanders",
    "facade.certify": "check verify",
    "facade.front": "Front FrontPoint front",
    "facade.interruptibility": "Interruption InterruptionReport Removal interruptions",
    "facade.loading": "load load_agents load_pddl",
    "facade.planning": "plan plan_anytime",
    "facade.proofs": "check_proof",
    "facade.session": "Session",
    "facade.showing": "Drawing show",
    "facade.simulation": "simulate",
    "lint": "Finding TaskReport TaskTime check_task",
    "recognition": "GoalPosterior Recognition recognise",
    "scenarios.examples": "example",
    "scenarios.generate": "generate_usar",
}
"""The modules of the public names that are not of ``serendipity.model``."""

_ALONE = ("lint", "model", "scenarios.examples", "scenarios.generate")
"""The modules that load neither ``search`` nor ``verify``."""


def __getattr__(name: str) -> "Any":
    if name not in __all__:
        raise AttributeError(f"module 'serendipity' has no attribute {name!r}")
    home = next((home for home, names in _HOMES.items() if name in names.split()), "model")
    if home not in _ALONE:
        from serendipity._siblings import require_siblings

        require_siblings("search", "verify")
    from importlib import import_module

    value = getattr(import_module(f"serendipity.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
