"""Bad input: one clear line with file and line, where there is one."""

import shutil
from pathlib import Path

import pytest

from serendipity import InputError, load, load_pddl
from tests.pddl.texts import OFFICE, YARD, action, domain, one, pair, problem
from tests.tables import table

DOMAIN, PROBLEM = (path.read_text() for path in OFFICE)


def office(folder: Path, domain_text: str | bytes, problem_text: str | bytes) -> InputError:
    """The error that these two files give."""
    with pytest.raises(InputError) as caught:
        load_pddl(*pair(folder, domain_text, problem_text), human="ann", robots=["bot"])
    assert "\n" not in str(caught.value)
    return caught.value


def spoilt(text: str, old: str, new: str) -> tuple[str, int]:
    """The text with a part replaced, and the line of that part."""
    assert text.count(old) >= 1
    return text.replace(old, new, 1), text.count("\n", 0, text.index(old)) + 1


def is_named_with_its_line(folder: Path, name: str, old: str, new: str, message: str) -> None:
    texts = {"domain": DOMAIN, "problem": PROBLEM}
    texts[name], line = spoilt(texts[name], old, new)
    error = office(folder, *texts.values())
    assert message in str(error)
    assert (error.file, error.line) == (str(folder / f"{name}.pddl"), line)


BAD_DOMAINS = """
(at ?who ?from) | (att ?who ?from) | action 'move': unknown predicate 'att'
(door ?from ?to) | (door ?from) | predicate 'door' takes 2 arguments, got 1
(at ?who ?from) | (at ?from ?from) | '?from' is of type 'room', expected type 'agent'
(at ?who ?from) | (at ?who cellar) | object 'cellar' is not declared
(at ?who ?from) | (at ?who ?form) | variable '?form' is not declared
?to - room | ?to - rooom | unknown type 'rooom'
basement - lift | basement - elevator | object 'basement': unknown type 'elevator'
(steps ?to) | (stairs ?to) | unknown function 'stairs'
(:action fetch | (:action move | action 'move' is defined already in line 15
(door ?from ?to) | (< (steps ?to) 3) | numeric conditions are not supported
(:functions | (:derived (p) (q)) (:functions | derived predicates (':derived') are not supported
(:action fetch | (:process fetch | processes (':process') are not supported
(has ?who ?what) (not (in | (probabilistic 0.5 (read ?what)) (not (in | probabilistic
(:requirements | (:wishes | expected a section of a domain, got ':wishes'
(:constants | (:types | ':types' was given already in line 4
?from ?to - room | ?from ?to - (either room hall) | unknown type 'hall'
?from ?to - room | ?from ?to - (or room thing) | expected a type or '(either TYPE ...)', got '(or
?from ?to - room | ?from ?to - | expected a type, got ')'
?who - agent ?from | ?to - agent ?from | parameter '?to' is declared twice
(read ?what - thing) | (read ?what - thing) (read) | predicate 'read' is declared twice
define (domain | define (problem | expected 'domain', got 'problem'
"""


@pytest.mark.parametrize(("old", "new", "message"), table(BAD_DOMAINS))
def test_bad_domain(tmp_path: Path, old: str, new: str, message: str) -> None:
    is_named_with_its_line(tmp_path, "domain", old, new, message)


BAD_PROBLEMS = """
(at ann room) | (att ann room) | initial state: unknown predicate 'att'
(at ann room) | (at ann) | predicate 'at' takes 2 arguments, got 1
(at ann room) | (at ann attic) | object 'attic' is not declared
(at ann room) | (at room ann) | 'room' is of type 'room', expected type 'agent'
domain - room | domain - rooom | object 'room': unknown type 'rooom'
(read problem) | (red problem) | goal: unknown predicate 'red'
(read problem) | (read book) | goal: object 'book' is not declared
(read problem) | (preference p1 (read problem)) | preferences ('preference') are not supported
(read problem) | (always (read problem)) | trajectory constraints ('always') are not supported
(read problem) | (read problem) (at ann room) | expected ')', got '(at ann room)'
(:goal | (:constraints (and)) (:goal | trajectory constraints (':constraints') are not supported
(at bot domain) | (at 5 (= (steps basement) 3)) | timed initial fluents ('(at 5 (...))') are not supported
(at bot domain) | (= (at bot) domain) | object fluents ('(= (...) domain)') are not supported
(at bot domain) | (and (at bot domain)) | initial state: 'and' is not possible here
(:goal | ) (:goal | expected the end of the file
(= (steps room) 2) | (= (steps room) two) | expected a number, got 'two'
"""


