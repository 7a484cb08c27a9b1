"""What is wrong gets 4xx and one line: the one that the command line says."""

import functools
import json
import math
import sys
from typing import Any

import httpx
import pytest

from serendipity.cli.app import main
from serendipity_live.tests.server import Server, serving

ROOM2 = {"example": "room2"}
TOO_EARLY = [[-3, "move commx room13 hall8"]]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"task": {"example": "room9"}}, ["plan", "--example", "room9"]),
        ({"task": ROOM2, "options": {"discount": 2}}, ["plan", "--example", "room2", "--discount", "2"]),
        ({"task": ROOM2, "options": {"mode": "x"}}, ["plan", "--example", "room2", "--mode", "x"]),
        ({"task": {**ROOM2, "human": "nemo"}}, ["plan", "--example", "room2", "--human", "nemo"]),
        (
            {"task": ROOM2, "options": {"mode": "individual", "human_model": "local"}},
            ["plan", "--example", "room2", "--mode", "individual", "--human-model", "local"],
        ),
    ],
    ids=str,
)
def test_one_line_as_on_the_command_line(server: Server, body, words, capsys) -> None:
    answer = server.post("/plan", body)
    assert answer.status_code == 422
    assert main(words) == 2
    said = capsys.readouterr().err.strip().removeprefix("Error: ")
    assert answer.json() == {"error": said}


def test_files_are_named_with_their_lines(server: Server) -> None:
    task = {"domain": "(define (domain d)\n(:foo))", "problem": "", "human": "h", "robots": ["r"]}
    answer = server.post("/plan", {"task": task})
    assert answer.status_code == 422
    assert answer.json()["error"].startswith("domain.pddl:2: ")


def test_an_answer_that_breaks_a_rule_is_not_explained(server: Server) -> None:
    result = server.post("/plan", {"task": ROOM2, "options": {"discount": 0.9}}).json()
    answer = server.post("/explain", {"task": ROOM2, "result": {**result, "cost": 1}})
    said = "result: is no answer to this task: cost: cost (semantics 2): cost is 11.4, the result says 1"
    assert (answer.status_code, answer.json()) == (422, {"error": said})


def test_a_policy_is_explained_without_a_plan_beside_it(server: Server) -> None:
    goals = [{"name": room, "goal": [f"conducted_triage commx {room}"]} for room in ("room1", "room3")]
    result = server.post("/plan", {"task": ROOM2, "goals": goals}).json()
    answer = server.post("/explain", {"task": ROOM2, "result": result, "human_plan": ["fly"]})
    said = "explain: expected a result or options, got both"
    assert (answer.status_code, answer.json()) == (422, {"error": said})


@pytest.mark.parametrize(
    ("path", "body", "status", "start"),
    [
        ("/plan", {}, 422, "task: "),
        ("/plan", {"task": {}}, 422, "task: expected one of"),
        ("/plan", {"task": {"example": "room2", "team": {"domain": "", "problem": ""}}}, 422, "task: team: "),
        ("/plan", {"task": ROOM2, "goals": "/etc/passwd"}, 422, "goals: "),
        ("/plan", {"task": ROOM2, "observed": "/etc/passwd"}, 422, "observed: "),
        ("/plan", {"task": ROOM2, "deadline": 3}, 422, "deadline: "),
        ("/plan", {"task": ROOM2, "options": {"deadline": 3}}, 422, "unknown option 'deadline'"),
        ("/plan", {"task": ROOM2, "options": {"visible": 3}}, 422, "unknown option 'visible'"),
        ("/plan", {"task": {"agents": {"../x": {"domain": "", "problem": ""}}}}, 422, "agents: "),
        ("/plan", {"task": {"agents": {}}}, 422, "agents: expected a pair of files for each agent, got none"),
        ("/plan", {"task": ROOM2, "human_plan": ["fly"]}, 422, "human plan, step 1: "),
        ("/verify", {"task": ROOM2, "result": {}}, 422, "result: schema: "),
        ("/sessions", {"task": ROOM2, "options": {"x": 1}}, 422, "unknown option 'x'"),
        ("/sessions", {"task": ROOM2, "human_plan": ["fly"]}, 422, "human plan, step 1: there is no action"),
        ("/sessions", {"task": ROOM2, "human_plan": TOO_EARLY}, 422, "human plan, step 1: 'move"),
        ("/sessions/none/change", {"facts": {"x": "yes"}}, 422, "facts.x: input should be a valid boolean"),
        ("/plan", {"task": ROOM2, "plans": "/etc/passwd"}, 422, "plans"),
        ("/plan", {"task": ROOM2, "plans": {"schema": "x", "plans": []}}, 422, "plans: schema: "),
        ("/sessions/none/plan", {}, 404, "session 'none': "),
        ("/nowhere", {}, 404, "Not Found"),
    ],
)
def test_wrong_requests(server: Server, path: str, body: object, status: int, start: str) -> None:
    answer = server.post(path, body)
    assert (answer.status_code, answer.json()["error"][: len(start)]) == (status, start)
    assert "\n" not in answer.json()["error"]


@pytest.mark.parametrize(
    ("content", "status"),
    [
        (b"", 422),
        (b'{"task', 400),
        (b"\xff\xfe\x00", 400),
        (b"[" * 100_000, 400),
        (b'{"task": ' + b"9" * 9999, 400),
    ],
    ids=["empty", "half", "bytes", "nested", "digits"],
)
def test_what_is_no_json(server: Server, content: bytes, status: int) -> None:
    answer = sent(server, content)
    assert (answer.status_code, set(answer.json())) == (status, {"error"})


