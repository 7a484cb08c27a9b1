"""Proofs in the field's form, and ways to doctor their files: each leaves a proof that shows nothing."""

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from serendipity.writing.veripb import in_the_fields_form
from tests.verify.proofs.samples import Proof, sample

Change = Callable[[str], str]


class Files(NamedTuple):
    """One program's files: the problem, and its proof in two versions."""

    opb: str
    proof: str
    old_proof: str


def files_of(proof: Proof) -> list[Files]:
    texts = [content.decode() for content in in_the_fields_form(Path("help.pbp"), proof).values()]
    return [Files(*texts[k : k + 3]) for k in range(0, len(texts), 3)]


@cache
def first(name: str) -> Files:
    """The files of a sample's first program."""
    return files_of(sample(name).proof)[0]


class Doctored(NamedTuple):
    """What is done to one of a sample's files."""

    sample: str
    formula: Change | None
    proof: Change | None

    def files(self) -> Files:
        """The files, one of them changed, which a test holds to be another one than before."""
        before = first(self.sample)
        opb = before.opb if self.formula is None else self.formula(before.opb)
        proofs = (each if self.proof is None else self.proof(each) for each in before[1:])
        return Files(opb, *proofs)


def _swap(pattern: str, by: str, nth: int = 0) -> Change:
    """The nth place where a pattern fits, from 0 or from the end, is replaced."""

    def change(text: str) -> str:
        found = list(re.finditer(pattern, text, re.MULTILINE))[nth]
        return text[: found.start()] + found.expand(by) + text[found.end() :]

    return change


def _lines(edit: Callable[[list[str]], list[str]]) -> Change:
    return lambda text: "\n".join((*edit(text.splitlines()), ""))


def _drop(pattern: str, nth: int = 0) -> Change:
    return _swap(rf"{pattern}\n", "", nth)


def _drop_all(pattern: str) -> Change:
    return _lines(lambda lines: [line for line in lines if not re.match(pattern, line)])


def _assumed(lines: list[str]) -> list[str]:
    """A contradiction assumed, and concluded from."""
    ends = (line for line in lines if line.startswith(("c ", "output", "conclusion", "end")))
    return [*lines[:2], "a >= 1 ;", *(re.sub(r"\d+$", "32", line) for line in ends)]


def _in(number: int) -> Change:
    """Adds to the first number at the end of a line that a cover ends with."""
    return _swap(r">= 1 ;$", f">= {number} ;")


def _formula(name: str, change: Change) -> Doctored:
    return Doctored(name, change, None)


def _proof(name: str, change: Change) -> Doctored:
    return Doctored(name, None, change)


_BOUND = r"^(-\d+ x.*>= )(-?\d+) ;"

