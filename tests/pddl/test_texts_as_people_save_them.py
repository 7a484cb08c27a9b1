"""Line ends, byte order marks, odd characters and endless names; and errors that stay one short line."""

from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from pathlib import Path

import pytest

from serendipity import InputError, SerendipityError, load_pddl
from serendipity.pddl.parsing.tree import MAX_DEPTH
from tests.pddl.texts import OFFICE, action, domain, one, pair, problem

DOMAIN, PROBLEM = (path.read_text() for path in OFFICE)
LONG = "x" * 1_000_000


def office(folder: Path, domain_data: str | bytes, problem_data: str | bytes = PROBLEM) -> int:
    """How many actions the office has."""
    return len(load_pddl(*pair(folder, domain_data, problem_data), human="ann", robots=["bot"]).actions)


@pytest.mark.parametrize(
    "saved",
    [
        DOMAIN.replace("\n", "\r\n").encode(),
        DOMAIN.replace("\n", "\r").encode(),
        BOM_UTF8 + DOMAIN.encode(),
        BOM_UTF16_LE + DOMAIN.encode("utf-16-le"),
        BOM_UTF16_BE + DOMAIN.encode("utf-16-be"),
        DOMAIN.replace("\n", "\x0b\x0c\t\n").encode(),
        DOMAIN.upper().encode(),
        DOMAIN.replace("; One", "; Ünë, naïve: 日本 ☂ One").encode(),
    ],
    ids=["crlf", "cr", "utf-8 mark", "utf-16 le", "utf-16 be", "blanks", "upper case", "comments"],
)
def test_the_same_office(tmp_path: Path, saved: bytes) -> None:
    assert office(tmp_path, saved) == office(tmp_path, DOMAIN) == 26


def test_lines_are_counted_however_they_end(tmp_path: Path) -> None:
    spoilt = DOMAIN.replace("(read ?what - thing)", "(read ?what - thong)")
    line = spoilt.count("\n", 0, spoilt.index("thong")) + 1
    for end in ("\n", "\r\n", "\r"):
        with pytest.raises(InputError, match="unknown type 'thong'") as caught:
            office(tmp_path, spoilt.replace("\n", end))
        assert caught.value.line == line


@pytest.mark.parametrize(
    "character", ["\x00", "\x07", "\x1b", "\x7f", "\x85", "\x9b", "\u202e", "\u2066", "\ufeff"]
)
def test_characters_that_are_no_text(tmp_path: Path, character: str) -> None:
    spoilt = DOMAIN.replace("basement", f"base{character}ment", 1)
    with pytest.raises(InputError, match="the file is not text: it has control characters") as caught:
        office(tmp_path, spoilt)
    assert caught.value.line == DOMAIN.count("\n", 0, DOMAIN.index("basement")) + 1


@pytest.mark.parametrize(
    ("domain_text", "problem_text"),
    [
        (DOMAIN.replace("basement", LONG, 1), PROBLEM),
        (DOMAIN.replace("(at ?who ?from)", f"(at ?{LONG} ?from)"), PROBLEM),
        (DOMAIN.replace("(at ?who ?from)", f"({LONG} ?from)"), PROBLEM),
        (DOMAIN.replace("?to - room", f"?to - {LONG}"), PROBLEM),
        (DOMAIN.replace("?to - room", f"?to - (either room {LONG})"), PROBLEM),
        (DOMAIN.replace("move", LONG).replace("(read ?what)", "(red ?what)"), PROBLEM),
        (DOMAIN.replace("0.25", "0." + "1" * 1000), PROBLEM),
        (DOMAIN.replace(":precondition", f":{LONG}", 1), PROBLEM),
        (DOMAIN.replace(":strips", "").replace(":typing", f":{LONG}"), PROBLEM),
        (DOMAIN, PROBLEM.replace("(at ann room)", f"(at ann {LONG})")),
        (DOMAIN, PROBLEM.replace("(at ann room)", f"({LONG} {LONG} ({LONG}) {LONG} {LONG})")),
        (DOMAIN, PROBLEM.replace("ann", LONG)),
        (DOMAIN, PROBLEM.replace("(:metric", f"(:{LONG}")),
        (DOMAIN, PROBLEM.replace("(= (steps basement) 10)", "").replace("basement", LONG)),
    ],
)
def test_errors_stay_short(tmp_path: Path, domain_text: str, problem_text: str) -> None:
    with pytest.raises(SerendipityError) as caught:
        office(tmp_path, domain_text, problem_text)
    assert len(str(caught.value).replace(str(tmp_path), "")) < 300
    assert "\n" not in str(caught.value)


