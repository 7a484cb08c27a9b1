"""Small PDDL texts put together from parts, and a reader of them."""

from pathlib import Path

from serendipity import Task, load_agents, load_pddl

DATA = Path(__file__).parent / "data"
YARD = DATA / "yard"
OFFICE = (DATA / "office" / "domain.pddl", DATA / "office" / "problem.pddl")

PREDICATES = "(p) (q) (r) (a ?x) (b ?x - thing) (has ?who ?what)"


def domain(
    *actions: str,
    predicates: str = PREDICATES,
    functions: str = "",
    types: str = "thing agent",
    constants: str = "",
) -> str:
    return "\n".join(
        [
            "(define (domain small)",
            f"(:types {types})",
            f"{f'(:constants {constants})' if constants else ''}(:predicates {predicates})",
            f"(:functions (total-cost) {functions})",
            *actions,
            ")",
        ]
    )


def problem(
    init: str = "", goal: str = "(p)", objects: str = "h r - agent o1 o2 - thing", more: str = ""
) -> str:
    return "\n".join(
        [
            "(define (problem little)",
            "(:domain small)",
            f"(:objects {objects})",
            f"(:init {init})",
            f"(:goal {goal})" if goal else "",
            more,
            ")",
        ]
    )


def action(name: str, precondition: str, effect: str, parameters: str = "?who - agent") -> str:
    """The text of an action of whoever is bound to ``?who``."""
    return f"(:action {name} :parameters ({parameters}) :precondition {precondition} :effect (and {effect}))"


def pair(
    folder: Path, domain_text: str | bytes, problem_text: str | bytes, name: str = ""
) -> tuple[Path, Path]:
    """Two files with these texts."""
    files = folder / f"{name}domain.pddl", folder / f"{name}problem.pddl"
    for file, text in zip(files, (domain_text, problem_text), strict=True):
        file.write_bytes(text.encode() if isinstance(text, str) else text)
    return files


def one(folder: Path, domain_text: str, problem_text: str) -> Task:
    """The single task of these texts, with human ``h`` and robot ``r``."""
    return load_pddl(*pair(folder, domain_text, problem_text), human="h", robots=["r"])


def two(folder: Path, h: tuple[str, str], r: tuple[str, str], human: str | None = None) -> Task:
    return load_agents({"h": pair(folder, *h, "h-"), "r": pair(folder, *r, "r-")}, human=human)


def names(task: Task, start: str = "") -> list[str]:
    return [a.name for a in task.actions if a.name.startswith(start)]


def facts(task: Task, ids: tuple[int, ...] | frozenset[int]) -> set[str]:
    return {task.facts[i] for i in ids}