@pytest.mark.parametrize(("old", "new", "message"), table(BAD_PROBLEMS))
def test_bad_problem(tmp_path: Path, old: str, new: str, message: str) -> None:
    is_named_with_its_line(tmp_path, "problem", old, new, message)


@pytest.mark.parametrize("text", ["", "  \n ; only a comment\n"])
def test_empty_file(tmp_path: Path, text: str) -> None:
    assert str(tmp_path / "domain.pddl") + ": the file is empty" in str(office(tmp_path, text, PROBLEM))
    assert str(tmp_path / "problem.pddl") + ": the file is empty" in str(office(tmp_path, DOMAIN, text))


@pytest.mark.parametrize("noise", [bytes(range(256)), b"\x00\x01\x02", b"(define \x07"])
def test_binary_noise(tmp_path: Path, noise: bytes) -> None:
    assert "the file is not text" in str(office(tmp_path, noise, PROBLEM))


def test_every_cut_of_a_file_is_one_error(tmp_path: Path) -> None:
    for end in range(0, len(DOMAIN.rstrip()) - 1, 37):
        error = office(tmp_path, DOMAIN[:end], PROBLEM)
        assert error.file == str(tmp_path / "domain.pddl")
    for end in range(0, len(PROBLEM.rstrip()) - 1, 11):
        error = office(tmp_path, DOMAIN, PROBLEM[:end])
        assert error.file == str(tmp_path / "problem.pddl")


def test_files_and_folders_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.pddl: there is no such file"):
        load_pddl(OFFICE[0], tmp_path / "nowhere.pddl", human="ann", robots=["bot"])
    with pytest.raises(InputError, match="the file can't be read: is a directory"):
        load_pddl(tmp_path, OFFICE[1], human="ann", robots=["bot"])
    with pytest.raises(InputError, match="no agent's folder"):
        load(tmp_path)
    with pytest.raises(InputError, match="nowhere: there is no such folder"):
        load(tmp_path / "nowhere")
    with pytest.raises(InputError, match="this is a file: expected a folder"):
        load(OFFICE[0])
    folder = shutil.copytree(YARD, tmp_path / "yard")
    (folder / "robo" / "problem.pddl").unlink()
    with pytest.raises(InputError, match=r"robo.problem\.pddl: there is no such file"):
        load(folder)


def test_too_many_cases_of_a_condition(tmp_path: Path) -> None:
    facts = [f"(f{i})" for i in range(18)]
    either = " ".join(f"(or {' '.join(facts[i : i + 3])})" for i in range(0, 18, 3))
    text = domain(
        action("go", f"(and {either})", "(p)"),
        action("set", "(p)", " ".join(facts)),
        predicates=f"(p) {' '.join(facts)}",
    )
    with pytest.raises(InputError, match=r":5: action 'go h': more than 256 cases of its conditions"):
        one(tmp_path, text, problem())


def test_too_many_conditional_effects(tmp_path: Path) -> None:
    facts = " ".join(f"(f{i})" for i in range(10))
    whens = " ".join(f"(when (f{i}) (not (f{i})))" for i in range(10))
    text = domain(action("go", "(q)", whens), action("set", "(q)", facts), predicates=f"(p) (q) {facts}")
    with pytest.raises(
        InputError, match=r":5: action 'go \w': more than 256 cases of its conditional effects"
    ):
        one(tmp_path, text, problem(init="(q)"))


def test_a_goal_that_can_be_false_by_equality_alone(tmp_path: Path) -> None:
    text = domain(action("go", "(q)", "(p)"))
    with pytest.raises(InputError, match=r"problem\.pddl:5: the goal can never hold"):
        one(tmp_path, text, problem(goal="(= o1 o2)"))


def test_names_of_a_predicates_parameters_mean_nothing(tmp_path: Path) -> None:
    text = domain(action("go", "(twice ?who ?who)", "(p)"), predicates="(p) (twice ?x ?x - agent)")
    assert len(one(tmp_path, text, problem("(twice h h) (twice r h)")).actions) == 1
