"""The tools: what each does and asks for, and a server of the protocol that hands calls to the workers.

Arguments are those of the service's requests, and so are limits and answers; what is wrong is an error of the
tool, in the one line that the command line says.
"""

import json
from typing import Any, Final

from mcp.server.lowlevel import Server
from mcp_types import CallToolRequestParams, CallToolResult, ListToolsResult, TextContent, Tool
from pydantic import ValidationError
from pydantic_core import PydanticSerializationError
from starlette.exceptions import HTTPException

from serendipity import __version__
from serendipity.scenarios.examples import EXAMPLES
from serendipity_live.service import answering
from serendipity_live.service.requests import CALLS
from serendipity_live.workers.pool import Pool

_INSTRUCTIONS: Final = (
    "Plans help for a person who did not ask for it, and proves that none is better. A task is an example's "
    f"name ({', '.join(EXAMPLES)}), or PDDL texts. Check a task of your own with check_task first."
)


def agent_server(pool: Pool, body_limit: int) -> Server[Any]:
    """A server of the protocol, for any transport, which takes ``body_limit`` bytes of arguments at most."""

    async def list_tools(_context: object, _params: object) -> ListToolsResult:
        return ListToolsResult(
            tools=[
                Tool(name=name, description=call.about, input_schema=call.arguments.model_json_schema())
                for name, call in CALLS.items()
            ]
        )

    async def call_tool(_context: object, params: CallToolRequestParams) -> CallToolResult:
        call = CALLS.get(params.name)
        if call is None:
            return _wrong(f"tool: expected one of {', '.join(CALLS)}, got {params.name!r:.50}")
        try:
            body = call.arguments.model_validate(params.arguments or {}).model_dump_json().encode()
            if len(body) > body_limit:
                return _wrong(f"arguments: expected at most {body_limit} bytes")
            (answer,) = [body async for body in answering.answers(pool, params.name, body)]
        except ValidationError as error:
            return _wrong(answering.line_of(error.errors()[0], "arguments"))
        except (RecursionError, PydanticSerializationError):
            return _wrong("arguments: it is nested too deeply")
        except HTTPException as error:
            return _wrong(error.detail)
        text = answer.decode()
        return CallToolResult(content=[TextContent(text=text)], structured_content=json.loads(text))

    return Server(
        "serendipity",
        version=__version__,
        instructions=_INSTRUCTIONS,
        on_list_tools=list_tools,
        on_call_tool=call_tool,
    )


def _wrong(line: str) -> CallToolResult:
    return CallToolResult(content=[TextContent(text=line)], is_error=True)
