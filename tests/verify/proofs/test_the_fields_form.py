"""Proofs in the field's form are accepted, by a small checker and by VeriPB, and doctored ones are not."""

import os
import shutil
import sys
from pathlib import Path
from random import Random

import pytest
from hypothesis import given, settings

import serendipity
from benchmarks.certificates import by_veripb, is_accepted_by_veripb
from serendipity.model import UsageError
from serendipity.writing.veripb import write
from serendipity_testing.cases import case_1, case_4
from serendipity_testing.pseudo_boolean.checker import ProofError, check
from serendipity_testing.pseudo_boolean.opb import read
from serendipity_testing.strategies import Call, calls
from tests.cli.conftest import Runs
from tests.verify.proofs.in_the_fields_form import DOCTORED, Files, files_of, first
from tests.verify.proofs.samples import SAMPLES, Proof, entry, sample
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.certificate.provable import main_claim
from verify.proofs.book import ProofWriter
from verify.proofs.checker import SCHEMA
from verify.solvers.mip import Model

VERIPB = os.environ.get("VERIPB") or shutil.which("veripb")
needs_veripb = pytest.mark.skipif(VERIPB is None, reason="VeriPB is neither on the path nor named by VERIPB")


def _optimum(files: Files) -> int | None:
    """What both versions of a proof show."""
    problem = read(files.opb)
    shown = {check(problem, proof) for proof in files[1:]}
    assert len(shown) == 1
    return shown.pop()


def _told_by_veripb(files: Files, folder: Path) -> bool:
    """Whether VeriPB accepts the proof of version 1.1, or else that of version 2.0."""
    assert VERIPB is not None
    formula, proofs = folder / "help.opb", [folder / "help.v1.pbp", folder / "help.pbp"]
    for path, text in zip((formula, *proofs), (files.opb, files.old_proof, files.proof), strict=True):
        path.write_text(text)
    return is_accepted_by_veripb(VERIPB, formula)


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_show_what_their_programs_claim(name: str) -> None:
    proof = sample(name).proof
    for program, files in zip(proof["programs"], files_of(proof), strict=True):
        assert _optimum(files) == (program["limit"] + 1 if "solution" in program else None)


def _allows(program: Proof, values: list[int]) -> bool:
    """Whether whole values satisfy a program's columns and rows."""
    sides = {"<=": int.__le__, ">=": int.__ge__, "==": int.__eq__}
    bounded = all(low <= x <= high for x, (low, high) in zip(values, program["columns"], strict=True))
    return bounded and all(
        sides[row["sense"]](sum(a * values[x] for x, a in row["terms"]), row["right"])
        for row in program["rows"]
    )


@pytest.mark.long
@pytest.mark.parametrize("name", SAMPLES)
def test_opb_states_the_programs_rows(name: str) -> None:
    """Of its solution, of values near it, and of any."""
    dice, proof = Random(0), sample(name).proof
    for program, files in zip(proof["programs"], files_of(proof), strict=True):
        problem = read(files.opb)
        solved = [0] * len(program["columns"])
        for x, value in program.get("solution", ()):
            solved[x] = value
        tries = [solved, [1] * len(solved), *([dice.randint(0, 1) for _ in solved] for _ in range(20))]
        tries += [[*solved[:x], 1 - solved[x], *solved[x + 1 :]] for x in range(len(solved))]
        for values in tries:
            named = {f"x{x}": value for x, value in enumerate(values, 1)}
            cost = sum(a * values[x] for x, a in program["objective"])
            bounded = problem.objective is not None or program["limit"] is None or cost <= program["limit"]
            states = all(each.holds(named) for each in problem.constraints)
            assert states == (_allows(program, values) and bounded)
            assert problem.objective is None or problem.cost(named) == cost


@pytest.mark.parametrize("name", DOCTORED)
def test_doctored_proofs_are_rejected(name: str) -> None:
    files = DOCTORED[name].files()
    assert files != first(DOCTORED[name].sample)
    for proof in files[1:]:
        with pytest.raises(ProofError):
            check(read(files.opb), proof)


@needs_veripb
@pytest.mark.parametrize("name", SAMPLES)
def test_veripb_accepts_samples(name: str, tmp_path: Path) -> None:
    assert all(_told_by_veripb(files, tmp_path) for files in files_of(sample(name).proof))


@needs_veripb
@pytest.mark.parametrize("name", DOCTORED)
def test_veripb_rejects_doctored_proofs(name: str, tmp_path: Path) -> None:
    assert not _told_by_veripb(DOCTORED[name].files(), tmp_path)