DOCTORED: Final[dict[str, Doctored]] = {
    # the problem
    "the bound relaxed by one": _formula(
        "branched", lambda t: re.sub(_BOUND, lambda m: f"{m[1]}{int(m[2]) - 1} ;", t, flags=re.MULTILINE)
    ),
    "the bound left out": _formula("branched", _drop(r"^-\d+ x.*")),
    "a constraint left out": _formula("branched", _drop(r"^\+1 x.*")),
    "the last constraint left out": _formula("branched", _drop(r"^\+1 x.*", -1)),
    "a constraint loosened": _formula("branched", _in(0)),
    "every constraint loosened": _formula("branched", lambda t: t.replace(">= 1 ;", ">= 0 ;")),
    "a variable renamed": _formula("branched", _swap(r"\+1 x5 ", "+1 x6 ")),
    "a variable made free": _formula("branched", lambda t: t.replace("+1 x5 ", "+1 x99 ")),
    "two constraints swapped": _formula(
        "help", _lines(lambda lines: [*lines[:4], lines[-1], *lines[5:-1], lines[4]])
    ),
    "the costs halved": _formula(
        "branched", lambda t: re.sub(r"-(\d+) x", lambda m: f"-{int(m[1]) // 2} x", t)
    ),
    "a cost of zero": _formula("branched", _swap(r"^-\d+ x1 ", "-0 x1 ")),
    "no objective": _formula("help", _drop(r"^min: .*")),
    "an equality made an inequality": _formula("help", _swap(r" = 1 ;", " >= 1 ;")),
    "a right side changed": _formula("no help", _swap(r" = 1 ;", " = 0 ;")),
    "nothing but the objective": _formula("help", _drop_all(r"[^*m]")),
    "contradictions taken back": _formula("no plan", lambda t: re.sub(r"(?m)^(>?=) 1 ;", r"\1 0 ;", t)),
    # steps
    "a multiplier raised": _proof("branched", _swap(r"^(pol \d+ )60 ", r"\g<1>600 ")),
    "a multiplier lowered": _proof("branched", _swap(r"^(pol \d+ )60 ", r"\g<1>30 ")),
    "a multiplier of zero": _proof("branched", _swap(r"^(pol \d+ )60 ", r"\g<1>0 ")),
    "a multiplier below zero": _proof("branched", _swap(r"^(pol \d+ )60 ", r"\g<1>-60 ")),
    "the limit's multiplier raised": _proof("no help", _swap(r"^(pol \d+)( \d+ \d+ \*)", r"\1 9 *\2")),
    "a multiplier of a root changed": _proof("no help", _swap(r"^(pol \d+ \d+ \d+)", r"\g<1>0")),
    "another constraint": _proof("branched", _swap(r"^(pol \d+ \S+ \* )1 ", r"\g<1>2 ")),
    "a constraint of another sense": _proof("help", _swap(r" 424 30 \* \+$", " 423 30 * +")),
    "a constraint that is not there": _proof("branched", _swap(r"^pol \d+", "pol 999")),
    "a constraint of later": _proof("branched", _swap(r"^pol \d+", "pol 40")),
    "a sum cut short": _proof("help", _swap(r"^(pol (?:\S+ ){40}.*?\+).*$", r"\1")),
    "a sum that is not finished": _proof("branched", _swap(r"^(pol .*) \+$", r"\1")),
    "a sum emptied": _proof("branched", _swap(r"^pol .*$", "pol 1")),
    "the sums left out": _proof("branched", _drop_all("pol")),
    "the last sum left out": _proof("branched", _drop(r"^pol .*", -1)),
    # branches
    "a branch left out": _proof("branched", _drop(r"^rup 1 x5 1 x19 >= 1 ;")),
    "one side of the root left out": _proof("branched", _drop_all(r"rup 1 ~x5")),
    "the other side left out": _proof("branched", _drop_all(r"rup 1 x5")),
    "leaves without their branches": _proof("branched", _drop_all(r"rup 1 ")),
    "a branch on another variable": _proof(
        "branched", _swap(r"^rup 1 x5 1 x19 >= 1 ;", "rup 1 x5 1 x20 >= 1 ;")
    ),
    "a branch turned round": _proof("branched", _swap(r"^rup 1 x5 1 x19 >= 1 ;", "rup 1 ~x5 1 x19 >= 1 ;")),
    "a leaf that says more": _proof("branched", _swap(r"^rup 1 x5 1 x19 >= 1 ;", "rup 1 x5 1 x19 >= 2 ;")),
    "the root at once": _proof("branched", _swap(r"^pol", r"rup >= 1 ;\npol")),
    "sums after what they are for": _proof(
        "branched", _lines(lambda lines: [*lines[:2], *sorted(lines[2:-4], reverse=True), *lines[-4:]])
    ),
    # solutions and ends
    "a solution that breaks a row": _proof("help", _swap(r"^(soli|o) x1 ", r"\1 ~x1 ")),
    "a solution of nothing": _proof(
        "help", lambda t: re.sub(r"(?m)^(soli|o) .*$", lambda m: re.sub(r" x", " ~x", m[0]), t)
    ),
    "no solution": _proof("help", _drop(r"^(soli|o) .*")),
    "a solution where there is no objective": _proof("branched", _swap(r"^f 31$", r"f 31\nsoli x1\no x1")),
    "another number of constraints": _proof("help", _swap(r"^f (\d+)", r"f 1\1")),
    "a conclusion from what is none": _proof("branched", _swap(r"(: |c )\d+$", r"\g<1>33", -1)),
    "a conclusion from a constraint": _proof("no help", _swap(r"(: |c )\d+", r"\g<1>1", -1)),
    "a conclusion from what is not there": _proof("help", _swap(r"(: |c )\d+", r"\g<1>99999", -1)),
    "no conclusion": _proof("branched", _drop(r"(c|conclusion) .*")),
    "no conclusion from a solution": _proof("help", _drop(r"(c|conclusion) .*")),
    "a conclusion of nothing": _proof("branched", _swap(r"^(c|conclusion) .*$", "conclusion NONE")),
    "a proof emptied": _proof("branched", _lines(lambda lines: lines[:1])),
    "nothing but the problem": _proof("branched", _lines(lambda lines: lines[:2])),
    "an empty file": _proof("branched", lambda _: ""),
    "an assumption": _proof("branched", _swap(r"^pol .*$", "a >= 1 ;")),
    "an assumption in place of all steps": _proof("branched", _lines(_assumed)),
    "another version": _proof("help", _swap(r"version \S+", "version 9.9")),
}
