"""The service under load: many clients, all answers compared with the library's, and things that go wrong.

    python -m benchmarks.service [--clients 32] [--seconds 60] [--workers 2]

Clients on this machine ask, one request after the other on a connection of their own, for answers that
the library has given before (all but ``statistics`` has to be the same), and for certificates.  The
first run is undisturbed; in the second one workers are killed, and others send bodies that are too large,
no JSON, half a request, or leave before the answer.  Memory is that of the server and its workers.
Clients share the processors with the server, so a machine of its own would serve more.
"""

import argparse
import http.client
import itertools
import json
import os
import re
import signal
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import serendipity
from serendipity.scenarios.examples import EXAMPLES

OPTIONS: list[dict[str, Any]] = [
    *({"discount": discount} for discount in ("0", "0.3", "0.6", "0.9")),
    *({"discount": "0.9", "mode": mode} for mode in ("communication", "composite", "individual")),
    {"discount": "0.9", "human_model": "observant"},
]
TASKS = [name for name in EXAMPLES if name != "taxis"]
"""Those whose calls take milliseconds, so that the service is measured, not the planner."""

PAUSE = 0.1
"""Seconds between two misdeeds of one kind; a worker is killed every five seconds."""


@dataclass
class Tally:
    """What the clients of a run have seen."""

    seconds: list[float] = field(default_factory=list)
    statuses: Counter[int] = field(default_factory=Counter)
    wrong: int = 0
    failed: int = 0
    memory: list[tuple[float, int]] = field(default_factory=list)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=32)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    asked = requests()
    begun = time.perf_counter()
    for name, options in itertools.product(TASKS, OPTIONS):
        serendipity.plan(serendipity.example(name), **options)
    calls = len(TASKS) * len(OPTIONS)
    print(f"the library by itself: {calls / (time.perf_counter() - begun):.0f} plans a second in one process")
    print(
        f"{given.clients} clients, {given.seconds:g} s, {given.workers} workers, {os.cpu_count()} processors"
    )
    for disturbed in (False, True):
        with serving(given.workers) as (port, pid):
            report(
                "disturbed" if disturbed else "undisturbed", run(port, pid, asked, given, disturbed), given
            )


def requests() -> list[tuple[str, bytes, dict[str, Any]]]:
    """Path, body and what has to be answered."""
    found = []
    for name, options in itertools.product(TASKS, OPTIONS):
        task = serendipity.example(name)
        result = serendipity.plan(task, **options)
        given = {"task": {"example": name}}
        body = json.dumps({**given, "options": options}).encode()
        found.append(("/plan", body, bare(result.to_dict())))
        if options == {"discount": "0.6"}:
            claims = serendipity.verify(task, result).to_dict()["claims"]
            verdicts = {claim["claim"]: claim["verdict"] for claim in claims}
            body = json.dumps({**given, "result": result.to_dict()}).encode()
            found.append(("/verify", body, verdicts))
    return found


def bare(answer: dict[str, Any]) -> dict[str, Any]:
    """What does not depend on the clock; claims by name."""
    if "claims" in answer:
        return {claim["claim"]: claim["verdict"] for claim in answer["claims"]}
    return {name: value for name, value in answer.items() if name != "statistics"}


