"""Many homes on servers side by side, of which one is killed, and one is asked to end, in the middle.

    python -m benchmarks.replicas [--replicas 4] [--homes 40] [--seconds 60] [--clients 8]

Homes have shipped examples, and the smaller breakfasts of ``home``, where those are there.
Behind one address nginx, which has to be there, sends each home to the replica that its name leads to, or,
where that does not answer, to the next one, under the same ``Idempotency-Key``, by the lines of
``docs/howto/serve.md``.  Each answer is compared with the library's.
"""

import asyncio
import re
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import httpx

import serendipity
from benchmarks.problems import PROBLEMS, run
from serendipity.evaluation.measuring.figures import percentile
from serendipity_live.guards.connections import listening, url

EXAMPLES: Final = ("room2", "room5", "flights", "parcels", "morning", "office")
BREAKFASTS: Final = ("p4", "p6")
HOW_TO: Final = Path(__file__).resolve().parents[1] / "docs" / "howto" / "serve.md"
DISCOUNTS: Final = ("0.5", "0.6", "0.7", "0.8", "0.9")


def main(replicas: int = 4, homes: int = 40, seconds: float = 60, clients: int = 8) -> None:
    """Measure and print."""
    started = [_started() for _ in range(replicas)]
    try:
        asyncio.run(_measured(started, homes, seconds, clients))
    finally:
        for process, _ in started:
            process.kill()


def _started() -> tuple[subprocess.Popen[str], str]:
    command = [sys.executable, "-m", "serendipity", "serve", "--port", "0", "--workers", "1"]
    command += ["--allow-host", "serendipity"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    return process, process.stdout.readline().split()[2].rstrip(",")


async def _measured(
    replicas: list[tuple[subprocess.Popen[str], str]], homes: int, seconds: float, clients: int
) -> None:
    tasks = dict(_tasks())
    calls = list(zip(cycle(tasks), cycle(DISCOUNTS), range(homes), strict=False))
    expected = {
        (name, discount): serendipity.plan(tasks[name][1], discount=discount) for name, discount, _ in calls
    }
    async with _balanced([at for _, at in replicas]) as address:
        turns, found, times = iter(range(10**9)), Counter[str](), list[float]()
        end = time.monotonic() + seconds

        async def client() -> None:
            async with httpx.AsyncClient(base_url=address, timeout=60) as front:
                while time.monotonic() < end:
                    turn = next(turns)
                    name, discount, home = calls[turn % len(calls)]
                    begun = time.perf_counter()
                    body = {"task": tasks[name][0], "options": {"discount": float(discount)}}
                    head = {"X-Home": str(home), "Idempotency-Key": f"{home} {turn}"}
                    answer = await front.post("/plan", json=body, headers=head)
                    times.append(time.perf_counter() - begun)
                    found[_judged(answer, expected[name, discount])] += 1

        async def accidents() -> None:
            await asyncio.sleep(seconds / 3)
            replicas[0][0].send_signal(signal.SIGKILL)
            await asyncio.sleep(seconds / 3)
            replicas[1][0].send_signal(signal.SIGTERM)

        await asyncio.gather(accidents(), *(client() for _ in range(clients)))
        drained = await asyncio.to_thread(replicas[1][0].wait, 40)
    told = ", ".join(f"{found[kind]} {kind}" for kind in ("right", "wrong", "lost"))
    print(f"{len(times)} calls in {seconds:g} s, {len(times) / seconds:.0f} a second: {told}")
    print(f"p50 {1000 * percentile(times, 0.5):.1f} ms, p99 {1000 * percentile(times, 0.99):.1f} ms")
    print(f"longest {1000 * max(times):.0f} ms; the one that was asked to end did with {drained}")


def _tasks() -> Iterator[tuple[str, tuple[dict[str, str], serendipity.Task]]]:
    """Tasks by name, each as it is sent, and as the library has it."""
    for name in EXAMPLES:
        yield name, ({"example": name}, serendipity.example(name))
    domain = PROBLEMS / "home" / "domain.pddl"
    for problem in (domain.with_name(f"{name}.pddl") for name in BREAKFASTS if domain.exists()):
        sent = {"domain": domain.read_text(), "problem": problem.read_text(), "human": "ann"}
        yield problem.stem, (sent, serendipity.load_pddl(domain, problem, "ann"))


def _judged(answer: httpx.Response, expected: serendipity.Result) -> str:
    if answer.status_code != 200:
        return "lost"
    told: dict[str, Any] = answer.json()
    same = (told["cost"], told["objective"]) == (expected.cost, expected.objective)
    return "right" if same else "wrong"


@asynccontextmanager
async def _balanced(replicas: list[str]) -> AsyncIterator[str]:
    """The address of nginx, by the lines of the how-to, with these servers behind it."""
    with listening("127.0.0.1", 0) as listener:
        at = url(listener)
    lines = re.search(r"upstream serendipity.*?(?=```)", HOW_TO.read_text(), re.DOTALL)
    assert lines is not None, "they are there"
    servers = "".join(rf"    server {one.removeprefix('http://')}\2\n" for one in replicas)
    rules = re.sub(r"( *server \S+:8123( .*;)\n)+", servers, lines[0])
    rules = rules.replace("server {", f"server {{\n    listen {at.removeprefix('http://')};")
    with TemporaryDirectory() as folder:
        config = Path(folder) / "nginx.conf"
        files = f"daemon off;\npid {folder}/pid;\nerror_log {folder}/errors;\n"
        config.write_text(f"{files}events {{}}\nhttp {{\naccess_log off;\n{rules}}}\n")
        process = subprocess.Popen(["nginx", "-p", folder, "-c", str(config)])
        await asyncio.sleep(1)
        yield at
        process.terminate()
        process.wait(10)


if __name__ == "__main__":
    run(main, __doc__)