def sent(server: Server, content: Any, kind: str = "application/json") -> httpx.Response:
    return server.client.post("/plan", content=content, headers={"content-type": kind})


def test_a_form_of_another_site_is_no_json(server: Server) -> None:
    answer = sent(server, b'{"task": {"example": "room2"}}', "text/plain")
    assert answer.status_code == 422
    assert answer.json() == {"error": "body: expected JSON, and 'Content-Type: application/json'"}


def nested(levels: int) -> object:
    return functools.reduce(lambda inner, _: [inner], range(levels), 1)


def priced(cost: str) -> dict[str, object]:
    """A task whose only action costs so much."""
    effect = f":effect (and (p) (increase (total-cost) {cost}))"
    domain = "(define (domain d) (:types agent) (:predicates (p)) (:functions (total-cost) (c))"
    domain += f"(:action a :parameters (?w - agent) {effect}))"
    objects = "(:objects h r - agent) (:init (= (c) 2)) (:goal (p))"
    return {
        "domain": domain,
        "problem": f"(define (problem p) (:domain d) {objects})",
        "human": "h",
        "robots": ["r"],
    }


@pytest.mark.parametrize(
    ("body", "start"),
    [
        ({"task": ROOM2, "options": {"discount": nested(500)}}, ""),
        ({"task": ROOM2, "options": {"discount": nested(900)}}, ""),
        ({"task": {"example": "\ud800"}}, "body: expected text, got half of a surrogate pair"),
        ({"task": {**priced("1"), "domain": "\udfff"}}, "body: expected text"),
        ({"task": ROOM2, "options": {"mode": "\ud800"}}, "body: expected text"),
        ({"task": ROOM2, "options": {"max_cost": math.nan}}, "body: expected finite numbers, got NaN"),
        ({"task": ROOM2, "options": {"mode": "composite", "horizon": math.inf}}, "body: expected finite"),
        ({"task": ROOM2, "goals": [{"goal": [], "prior": math.inf}]}, "body: expected finite numbers"),
        ({"task": {"agents": {"a" * 300: {"domain": "", "problem": ""}}}}, "agents: expected the name"),
        ({"task": priced(f"(* {'(c) ' * 1000})")}, "domain.pddl:1: action 'a h': expected a cost of at most"),
    ],
    ids=["nested", "deeply", "example", "domain", "option", "nan", "horizon", "prior", "name", "product"],
)
def test_what_is_odd_is_one_line(server: Server, body: object, start: str) -> None:
    answer = sent(server, json.dumps(body))
    assert answer.status_code in (400, 422)
    assert set(answer.json()) == {"error"}
    assert answer.json()["error"].startswith(start)
    assert "\n" not in answer.json()["error"]


def test_a_result_with_very_many_steps_in_an_epoch_is_refuted(server: Server) -> None:
    result = server.post("/plan", {"task": ROOM2}).json()
    result["plan"] = result["plan"][:1] * 2000
    answer = server.post("/verify", {"task": ROOM2, "result": result})
    assert answer.status_code == 200
    assert answer.json()["verdict"] == "refuted"


@pytest.mark.parametrize("chunked", [False, True])
def test_bodies_that_are_too_large(server: Server, chunked: bool) -> None:
    large = b" " * 600_000
    answer = sent(server, iter([large]) if chunked else large)
    assert (answer.status_code, answer.json()) == (413, {"error": "body: expected at most 524288 bytes"})


def test_names_of_other_hosts_and_pages_of_other_sites(server: Server) -> None:
    assert server.client.get("/health", headers={"host": "evil.example"}).status_code == 400
    assert server.client.get("/health", headers={"host": "[::1"}).status_code == 400
    assert server.client.get("/health", headers={"host": f"localhost:{server.port}"}).status_code == 200
    for origin in ("http://evil.example", "null"):
        assert server.client.get("/health", headers={"origin": origin}).status_code == 403
    own = server.client.get("/health", headers={"origin": server.url})
    assert own.status_code == 200
    assert not [name for name in own.headers if name.startswith("access-control")]


@pytest.mark.long
def test_a_token_where_there_is_one() -> None:
    with serving("--workers", "1", env={"SERENDIPITY_TOKEN": "secret word"}) as server:
        asked = {"task": ROOM2}
        assert {server.client.get(path).status_code for path in ("/health", "/ready")} == {200}
        for given in ({}, {"authorization": "Bearer other"}, {"authorization": "Basic secret word"}):
            assert server.post("/plan", asked, headers=given).status_code == 401
            assert server.client.get("/metrics", headers=given).status_code == 401
        assert server.post("/plan", asked, headers={"authorization": "Bearer secret word"}).status_code == 200


@pytest.mark.parametrize("command", ["serve", "play"])
def test_the_extra_is_named_where_it_is_missing(command: str, monkeypatch, capsys) -> None:
    for name in [name for name in sys.modules if name.startswith("serendipity_live")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "starlette.middleware", None)
    assert main([command]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"Error: {command}: needs ")
    assert said.endswith("install serendipity-planner[live]\n")


def test_a_port_in_use_is_one_line(server: Server, capsys) -> None:
    assert main(["serve", "--port", str(server.port)]) == 2
    words = f"{server.port} is in use on 127.0.0.1: name another one, or 0 for any that is free"
    assert capsys.readouterr().err == f"Error: --port: {words}\n"
