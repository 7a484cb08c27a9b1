"""The service under load: many clients, all answers compared with the library's.

    python -m benchmarks.service [--clients 32] [--seconds 60] [--workers 2]

Clients on this machine ask, one request after the other on a connection of their own, for answers that
the library has given before (all but ``statistics`` has to be the same), and for certificates.  Memory is
that of the server and its workers.  Clients share the processors with the server, so a machine of its own
would serve more.  What goes wrong beside them, such as workers that are killed, is in ``tests/live``.
"""

import http.client
import json
import re
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import cycle, islice, product
from pathlib import Path
from typing import Any

import typer

import serendipity
from serendipity.evaluation.measuring.figures import machine, milliseconds
from serendipity.scenarios.examples import EXAMPLES

OPTIONS: list[dict[str, Any]] = [
    *({"discount": discount} for discount in ("0", "0.3", "0.6", "0.9")),
    *({"discount": "0.9", "mode": mode} for mode in ("communication", "composite", "individual")),
    {"discount": "0.9", "human_model": "observant"},
]
TASKS = [name for name in EXAMPLES if name != "taxis"]
"""Those whose calls take milliseconds, so that the service is measured, not the planner."""

Asked = tuple[str, bytes, dict[str, Any]]
"""Path, body and what has to be answered."""


def main(clients: int = 32, seconds: float = 60, workers: int = 2) -> None:
    """Measure and print."""
    asked = [each for name, options in product(TASKS, OPTIONS) for each in requests(name, options)]
    words = ["serve", "--port", "0", "--workers", str(workers), "--body-limit", "1"]
    command = [sys.executable, "-m", "serendipity", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        found = re.search(r":(\d+)", process.stdout.readline() if process.stdout else "")
        assert found is not None
        until = time.perf_counter() + seconds
        with ThreadPoolExecutor(clients) as threads:
            runs = threads.map(partial(client, int(found[1]), asked, until), range(clients))
            memory = []
            while time.perf_counter() < until:
                time.sleep(0.5)
                memory.append(_resident(process.pid))
            said = [each for run in runs for each in run]
        process.send_signal(signal.SIGTERM)
    halves = (memory[4 : len(memory) // 2], memory[len(memory) // 2 :])
    mib = " and ".join(f"{sum(half) / max(1, len(half)) / 1024:.0f}" for half in halves)
    print(f"{clients} clients, {seconds:g} s, {workers} workers; {machine()}")
    took = milliseconds([each for each, _ in said])
    print(f"answers: {len(said)}, {len(said) / seconds:.0f} a second; ms {took}")
    print(f"of them {dict(Counter(what for _, what in said))}")
    print(f"memory of all processes, mean of each half: {mib} MiB")


def requests(name: str, options: dict[str, Any]) -> list[Asked]:
    """A call, and the certificate of its answer."""
    task, given = serendipity.example(name), {"task": {"example": name}}
    result = serendipity.plan(task, **options)
    found = [("/plan", json.dumps({**given, "options": options}).encode(), bare(result.to_dict()))]
    if options == {"discount": "0.6"}:
        right = bare(serendipity.verify(task, result).to_dict())
        found.append(("/verify", json.dumps({**given, "result": result.to_dict()}).encode(), right))
    return found


def bare(answer: dict[str, Any]) -> dict[str, Any]:
    """What does not depend on the clock; claims by name."""
    if "claims" in answer:
        return {claim["claim"]: claim["verdict"] for claim in answer["claims"]}
    return {name: value for name, value in answer.items() if name != "statistics"}


def client(port: int, asked: list[Asked], until: float, number: int) -> list[tuple[float, str]]:
    """One request after the other, each client from another one on: seconds, and what came of it."""
    connection, said = http.client.HTTPConnection("127.0.0.1", port, timeout=60), []
    for path, body, right in islice(cycle(asked), number * 7, None):
        begun = time.perf_counter()
        if begun > until:
            break
        try:
            connection.request("POST", path, body, {"Content-Type": "application/json"})
            response = connection.getresponse()
            content = response.read()
            what = str(response.status)
            if response.status == 200:
                what = "right" if bare(json.loads(content)) == right else "wrong"
        except (OSError, http.client.HTTPException):
            what = "lost"
            connection.close()
        said.append((time.perf_counter() - begun, what))
    return said


def _resident(pid: int) -> int:
    """KiB of a process and its children."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    status = "".join(Path(f"/proc/{each}/status").read_text() for each in (pid, *children))
    return sum(map(int, re.findall(r"VmRSS:\s+(\d+)", status)))


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