@contextmanager
def serving(workers: int) -> Iterator[tuple[int, int]]:
    """A server: its port and its process."""
    words = ["serve", "--port", "0", "--workers", str(workers), "--body-limit", "1"]
    command = [sys.executable, "-m", "serendipity", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        found = re.search(r":(\d+)", process.stdout.readline())
        assert found is not None
        yield int(found[1]), process.pid
        process.send_signal(signal.SIGTERM)


def run(port: int, pid: int, asked: list[Any], given: argparse.Namespace, disturbed: bool) -> Tally:
    """Everybody at once until the time is over."""
    tally, over = Tally(), threading.Event()
    jobs: list[tuple[Any, ...]] = [(client, port, asked, number, tally) for number in range(given.clients)]
    jobs.append((watch, pid, tally))
    if disturbed:
        jobs += [(misdeed, port) for misdeed in (too_large, no_json, half, gone)]
        jobs.append((kill, pid))
    threads = [threading.Thread(target=work, args=(over, *words)) for work, *words in jobs]
    for thread in threads:
        thread.start()
    time.sleep(given.seconds)
    over.set()
    for thread in threads:
        thread.join()
    return tally


def client(over: threading.Event, port: int, asked: list[Any], number: int, tally: Tally) -> None:
    """One request after the other, each client from another one on."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    for path, body, right in itertools.islice(itertools.cycle(asked), number * 7, None):
        if over.is_set():
            break
        begun = time.perf_counter()
        try:
            connection.request("POST", path, body, {"Content-Type": "application/json"})
            response = connection.getresponse()
            content = response.read()
        except (OSError, http.client.HTTPException):
            tally.failed += 1
            connection.close()
            continue
        tally.seconds.append(time.perf_counter() - begun)
        tally.statuses[response.status] += 1
        tally.wrong += response.status == 200 and bare(json.loads(content)) != right
    connection.close()


def watch(over: threading.Event, pid: int, tally: Tally) -> None:
    """Memory, every half second."""
    begun = time.perf_counter()
    while not over.wait(0.5):
        sizes = [resident(process) for process in (pid, *children(pid))]
        tally.memory.append((time.perf_counter() - begun, sum(sizes)))


def children(pid: int) -> list[int]:
    """The workers."""
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def resident(pid: int) -> int:
    """Bytes."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return 0


def kill(over: threading.Event, pid: int) -> None:
    """A worker every five seconds."""
    while not over.wait(5):
        workers = children(pid)
        if workers:
            os.kill(workers[0], signal.SIGKILL)


def said(port: int, words: bytes, *, wait: bool = True) -> bytes:
    """What a server answers to some bytes."""
    with socket.create_connection(("127.0.0.1", port), timeout=30) as connection:
        connection.sendall(words)
        return connection.recv(64) if wait else b""


def head(length: int) -> bytes:
    """Of a planning call."""
    return (
        "POST /plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        f"Content-Length: {length}\r\n\r\n"
    ).encode()


def too_large(over: threading.Event, port: int) -> None:
    """Bodies beyond the limit."""
    while not over.wait(PAUSE):
        assert said(port, head(10**9)).startswith(b"HTTP/1.1 413")


def no_json(over: threading.Event, port: int) -> None:
    """Bodies that are no JSON."""
    while not over.wait(PAUSE):
        assert said(port, head(4) + b"{,,}").startswith(b"HTTP/1.1 400")


def half(over: threading.Event, port: int) -> None:
    """Requests that never end; the server gives them up."""
    open_ones = []
    while not over.wait(PAUSE):
        connection = socket.create_connection(("127.0.0.1", port))
        connection.sendall(head(100) + b'{"task"')
        open_ones.append(connection)
    for connection in open_ones:
        connection.close()


def gone(over: threading.Event, port: int) -> None:
    """Clients that leave before the answer."""
    body = b'{"task": {"example": "room2"}, "options": {"discount": 0.9}}'
    while not over.wait(PAUSE):
        said(port, head(len(body)) + body, wait=False)


def report(name: str, tally: Tally, given: argparse.Namespace) -> None:
    """One run in a few lines."""
    *_, median, rare = (1000 * statistics.quantiles(tally.seconds, n=100)[i] for i in (49, 98))
    half_way = [size for at, size in tally.memory if at > given.seconds / 2]
    early = [size for at, size in tally.memory if at <= given.seconds / 2][4:]
    mib = [round(statistics.mean(sizes) / 2**20) for sizes in (early, half_way) if sizes]
    print(f"\n{name}")
    print(f"  requests {len(tally.seconds)}, {len(tally.seconds) / given.seconds:.0f} a second")
    print(f"  p50 {median:.0f} ms, p99 {rare:.0f} ms, most {1000 * max(tally.seconds):.0f} ms")
    print(f"  statuses {dict(sorted(tally.statuses.items()))}, connections lost {tally.failed}")
    print(f"  wrong answers {tally.wrong}")
    print(f"  memory, mean of each half: {' and '.join(map(str, mib))} MiB")
    print(f"  memory at the end: {tally.memory[-1][1] >> 20} MiB")


if __name__ == "__main__":
    main()
