"""Four domains of the planning competition of 2002 in time, with the agents that CoDMAP 2015 gave them.

    python -m benchmarks.ipc2002time [FOLDER] [--calls one,alone,serendipity] [OPTIONS]

The folder has one for each domain (driverlog, rovers, satellite, zenotravel: *SimpleTime*), with
``domain.pddl`` and problems for a single agent.  Of these a suite in MA-PDDL is written, unfactored, in which
drivers, rovers, satellites and aircraft are the agents: whoever an action is about does it, and loading and
unloading a truck takes its driver, as in CoDMAP.

``one``: somebody who does all, one thing after another (mode ``individual`` on the files as they are).
``alone``: the first agent that might reach the goal alone, in the delete relaxation, or else the first, in
mode ``individual``.  ``serendipity``: the same human, and the next other agent as a robot (discount 0.9).
Each call is a process; its limit and its seconds are by the clock, once the files are read.  ``first`` is
when a plan was known.  All plans are checked by unified-planning on the original files (extra ``up``).
"""

import re
import time
from functools import partial
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, Final, NamedTuple

import typer

import serendipity
from benchmarks.problems import PROBLEMS, Record, run
from serendipity import Result, SerendipityError, Task
from serendipity.evaluation.measuring.record import apart, measured
from serendipity.evaluation.measuring.suites import Roles, SuiteProblem, may_alone, problems, roles
from serendipity.evaluation.measuring.tables import Cell, Row, as_markdown, counted, grouped, table
from serendipity.facade.planning import plan_anytime
from serendipity.model.errors import PlanError, told
from serendipity.pddl.parsing.tree import SExpression, read_tree
from serendipity.pddl.work import Work

AGENTS: Final = {"driverlog": "driver", "rovers": "rover", "satellite": "satellite", "zenotravel": "aircraft"}
"""The type of the agents of each domain."""

_BY: Final = {"driverlog": ("?driver", "(over all (driving ?driver ?truck))")}
"""Whoever does what is about no agent, and what that takes."""

CALLS: Final[dict[str, dict[str, Any]]] = {
    "one": {"mode": "individual"},
    "alone": {"mode": "individual"},
    "serendipity": {"mode": "serendipity", "discount": "0.9"},
}

SOON: Final = 2.0
"""Seconds in which a first plan is wanted."""


class Asked(NamedTuple):
    """A call about a problem; ``suite`` has the files in MA-PDDL, ``source`` those of the competition."""

    suite: str
    source: str
    domain: str
    name: str
    call: str
    limit: float

    def __repr__(self) -> str:
        return f"{self.domain} {self.name} {self.call} {self.limit:g}"


def main(
    source: Annotated[Path, typer.Argument()] = PROBLEMS / "ipc2002time",
    suite: Path | None = None,
    calls: str = ",".join(CALLS),
    time_limit: float = 20,
    only: str = "",
    record: Record = None,
) -> None:
    """Write the suite, ask, and print a line for each call and a table."""
    with TemporaryDirectory() as folder:
        written = suite or Path(folder)
        write_suite(source, written)
        asked = [
            Asked(str(written), str(source), problem.domain, problem.name, call, time_limit)
            for problem in sorted(problems(written), key=lambda p: (p.domain, len(p.name), p.name))
            for call in calls.split(",")
            if only in f"{problem.domain} {problem.name}"
        ]
        rows: list[Row] = []
        for one, row in measured(asked, partial(apart, answered), record):
            print(repr(one), " ".join(f"{name}={value}" for name, value in row.items()), flush=True)
            rows.append({"domain": one.domain, "call": one.call, **row})
    groups = grouped(rows, lambda row: (row["call"], row["domain"]))
    groups |= grouped(rows, lambda row: (row["call"], "all"))
    print(as_markdown([table(("call", "domain"), groups, COLUMNS)]), end="")


COLUMNS: Final[dict[str, Cell]] = {
    "tasks": len,
    "decided": counted(lambda row: row["status"] in ("optimal", "infeasible")),
    "of these without a plan": counted(lambda row: row["status"] == "infeasible"),
    "plan": counted(lambda row: row["cost"] is not None),
    f"in {SOON:g} s": counted(lambda row: row["first"] is not None and row["first"] <= SOON),
    "valid": counted(lambda row: row["valid"] is True),
    "errors": counted(lambda row: row["status"] == "error"),
}


def answered(asked: Asked) -> Row:
    """One call: how it ended and when its first plan came, and whether unified-planning takes the plan."""
    try:
        task = _task(asked)
        begun, first, last = time.perf_counter(), None, None
        for last in plan_anytime(task, time_limit=asked.limit, **CALLS[asked.call]):
            if first is None and last.cost is not None:
                first = round(time.perf_counter() - begun, 2)
    except SerendipityError as error:
        return {"status": "error", "cost": None, "first": None, "valid": None, "reason": told(error)}
    assert last is not None, "there is always an answer"
    return {
        "status": last.status,
        "cost": last.cost,
        "bound": last.lower_bound,
        "alone": last.human_cost,
        "first": first,
        "seconds": round(time.perf_counter() - begun, 2),
        "valid": None if last.plan is None else is_valid(asked, task, last),
        "reason": last.reason,
    }


