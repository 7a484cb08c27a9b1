"""The tools of agents that talk: asked by the protocol's own client, over both transports."""

import json
import subprocess
import sys
from collections.abc import Awaitable, Callable
from typing import Any

import anyio
import pytest

import serendipity
from serendipity.scenarios.examples import EXAMPLES
from serendipity_live.tests.server import serving
from serendipity_live.workers.pool import Pool, PoolLimits

mcp = pytest.importorskip("mcp", reason="no mcp: install serendipity-planner[mcp]")
from mcp.client.stdio import StdioServerParameters  # noqa: E402  # where it is installed

from serendipity_live.mcp.tools import agent_server  # noqa: E402  # likewise

ROOM2: dict[str, Any] = {"example": "room2"}
LIMITS = ("--workers", "1", "--time-limit", "20", "--body-limit", "0.1")

Talk = Callable[[Any], Awaitable[None]]


def over_streams(talk: Talk) -> None:
    """Talk to a process of its own."""

    async def run() -> None:
        command = ["-m", "serendipity", "mcp", *LIMITS]
        async with mcp.Client(StdioServerParameters(command=sys.executable, args=command)) as client:
            await talk(client)

    anyio.run(run)


def over_http(talk: Talk) -> None:
    """Talk to a server on a port."""

    async def run(url: str) -> None:
        async with mcp.Client(f"{url}/mcp") as client:
            await talk(client)

    with serving("--http", *LIMITS, command="mcp") as server:
        anyio.run(run, server.url)


@pytest.fixture(params=[over_streams, over_http])
def talking(request: pytest.FixtureRequest) -> Callable[[Talk], None]:
    return request.param


async def said(client: Any, tool: str, **arguments: Any) -> Any:
    """What a tool answers, as its text and as its structure, which are the same."""
    answer = await client.call_tool(tool, arguments)
    (text,) = answer.content
    assert not answer.is_error, text.text
    assert json.loads(text.text) == answer.structured_content
    return answer.structured_content


async def refused(client: Any, tool: str, **arguments: Any) -> str:
    """The line that a tool says of what is wrong."""
    answer = await client.call_tool(tool, arguments)
    (text,) = answer.content
    assert answer.is_error
    assert "\n" not in text.text
    return text.text


@pytest.mark.long
def test_tools_say_what_the_library_says(talking: Callable[[Talk], None]) -> None:
    task = serendipity.example("room2")
    expected = serendipity.plan(task, discount="0.6")

    async def talk(client: Any) -> None:
        tools = (await client.list_tools()).tools
        assert [tool.name for tool in tools] == ["plan", "verify", "explain", "check_task"]
        assert all("task" in tool.input_schema["properties"] for tool in tools)
        result = await said(client, "plan", task=ROOM2, options={"discount": 0.6})
        assert serendipity.Result.from_dict(result).plan == expected.plan
        certificate = await said(client, "verify", task=ROOM2, result=result)
        assert certificate["verdict"] == "proved"
        told = await said(client, "explain", task=ROOM2, result=result)
        explained = serendipity.explain(task, serendipity.Result.from_dict(result)).to_dict()
        assert told == json.loads(json.dumps(explained))
        report = await said(client, "check_task", task=ROOM2)
        assert report == json.loads(json.dumps(serendipity.check_task(task).to_dict()))

    talking(talk)


@pytest.mark.long
def test_instructions_name_every_example() -> None:
    told = agent_server(Pool(PoolLimits(1, 0, 1, 100)), 1).instructions or ""
    assert all(name in told for name in EXAMPLES)


def test_what_is_wrong_is_one_line_and_the_session_goes_on(talking: Callable[[Talk], None]) -> None:
    pddl = {"problem": "", "human": "h", "robots": ["r"]}

    async def talk(client: Any) -> None:
        for arguments, start in (
            ({}, "task: field required"),
            ({"task": {}}, "task: expected one of example"),
            ({"task": 3}, "task: "),
            ({"task": {"example": "room9"}}, "example: expected one of"),
            ({"task": ROOM2, "options": {"discount": 7}}, "discount: expected a number in [0, 1], got 7"),
            ({"task": ROOM2, "options": {"mood": 7}}, "unknown option 'mood'"),
            ({"task": ROOM2, "mood": 7}, "mood: "),
            ({"task": {"domain": "(define (domain d)\n(:foo))", **pddl}}, "domain.pddl:2: "),
            ({"task": {"domain": "(" * 10_000, **pddl}}, "domain.pddl:1: brackets are nested too deeply"),
            ({"task": {"agents": {"../x": {"domain": "", "problem": ""}}}}, "agents: "),
        ):
            assert (await refused(client, "plan", **arguments)).startswith(start)
        assert (await refused(client, "dance")).startswith("tool: expected one of plan, verify")
        assert (await refused(client, "verify", task=ROOM2, result={})).startswith("result: schema: ")
        await said(client, "plan", task=ROOM2)

    talking(talk)


@pytest.mark.long
def test_what_is_too_large_is_refused_on_streams() -> None:
    async def talk(client: Any) -> None:
        large = {"domain": "x" * 60_000, "problem": "x" * 60_000, "human": "h"}
        assert await refused(client, "plan", task=large) == "arguments: expected at most 104857 bytes"
        await said(client, "check_task", task=ROOM2)

    over_streams(talk)


@pytest.mark.long
def test_a_token_is_asked_for() -> None:
    hello = {"jsonrpc": "2.0", "id": 1, "method": "ping"}
    accepts = {"Accept": "application/json, text/event-stream"}
    with serving("--http", *LIMITS, command="mcp", env={"SERENDIPITY_TOKEN": "secret"}) as server:
        answer = server.post("/mcp", hello, headers=accepts)
        assert (answer.status_code, answer.json()["error"][:14]) == (401, "Authorization:")
        answer = server.post("/mcp", hello, headers={**accepts, "Authorization": "Bearer secret"})
        assert (answer.status_code, answer.json()["id"]) == (200, 1)


@pytest.mark.long
def test_it_ends_with_its_input_and_says_nothing_else() -> None:
    command = [sys.executable, "-m", "serendipity", "mcp", *LIMITS]
    ended = subprocess.run(command, input="no JSON\n", capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0
    assert all(json.loads(line)["jsonrpc"] == "2.0" for line in ended.stdout.splitlines())
