"""The model: facts, ground actions, agents, task, plans, options and results.

Everything else in the project imports this package; it imports nothing of
``search``, ``verify`` or the facade.  Definitions follow "Planning for
Serendipity" (Chakraborti et al., IROS 2015), as made precise in
``docs/semantics.md``.
"""

from serendipity.model.answers.answer import Status
from serendipity.model.answers.certificate import Certificate, Claim, Verdict
from serendipity.model.answers.policy import Decision, Floor, Policy, StateDelta
from serendipity.model.answers.proof_check import ProofCheck, RefutedProgram
from serendipity.model.answers.result import Result
from serendipity.model.answers.result_parts import GapEntry, GoalAnswer, TiedAnswer
from serendipity.model.answers.trace import Trace, TraceEpoch, TraceSkip
from serendipity.model.errors import InputError, LimitReachedError, PlanError, SerendipityError, UsageError
from serendipity.model.keywords import HumanModel, Mode, PlanOptions
from serendipity.model.numbers import exact
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.table import Table
from serendipity.model.task.actions import Condition, GroundAction, Timing
from serendipity.model.task.plans import PlanStep, PlanTimes, Step, TimedPlan, Window
from serendipity.model.task.script import Deed, Script, TimedFact, Timeline
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.visibility import Surroundings, Visible, surroundings

__all__ = [
    "INFINITE",
    "Certificate",
    "Claim",
    "Condition",
    "Deadline",
    "Decision",
    "Deed",
    "Floor",
    "GapEntry",
    "GoalAnswer",
    "GroundAction",
    "HumanModel",
    "HumanPlan",
    "InputError",
    "LimitReachedError",
    "Mode",
    "Options",
    "PlanError",
    "PlanOptions",
    "PlanStep",
    "PlanTimes",
    "Policy",
    "ProofCheck",
    "RefutedProgram",
    "Result",
    "Script",
    "SerendipityError",
    "StateDelta",
    "Status",
    "Step",
    "Surroundings",
    "Table",
    "Task",
    "TiedAnswer",
    "TimedFact",
    "TimedPlan",
    "Timeline",
    "Timing",
    "Trace",
    "TraceEpoch",
    "TraceSkip",
    "UsageError",
    "Verdict",
    "Visible",
    "Window",
    "exact",
    "surroundings",
]