def _task(asked: Asked) -> Task:
    """The task of a call: of one who does all, or of an agent that might do it alone and the next other."""
    folder = Path(asked.source if asked.call == "one" else asked.suite) / asked.domain
    problem = SuiteProblem(asked.domain, asked.name, folder / "domain.pddl", folder / f"{asked.name}.pddl")
    if asked.call == "one":
        return serendipity.load_agents({"one": (problem.domain_file, problem.problem_file)})
    objects = problem.unit().problem.objects.items()
    agents = [name for name, kind in objects if kind == (AGENTS[asked.domain],)]
    return problem.task(roles(problem, 1, may_alone) if len(agents) > 1 else Roles(agents[0], ()))


# -- MA-PDDL


def write_suite(source: Path, target: Path) -> None:
    """Write MA-PDDL of the competition's files: a folder for each domain."""
    for file in sorted(path for domain in AGENTS for path in (source / domain).glob("*.pddl")):
        text, domain = file.read_text(), file.parent.name
        (target / domain).mkdir(parents=True, exist_ok=True)
        written = _written(with_agents(_tree(text), domain)) if file.name == "domain.pddl" else text
        (target / domain / file.name).write_text(written)


Tree = list[Any]
"""PDDL as lists of words, and of such lists."""


def with_agents(domain: Tree, name: str) -> Tree:
    """The domain with an agent for each action: a parameter of their type, or whoever it takes."""
    for part in domain[1:]:
        if part[0] == ":requirements":
            part += [":multi-agent", ":unfactored-privacy"]
        elif part[0] == ":durative-action":
            place = part.index(":parameters")
            kinds = _typed(part[place + 1])
            agent = next((variable for variable, kind in kinds.items() if kind == AGENTS[name]), None)
            if agent is None:
                agent, condition = _BY[name]
                part[part.index(":condition") + 1].append(_tree(condition))
            kinds.pop(agent, None)
            part[place + 1] = [word for variable, kind in kinds.items() for word in (variable, "-", kind)]
            part[place:place] = [":agent", agent, "-", AGENTS[name]]
    return domain


def _tree(text: str) -> Tree:
    def plain(node: SExpression) -> Tree:
        return [item if isinstance(item, str) else plain(item) for item in node.items]

    (tree,) = plain(read_tree(text, Work()))
    return tree


def _typed(words: Tree) -> dict[str, Any]:
    """Variables, each with its type."""
    found, names = dict[str, Any](), list[str]()
    for before, word in pairwise(["", *words]):
        if before == "-":
            found |= dict.fromkeys(names, word)
            names.clear()
        elif word != "-":
            names.append(word)
    return found


def _written(item: Any) -> str:
    return item if isinstance(item, str) else f"({' '.join(map(_written, item))})"


# -- what unified-planning says


def is_valid(asked: Asked, task: Task, result: Result) -> bool:
    """Whether a plan is one of the original files, by unified-planning's validator of plans with times."""
    from unified_planning.engines.plan_validator import TimeTriggeredPlanValidator
    from unified_planning.environment import get_environment
    from unified_planning.io import PDDLReader
    from unified_planning.plans import ActionInstance, TimeTriggeredPlan

    from serendipity_up.schedule import start_times

    get_environment().credits_stream = None
    source = Path(asked.source) / asked.domain
    domain = _tree((source / "domain.pddl").read_text())
    texts = _without_either(_written(domain)), (source / f"{asked.name}.pddl").read_text().lower()
    problem = PDDLReader().parse_problem_string(*texts)
    plan = []
    steps = list(result.plan or ())
    try:
        starts = start_times(task, steps, [True] * len(steps))
    except PlanError:
        return False
    for step, start in zip(steps, starts, strict=True):
        name, *words = step.action.split()
        if asked.call != "one":
            words = _original(domain, asked.domain, name, words)
        things = tuple(problem.environment.expression_manager.ObjectExp(problem.object(w)) for w in words)
        takes = task.actions[task.named[step.action][0]].duration * task.epoch
        plan.append((start, ActionInstance(problem.action(name), things), takes))
    return bool(TimeTriggeredPlanValidator().validate(problem, TimeTriggeredPlan(plan)))


def _original(domain: Tree, name: str, action: str, words: list[str]) -> list[str]:
    """The arguments of an action as the original file has them, of those with the agent in front."""
    (schema,) = (part for part in domain if part[:2] == [":durative-action", action])
    kinds = [*_typed(schema[schema.index(":parameters") + 1]).values()]
    agent, *others = words
    if AGENTS[name] in kinds:
        others.insert(kinds.index(AGENTS[name]), agent)
    return others


def _without_either(domain: str) -> str:
    """The domain with a type for each ``(either ...)``, which unified-planning does not read."""
    for kinds in dict.fromkeys(re.findall(r"\(either (.*?)\)", domain)):
        (types,) = re.findall(r"\(:types (.*?) - object\)", domain)
        others = " ".join(word for word in types.split() if word not in kinds.split())
        united = kinds.replace(" ", "_or_")
        domain = domain.replace(f"(either {kinds})", united)
        domain = domain.replace(f":types {types}", f":types {kinds} - {united} {others} {united}")
    return domain


if __name__ == "__main__":
    run(main, __doc__)
