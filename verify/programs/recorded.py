"""Programs on their way to a proof file and back: what refutes them, and that they are a question's own."""

from collections.abc import Callable, Iterable
from typing import Any, Final

from serendipity.model import Deadline
from verify.base.execution import State
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import ALONE, EXACT, FREE, WINDOW, PricedPlan, Subproblem
from verify.base.undecided import UndecidedError, during
from verify.programs.effort import Minimum, ProgramEncoding
from verify.programs.mending import mended, replay, suffix_least
from verify.proofs import checker
from verify.proofs.book import Entry, ProofReader, ProofWriter, require_same
from verify.proofs.tree import refutation
from verify.solvers.mip import Model

Cut = tuple[int, State]
"""The first epoch of a suffix, and the facts that hold at its begin."""

BESIDE_ANY: Final = "beside any of"
"""In the name of a program in which the human may be on any of their optimal plans."""

_OTHER_LIMIT: Final = "program {!r}: the limit is {}, the claim's is {}"

_WORDS: Final = {
    FREE: "all plans",
    WINDOW: "every window",
    EXACT: "pi_H as planned",
    ALONE: "the human alone",
}


def write(
    writer: ProofWriter,
    question: Subproblem,
    model: Model,
    minimum: Minimum,
    *,
    cuts: Iterable[Cut] = (),
    values: Iterable[int] = (),
) -> None:
    """Refute what is better than the answer to a question, and write it down.

    Args:
        minimum: the answer: proved best, or proved that there is none within the limit.
        cuts: what the program has learned about suffixes, in order.
        values: of the columns, in the program's best solution; empty where it has none.
    """
    limit = question.most if minimum.found is None else minimum.found.objective - 1
    entry = _described(question, model)
    if cuts:
        name = question.task.facts
        entry["suffixes"] = [{"epoch": xi2, "state": [name[f] for f in sorted(s)]} for xi2, s in cuts]
    refute(writer, entry, model, limit, values, question.deadline)


def refute(
    writer: ProofWriter,
    entry: Entry,
    model: Model,
    limit: int | None,
    values: Iterable[int],
    deadline: Deadline,
) -> None:
    """Write down why a program allows nothing at or below a limit of the objective; None: nothing at all."""
    entry["limit"] = limit
    solution = {x: value for x, value in enumerate(values) if value}
    if solution and sum(solution.get(x, 0) * c for x, c in model.objective.items()) - 1 == limit:
        entry["solution"] = [[x, value] for x, value in solution.items()]
    with during("writing a proof down"):
        entry["tree"] = refutation(model, limit, deadline)
    try:
        checker.refute(checker.program(entry, "program"))
    except (checker.MalformedProofError, checker.RejectedProofError) as error:
        raise UndecidedError(f"no proof: {error}") from None
    writer.programs.append(entry)


def refuted(
    proof: ProofWriter | ProofReader, made: Entry, model: Model, limit: int | None, deadline: Deadline
) -> None:
    """Refute a program and write it down, or take it from a proof that was accepted; or an UndecidedError.

    Args:
        made: what of its entry follows from the program.
    """
    if not isinstance(proof, ProofReader):
        refute(proof, made, model, limit, (), deadline)
        return
    entry = proof.take()
    require_same(entry, made)
    if entry["limit"] != limit:
        raise UndecidedError(_OTHER_LIMIT.format(entry["name"], entry["limit"], limit))


def refuted_without_epochs(proof: ProofWriter | ProofReader, question: Subproblem, minimum: Minimum) -> None:
    """The same where there is no epoch, so that the answer is known: the empty plan, or none."""
    limit, model = question.most if minimum.found is None else -1, Model(question.deadline)
    model.family = "eq. 3"
    model.add({}, "<=", 0 if question.goal.holds(question.task.init) else -1)
    model.family = "eq. 12"
    model.add({}, "<=", 0 if question.rule != WINDOW else -1)
    if question.most_cost is not None:
        model.family = "eq. 11"
        model.add({}, "<=", min(question.most_cost, 0))
    refuted(proof, _described(question, model), model, limit, question.deadline)


