"""Serendipity: plan help for a person who did not ask, and prove that none is better.

Everything public is importable from here and loads when it is first used::

    import serendipity

    task = serendipity.example("room2")
    result = serendipity.plan(task, discount=0.6)
    certificate = serendipity.verify(task, result)
"""

TYPE_CHECKING = False  # of `typing`, which the command line need not load before it listens to Ctrl-C

if TYPE_CHECKING:
    from typing import Any

    from serendipity.evaluation.reproduction import reproduce
    from serendipity.execution import Execution, execute
    from serendipity.explanation import Explanation, explain
    from serendipity.facade.certify import check, verify
    from serendipity.facade.interruptibility import interruptions
    from serendipity.facade.loading import load, load_agents, load_pddl
    from serendipity.facade.planning import plan, plan_anytime
    from serendipity.facade.proofs import check_proof
    from serendipity.facade.session import Session
    from serendipity.facade.simulation import simulate
    from serendipity.lint import Finding, TaskReport, check_task
    from serendipity.model import (
        Certificate,
        Deadline,
        InputError,
        LimitReachedError,
        Options,
        PlanError,
        PlanStep,
        ProofCheck,
        Result,
        SerendipityError,
        Task,
        Trace,
        UsageError,
        Window,
    )
    from serendipity.recognition import Recognition, recognise
    from serendipity.scenarios.examples import example
    from serendipity.scenarios.generate import generate_usar

__version__ = "0.1.0"

__all__ = [
    "Certificate",
    "Deadline",
    "Execution",
    "Explanation",
    "Finding",
    "InputError",
    "LimitReachedError",
    "Options",
    "PlanError",
    "PlanStep",
    "ProofCheck",
    "Recognition",
    "Result",
    "SerendipityError",
    "Session",
    "Task",
    "TaskReport",
    "Trace",
    "UsageError",
    "Window",
    "__version__",
    "check",
    "check_proof",
    "check_task",
    "example",
    "execute",
    "explain",
    "generate_usar",
    "interruptions",
    "load",
    "load_agents",
    "load_pddl",
    "plan",
    "plan_anytime",
    "recognise",
    "reproduce",
    "simulate",
    "verify",
]

_HOMES = {
    "load": "serendipity.facade.loading",
    "load_agents": "serendipity.facade.loading",
    "load_pddl": "serendipity.facade.loading",
    "example": "serendipity.scenarios.examples",
    "generate_usar": "serendipity.scenarios.generate",
    "plan": "serendipity.facade.planning",
    "plan_anytime": "serendipity.facade.planning",
    "Session": "serendipity.facade.session",
    "simulate": "serendipity.facade.simulation",
    "check": "serendipity.facade.certify",
    "check_proof": "serendipity.facade.proofs",
    "check_task": "serendipity.lint",
    "Finding": "serendipity.lint",
    "TaskReport": "serendipity.lint",
    "verify": "serendipity.facade.certify",
    "reproduce": "serendipity.evaluation.reproduction",
    "interruptions": "serendipity.facade.interruptibility",
    "explain": "serendipity.explanation",
    "Explanation": "serendipity.explanation",
    "Execution": "serendipity.execution",
    "execute": "serendipity.execution",
    "recognise": "serendipity.recognition",
    "Recognition": "serendipity.recognition",
}
"""Where the public functions live; the public classes live in ``serendipity.model``."""

_NEED_SIBLINGS = (
    "serendipity.facade.planning",
    "serendipity.facade.certify",
    "serendipity.facade.proofs",
    "serendipity.facade.interruptibility",
    "serendipity.facade.loading",
    "serendipity.execution",
    "serendipity.explanation",
    "serendipity.recognition",
    "serendipity.evaluation.reproduction",
    "serendipity.facade.session",
    "serendipity.facade.simulation",
)


def __getattr__(name: str) -> "Any":
    if name not in __all__:
        raise AttributeError(f"module 'serendipity' has no attribute {name!r}")
    home = _HOMES.get(name, "serendipity.model")
    if home in _NEED_SIBLINGS:
        from serendipity._siblings import require_siblings

        require_siblings("search", "verify")
    from importlib import import_module

    value = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
