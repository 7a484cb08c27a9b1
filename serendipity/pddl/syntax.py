"""PDDL text to plado's syntax tree, section by section.

The sections are walked here, since plado insists on a goal, on predicates and on
actions, which an agent's file may lack; what is inside a section is plado's.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Final, TypeVar

from plado.parser import parser as plado
from plado.parser.tokenizer import Category

from serendipity.model import InputError
from serendipity.pddl.tokens import TokenStream, Word, tokenize

_UNSUPPORTED: Final = {
    ":derived": "derived predicates",
    ":axiom": "axioms",
    ":durative-action": "durative actions",
    ":process": "processes",
    ":event": "events",
    ":constraints": "trajectory constraints",
    ":goal-reward": "goal rewards",
}

_UNSUPPORTED_WORDS: Final = ("either", "preference", "probabilistic", "at-end", "always", "sometime")

T = TypeVar("T", bound="DomainSyntax | ProblemSyntax")


@dataclass(slots=True)
class DomainSyntax:
    """The sections of a domain file; names carry their lines."""

    name: Word
    types: list[Any] = field(default_factory=list)
    constants: list[Any] = field(default_factory=list)
    predicates: list[Any] = field(default_factory=list)
    functions: list[Any] = field(default_factory=list)
    actions: list[Any] = field(default_factory=list)


@dataclass(slots=True)
class ProblemSyntax:
    """The sections of a problem file; no goal is a conjunction of nothing."""

    name: Word
    domain: Word | None = None
    objects: list[Any] = field(default_factory=list)
    init: list[Any] = field(default_factory=list)
    goal: Any = None
    goal_line: int | None = None
    metric: Any = None
    metric_line: int | None = None


@lru_cache(maxsize=64)
def parse_domain(text: str) -> DomainSyntax:
    """The syntax tree of a domain's text.

    Raises:
        InputError: with the line, without the file.
    """
    return _parse(text, "domain", DomainSyntax, _domain_section)


def parse_problem(text: str) -> ProblemSyntax:
    """The syntax tree of a problem's text.

    Raises:
        InputError: with the line, without the file.
    """
    return _parse(text, "problem", ProblemSyntax, _problem_section)


def _parse(text: str, kind: str, make: type[T], section: Callable[[T, Word, TokenStream], None]) -> T:
    tokens = TokenStream(tokenize(text))
    if not tokens.tokens:
        raise InputError(f"the file is empty: expected '(define ({kind} ...'")
    try:
        for expected in ("(", "define", "(", kind):
            tokens.expect(expected)
        syntax = make(tokens.expect_name(f"the name of the {kind}"))
        tokens.expect(")")
        seen: dict[str, int] = {}
        while next(tokens).cat is Category.LBRACK:
            keyword = next(tokens).tok
            if keyword != ":action" and seen.setdefault(keyword, keyword.line) != keyword.line:
                before = seen[keyword]
                raise InputError(f"'{keyword}' was given already in line {before}", line=keyword.line)
            _refuse_unsupported(keyword)
            section(syntax, keyword, tokens)
    except plado.ParseError as error:
        raise _syntax_error(error, tokens) from None
    except RecursionError:
        raise InputError("brackets are nested too deeply", line=tokens.last().tok.line) from None
    if tokens.last().cat is not Category.RBRACK:
        raise InputError(f"expected '(' or ')', got '{tokens.last().tok}'", line=tokens.last().tok.line)
    if tokens.position < len(tokens.tokens):
        rest = tokens[0].tok
        raise InputError(f"expected the end of the file after the last ')', got '{rest}'", line=rest.line)
    return syntax


def _domain_section(domain: DomainSyntax, keyword: Word, tokens: TokenStream) -> None:
    match str(keyword):
        case ":requirements":
            _skip_names(tokens)
        case ":types":
            domain.types = plado.parse_types(tokens)
        case ":constants":
            domain.constants = plado.parse_constants(tokens)
        case ":predicates":
            domain.predicates = plado.parse_predicates(tokens)
        case ":functions":
            domain.functions = plado.parse_functions(tokens)
        case ":action":
            domain.actions.append(plado.parse_action(tokens))
        case _:
            raise InputError(f"expected a section of a domain, got '{keyword}'", line=keyword.line)


def _problem_section(problem: ProblemSyntax, keyword: Word, tokens: TokenStream) -> None:
    match str(keyword):
        case ":requirements":
            _skip_names(tokens)
        case ":domain":
            problem.domain = tokens.expect_name("the name of the domain")
            tokens.expect(")")
        case ":objects":
            problem.objects = plado.parse_constants(tokens)
        case ":init":
            problem.init = plado.parse_initial(tokens)
        case ":goal":
            problem.goal_line = keyword.line
            if tokens[0].cat is not Category.RBRACK:
                problem.goal = plado._parse_condition(tokens)
            tokens.expect(")")
        case ":metric":
            problem.metric_line = keyword.line
            problem.metric = plado.parse_metric(tokens)
            tokens.expect(")")
        case _:
            raise InputError(f"expected a section of a problem, got '{keyword}'", line=keyword.line)


def _skip_names(tokens: TokenStream) -> None:
    while next(tokens).cat is not Category.RBRACK:
        pass


def _refuse_unsupported(keyword: Word) -> None:
    if keyword in _UNSUPPORTED:
        raise InputError(f"{_UNSUPPORTED[keyword]} ('{keyword}') are not supported", line=keyword.line)


def _syntax_error(error: Exception, tokens: TokenStream) -> InputError:
    """Plado's complaint with the place, and the action that it is in."""
    got = tokens.last().tok
    nearby = tokens.tokens[max(0, tokens.position - 3) : tokens.position + 1]
    for token in nearby:
        if token.tok in _UNSUPPORTED_WORDS:
            raise InputError(f"'{token.tok}' is not supported", line=token.tok.line) from None
    action = next(
        (
            tokens.tokens[i + 1].tok
            for i in range(min(tokens.position, len(tokens.tokens) - 1) - 1, 0, -1)
            if tokens.tokens[i].tok == ":action"
        ),
        None,
    )
    text = str(error).replace("Received unexpected token", "unexpected").strip()
    where = f"action '{action}': " if action is not None else ""
    return InputError(f"{where}syntax error near '{got}': {text}", line=got.line)