def read(
    reader: ProofReader,
    question: Subproblem,
    encode: Callable[[Subproblem], ProgramEncoding],
    plans: OptimalPlans,
) -> Minimum:
    """The answer to a question that a proof gives; no solver is asked.

    Raises:
        UndecidedError: the next program is another one, or does not answer the question.
    """
    entry = reader.take()
    encoding = encode(question.but(most=None))
    for xi2, named in _cuts(entry, question):
        state = encoding.told(named)  # a file may name what is never true
        encoding.bound_suffix(xi2, state, suffix_least(question, state, xi2, plans))
    assert encoding.model is not None
    require_same(entry, _described(question, encoding.model))
    name, limit = entry["name"], entry["limit"]
    if "solution" in entry and limit != question.most:
        found = _found(entry, question, encoding, plans)
        if limit != found.objective - 1 or (question.most is not None and found.objective > question.most):
            raise UndecidedError(f"program {name!r}: the limit is not one below the claim's optimum")
        return Minimum("found", found, found.objective)
    if limit != question.most:
        raise UndecidedError(_OTHER_LIMIT.format(name, limit, question.most))
    return Minimum("none")


def _found(entry: Entry, question: Subproblem, encoding: ProgramEncoding, plans: OptimalPlans) -> PricedPlan:
    """The plan that an entry's solution stands for."""
    assert encoding.model is not None
    values = [0] * len(encoding.model.upper)
    for x, value in entry["solution"]:
        values[x] = value
    steps, window = encoding.plan(tuple(values))
    states = replay(question, steps)
    found = None if states is None else mended(question, steps, window, states, plans)
    if found is None:
        raise UndecidedError(f"program {entry['name']!r}: its solution is no plan")
    return found


def _described(question: Subproblem, model: Model) -> Entry:
    words = f"{_WORDS[question.rule]}, {question.horizon} epochs"
    if question.any_of is not None:
        words += f", {BESIDE_ANY} {question.any_of.count} plans"
    if not question.robots:
        words += ", robots idle"
    if question.most_cost is not None:
        words += f", cost at most {question.most_cost}"
    return described(words, question.prices.scale, model, question.deadline)


def described(name: str, scale: int, model: Model, deadline: Deadline) -> Entry:
    """What of an entry follows from the program.

    Args:
        name: which plans it allows.
        scale: units of its objective per unit of the domain's cost; 0: only their order is the same.
    """
    rows = zip(model.rows, model.families, strict=True)
    return {
        "name": name,
        "unit": f"1/{scale}" if scale else "none: smaller numbers whose sums have the order of costs",
        "columns": [list(bounds) for bounds in zip(model.lower, model.upper, strict=True)],
        "objective": [[x, weight] for x, weight in sorted(model.objective.items())],
        "rows": [
            {
                "family": family,
                "terms": [[x, coefficient] for x, coefficient in row.terms.items()],
                "sense": row.sense,
                "right": row.right,
            }
            for row, family in deadline.each(list(rows))
        ],
    }


def _cuts(entry: Entry, question: Subproblem) -> list[Cut]:
    """The suffixes that an entry names."""
    numbers = {name: f for f, name in enumerate(question.task.facts)}
    found: list[Cut] = []
    listed: Any = entry.get("suffixes", [])
    try:
        for suffix in listed:
            xi2 = suffix["epoch"]
            if type(xi2) is not int or not 1 < xi2 <= question.horizon:
                raise ValueError
            found.append((xi2, frozenset(numbers[name] for name in suffix["state"])))
    except (KeyError, TypeError, ValueError):
        raise UndecidedError(f"program {entry['name']!r}: suffixes: expected epochs and facts") from None
    return found