@pytest.mark.parametrize(
    ("said", "accepted"),
    [
        ("print('Verification succeeded.')", True),
        ("sys.exit(5)", False),
        ("print('Proof is based on unjustified assumptions.', file=sys.stderr)", False),
        ("print('The provided proof did not claim contradiction.', file=sys.stderr)", False),
        ("print('s VERIFIED NO CONCLUSION')", False),
        ("sys.exit('Unsupported version.' if '.v1.' in sys.argv[-1] else 0)", True),
        ("sys.exit('Unsupported version.')", False),
    ],
)
def test_veripb_is_believed_only_without_a_doubt(said: str, accepted: bool, tmp_path: Path) -> None:
    command = tmp_path / "veripb"
    command.write_text(f"#!{sys.executable}\nimport sys\n{said}\n")
    command.chmod(0o755)
    for end in (".opb", ".pbp", ".v1.pbp"):
        (tmp_path / f"proof{end}").touch()
    assert by_veripb(str(command), sorted(tmp_path.glob("proof*")))["by VeriPB"] == accepted


@pytest.mark.long
@settings(max_examples=15)
@given(calls(ties=False))
def test_every_proof_of_a_call_can_be_written(call: Call) -> None:
    try:
        result = solve(call.task, call.options, human_plan=call.human_plan_names)
        for encoding in ("automata", "paper"):
            writer = ProofWriter()
            certificate = certify(call.task, result, proof=writer, encoding=encoding)
            if certificate.verdict == "proved" and writer.programs:
                proof = writer.to_dict(main_claim(result) or "", encoding)
                for program, files in zip(writer.programs, files_of(proof), strict=True):
                    solved = "solution" in program and program["objective"]
                    assert _optimum(files) == (program["limit"] + 1 if solved else None)
    except UsageError:
        return


def test_a_program_with_other_values_is_refused_in_one_line() -> None:
    model = Model()
    column = model.column(0, 3)
    model.objective[column] = 1
    model.add({column: 2}, ">=", 3)
    proof = {"schema": SCHEMA, "claim": "optimal", "programs": [entry(model, 1)]}
    with pytest.raises(UsageError, match="OPB knows 0 and 1, column 0 is in 0 to 3"):
        files_of(proof)


def test_a_certificate_writes_three_files_for_each_program(tmp_path: Path) -> None:
    task = case_4()
    result = serendipity.plan(task, discount="0.9", mode="communication", communication_weight="0.5")
    assert serendipity.verify(task, result, proof=tmp_path / "help.pbp").verdict == "proved"
    names = ("help", "help-2")
    assert {file.name for file in tmp_path.iterdir()} == {
        f"{name}{suffix}" for name in names for suffix in (".opb", ".pbp", ".v1.pbp")
    }
    for name in names:
        problem = read((tmp_path / f"{name}.opb").read_text())
        for suffix in (".pbp", ".v1.pbp"):
            check(problem, (tmp_path / f"{name}{suffix}").read_text())


def test_an_earlier_claim_leaves_nothing_behind(tmp_path: Path) -> None:
    two, one = sample("two programs").proof, sample("branched").proof
    write(tmp_path / "a[1].pbp", two)
    write(tmp_path / "a[1]-3.pbp", one)
    (tmp_path / "a[1]-4.opb").mkdir()
    own = {"a[1]-5.opb": b"* #variable= 1 #constraint= 0\n", "a[1]-5.pbp": b"", "a[1]-six.opb": b"\xff"}
    own["a[1]-07.opb"] = (tmp_path / "a[1]-2.opb").read_bytes()
    for name, content in own.items():
        (tmp_path / name).write_bytes(content)
    before = {file.name for file in tmp_path.iterdir()}
    write(tmp_path / "a[1].pbp", one)
    left = before - {file.name for file in tmp_path.iterdir()}
    assert left == {"a[1]-2.opb", "a[1]-2.pbp", "a[1]-2.v1.pbp"}


def test_nothing_is_written_where_nothing_is_proved(tmp_path: Path) -> None:
    answer = serendipity.plan(case_1())
    verdict = serendipity.verify(case_1(), answer, proof=tmp_path / "late.pbp", time_limit=0).verdict
    assert (verdict, list(tmp_path.iterdir())) == ("undecided", [])


def test_the_command_writes_them(run: Runs) -> None:
    assert run("plan --example room2 --discount 0.6 --quiet -o help.json").code == 0
    assert run("verify --example room2 help.json --proof room2.pbp --quiet").code == 0
    formula = Path("room2.opb").read_text()
    head = "* optimal, program 1 of 1: every window, 13 epochs\n* what an objective of 1 costs: 1/5\n"
    assert head in formula
    assert check(read(formula), Path("room2.pbp").read_text()) == 5063