def test_names_that_are_missing_are_listed_up_to_a_few(tmp_path: Path) -> None:
    objects = " ".join(f"a{i}" for i in range(1000))
    text = domain("(:action go :parameters (?who - agent) :precondition (q) :effect (p))")
    with pytest.raises(SerendipityError) as caught:
        one(tmp_path, text, problem("(q)", "(p)", f"{objects} - agent"))
    assert len(str(caught.value).replace(str(tmp_path), "")) < 300


@pytest.mark.parametrize(
    "form", ["(and {})", "(not {})", "(imply (q) {})", "(forall (?x) {})", "(or {} (q))"]
)
def test_as_many_brackets_as_may_be_nested(tmp_path: Path, form: str) -> None:
    def nested(depth: int) -> str:
        text = "(q)"
        for _ in range(depth):
            text = form.format(text)
        return text

    room = MAX_DEPTH - 4  # define, action, the and around it
    text = domain(action("go", nested(room), f"(when {nested(room - 3)} (p))"))
    task = one(tmp_path, text, problem("(q)", nested(room)))
    assert task.agents == ("h", "r")
    with pytest.raises(InputError, match=r"domain.pddl:5: brackets are nested too deeply: at most 128"):
        one(tmp_path, domain(action("go", nested(MAX_DEPTH), "(p)")), problem("(q)"))


def test_costs_may_be_nested_as_deeply(tmp_path: Path) -> None:
    expression = "(far)"
    for _ in range(MAX_DEPTH - 7):
        expression = f"(+ 1 {expression})"
    text = domain(action("go", "(q)", f"(p) (increase (total-cost) {expression})"), functions="(far)")
    task = one(tmp_path, text, problem("(q) (= (far) 2)"))
    assert {a.cost for a in task.actions} == {MAX_DEPTH - 5}


@pytest.mark.parametrize(
    ("spoilt", "message"),
    [
        ("(define (domain d) (:action))", "1: expected the name of an action, got ')'"),
        (
            "(define (domain d) (:action a b))",
            "1: action 'a': expected ':parameters', ':precondition', ':effect'",
        ),
        (
            "(define (domain d) (:action a :effect))",
            "1: action 'a': expected brackets behind ':effect', got ')'",
        ),
        ("(define (domain d) (:action a))", "1: action 'a': expected an ':effect'"),
        ("(define (domain d) (:predicates p))", "1: expected a predicate in brackets, got 'p'"),
        ("(define (domain d) (:types a -))", "1: expected a type, got ')'"),
        ("(define (domain d) (:types - a))", "1: expected a type, got '-'"),
        ("(define (domain d) words)", "1: expected a section of a domain, got 'words'"),
        ("(define (domain))", "1: expected the name of the domain, got ')'"),
        ("(define (domain d e))", "1: expected ')', got 'e'"),
        ("(define)", "1: expected '(domain NAME)', got ')'"),
        ("(design (domain d))", "1: expected 'define', got 'design'"),
        ("words", "1: expected '(define (domain ...', got 'words'"),
        ("(define (domain d))\n)", "2: expected the end of the file, got a ')' that closes nothing"),
        ("(define (domain d))\n\n(define", "3: expected the end of the file after the last ')', got '('"),
        ("(define (domain d)\n(:types a\n\n", "2: the file ends too early: expected the ')' for line 2"),
        (
            "(define (domain d) (:functions (f) - thing))",
            "1: object fluents are not supported: expected '- number'",
        ),
    ],
)
def test_what_was_expected(tmp_path: Path, spoilt: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        office(tmp_path, spoilt)
    assert f"domain.pddl:{message}" in str(caught.value)
