"""What each method of the verifier is good for: certificates without it, as a table in markdown.

    python -m benchmarks.ablation_verify ANSWERS [--without NAME,NAME+NAME,...] [--time-limit SECONDS]
        [--stride N] [--families 3] [--only WORD]

ANSWERS is the folder of ``python -m benchmarks.proofs``: all answers in it that the search has settled are
verified, and answers to tasks of the generator's families, which are made where they are absent.  Each is
verified with all methods and without each of those that are named; names that a plus joins go together.  What
came of it stands in ANSWERS, too, so that a run that was ended goes on where it was.  Limits are of processor
time, so that other work on the machine decides nothing.
"""

import argparse
import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import serendipity
from benchmarks.certificates import processor
from benchmarks.proofs import Asked
from serendipity import Result, Task
from serendipity.evaluation.benchmark.coverage import MODES
from serendipity.model.resources import deadline
from serendipity.testing.generator.families import family_task
from verify.calls.methods import NAMES
from verify.certificate.certify import certify
from verify.limits import limited

_FAMILIES: Final = (
    ("blocks", 7, 2),
    ("blocks", 6, 3),
    ("logistics", 7, 2),
    ("logistics", 6, 3),
    ("switches", 18, 2),
    ("switches", 14, 3),
)
"""Name, size and agents."""

_MODES: Final = ("serendipity", "serendipity-k0", "communication", "composite-inf")
_ALL: Final = "all methods"


class _Methods(tuple[str, ...]):
    """Methods that are left out, and which of all the verifier has asked about."""

    def __init__(self, names: tuple[str, ...]) -> None:
        del names
        self.asked: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.asked.add(str(name).removeprefix("-"))
        return super().__contains__(name)


def main() -> None:
    """Verify what has not been verified yet, and print the table."""
    arguments = _arguments()
    book = arguments.answers / f"ablation-{arguments.time_limit:g}.jsonl"
    known = _read(book)
    variants = [_ALL, *arguments.without.split(",")]
    shown = []
    for name, group, source, result in _answers(arguments):
        task: Task | None = None
        for variant in variants:
            whole = known.get((name, _ALL))
            if whole is not None and variant != _ALL and not _matters(variant, whole):
                known[name, variant] = whole
            elif (name, variant) not in known:
                task = task or _task(arguments.answers, source)
                known[name, variant] = row = _verified(task, result, variant, arguments.time_limit)
                with book.open("a") as file:
                    file.write(json.dumps([name, variant, row]) + "\n")
            shown.append((group, variant, known[name, variant]))
        print(f"{name}: {', '.join(known[name, v]['verdict'] for v in variants)}", flush=True)
    print("\n".join(_table(shown, variants)))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("answers", type=Path)
    parser.add_argument("--without", default=",".join(NAMES), help="each of these in turn")
    parser.add_argument("--time-limit", type=float, default=10.0, help="seconds for a certificate")
    parser.add_argument("--stride", type=int, default=1, help="every N-th answer of the folder")
    parser.add_argument("--families", type=int, default=3, help="tasks of each of the generator's families")
    parser.add_argument("--only", default="", help="answers with this word in their name")
    return parser.parse_args()


def _answers(arguments: argparse.Namespace) -> Iterator[tuple[str, str, list[Any], Result]]:
    """Name, group, source of the task and result."""
    for family in _FAMILIES:
        for seed in range(1, arguments.families + 1):
            for mode in _MODES:
                _plan(arguments.answers, [*family, seed], mode)
    files = sorted(each for each in arguments.answers.glob("*.json") if ".verdict." not in each.name)
    for path in files[:: arguments.stride]:
        answer = json.loads(path.read_text())
        settled = answer["result"]["status"] in ("optimal", "infeasible")
        if settled and "individual" not in path.name and arguments.only in path.name:
            yield path.stem, path.stem.split("-")[0], answer["source"], Result.from_dict(answer["result"])


def _plan(folder: Path, source: list[Any], mode: str) -> None:
    family, size, agents, seed = source
    path = folder / f"{family}{agents}-{size}-{seed}-{mode}.json"
    if not path.exists():
        task = family_task(family, seed, size, agents)
        try:
            found = serendipity.plan(task, discount="0.9", time_limit=10, **MODES[mode]).to_dict()
        except serendipity.SerendipityError as error:
            found = {"status": f"refused: {error}"}
        path.write_text(json.dumps({"result": found, "source": source}))


def _task(folder: Path, source: list[Any]) -> Task:
    if isinstance(source[0], str) and len(source) == 4 and isinstance(source[1], int):
        family, size, agents, seed = source
        return family_task(family, seed, size, agents)
    name = "x".join(map(str, source[: 2 + (source[2] > 1)])) if isinstance(source[0], int) else ""
    return Asked(name, f"seed{source[-1]}", "", tuple(source)).load(folder)


def _verified(task: Task, result: Result, variant: str, seconds: float) -> dict[str, Any]:
    left_out = _Methods(() if variant == _ALL else tuple(f"-{name}" for name in variant.split("+")))
    deadline.time = SimpleNamespace(perf_counter=processor)  # type: ignore[assignment]
    started = processor()
    with limited(methods=left_out):
        certificate = certify(task, result, time_limit=seconds)
    row = {"verdict": certificate.verdict, "seconds": round(processor() - started, 3)}
    slowest = max(certificate.claims, key=lambda claim: claim.seconds)
    return {**row, "reason": slowest.reason, "asked": sorted(left_out.asked)}


def _matters(variant: str, whole: dict[str, Any]) -> bool:
    """Whether an answer is proved, with all methods, and the verifier asks about one that is left out."""
    return whole["verdict"] == "proved" and bool(set(variant.split("+")) & set(whole["asked"]))


def _read(book: Path) -> dict[tuple[str, str], dict[str, Any]]:
    lines = book.read_text().splitlines() if book.exists() else []
    return {(name, variant): row for name, variant, row in map(json.loads, lines)}


def _table(rows: list[tuple[str, str, dict[str, Any]]], variants: list[str]) -> Iterator[str]:
    """Proved certificates and seconds by group; below it, for each variant, what is lost."""
    groups = list(dict.fromkeys(group for group, _, _ in rows))
    yield "| without | " + " | ".join(groups) + " | all | s |"
    yield "|---" * (len(groups) + 3) + "|"
    proved = Counter((group, variant) for group, variant, row in rows if row["verdict"] == "proved")
    for variant in variants:
        seconds = sum(row["seconds"] for _, v, row in rows if v == variant)
        cells = [_cell(proved[group, variant], proved[group, _ALL]) for group in groups]
        total = sum(proved[group, variant] for group in groups)
        yield f"| {variant} | {' | '.join(cells)} | {total} | {seconds:.0f} |"


def _cell(proved: int, of: int) -> str:
    return str(proved) if proved == of else f"**{proved - of:+d}**"


if __name__ == "__main__":
    main()
