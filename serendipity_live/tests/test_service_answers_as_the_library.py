"""What the service answers is what the library answers, whatever way a task is named."""

import json
from collections.abc import Iterator
from typing import Any

import pytest

import serendipity
from serendipity.cli.app import main
from serendipity.model import Deadline
from serendipity.scenarios.examples import DATA
from serendipity_live.tests.conftest import Opened
from serendipity_live.tests.server import Server
from serendipity_live.workers.jobs import GivenTasks

ROOM2 = {"example": "room2"}
TEXTS = {
    "domain": (DATA / "usar/domain.pddl").read_text(),
    "problem": (DATA / "usar/room2.pddl").read_text(),
    "human": "commx",
    "robots": ["robot"],
}


def facts(answer: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in answer.items() if name != "statistics"}


def expected(**options: Any) -> dict[str, Any]:
    return facts(serendipity.plan(serendipity.example("room2"), **options).to_dict())


@pytest.mark.parametrize("task", [ROOM2, TEXTS], ids=["example", "texts"])
@pytest.mark.parametrize(
    "options",
    [
        {"discount": 0.6},
        {"discount": "3/5", "mode": "communication"},
        {"mode": "composite", "horizon": "inf"},
        {"discount": 0.9, "human_model": "observant"},
        {"mode": "individual"},
    ],
    ids=str,
)
def test_plans(server: Server, task: dict[str, Any], options: dict[str, Any]) -> None:
    answer = server.post("/plan", {"task": task, "options": options})
    assert answer.status_code == 200
    assert facts(answer.json()) == expected(**options)


def test_a_pair_of_files_for_each_agent(server: Server, tmp_path) -> None:
    assert main(["generate", "usar", "--preset", "room2", "-o", str(tmp_path / "room2")]) == 0
    pairs = {
        folder.name: {name: (folder / f"{name}.pddl").read_text() for name in ("domain", "problem")}
        for folder in sorted((tmp_path / "room2").iterdir())
        if folder.is_dir()
    }
    team = pairs.pop("superagent")
    asked = {"task": {"agents": pairs, "team": team}, "options": {"discount": 0.6}}
    answer = server.post("/plan", asked).json()
    task = serendipity.load(tmp_path / "room2")
    assert facts(answer) == facts(serendipity.plan(task, discount=0.6).to_dict())
    kept = GivenTasks(most=2)
    for order in (pairs, dict(reversed(pairs.items()))):
        given = kept.task({"agents": order, "team": team}, Deadline())
        assert given.agents == tuple(order)


def test_unknown_goals(server: Server) -> None:
    goals = [
        {"name": "one", "goal": ["conducted_triage commx room1"]},
        {"name": "three", "goal": ["conducted_triage commx room3"], "prior": 2},
    ]
    task = serendipity.example("room2")
    answer = server.post("/plan", {"task": ROOM2, "goals": goals, "options": {"discount": 0.9}})
    assert facts(answer.json()) == facts(serendipity.plan(task, goals=goals, discount=0.9).to_dict())
    seen = {"goals": goals, "observed": ["move commx room13 hall8"], "beta": 2, "noise": "miss=0.1,wrong=0.1"}
    answer = server.post("/plan", {"task": ROOM2, **seen})
    assert facts(answer.json()) == facts(serendipity.plan(task, **seen).to_dict())


def test_a_library_of_plans(server: Server) -> None:
    task = serendipity.example("room2")
    listed = [{"probability": 1, "plan": list(serendipity.plan(task).human_plan or ())}]
    for plans in (listed, {"schema": "serendipity.plans/1", "plans": listed}):
        answer = server.post("/plan", {"task": ROOM2, "plans": plans}).json()
        assert facts(answer) == facts(serendipity.plan(task, plans=listed).to_dict())


def events(text: str) -> Iterator[tuple[str, Any]]:
    for block in text.replace("\r\n", "\n").split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if ": " in line)
        if "event" in fields:
            yield fields["event"], json.loads(fields["data"])


def test_anytime_answers_get_better_and_the_last_one_stands(server: Server) -> None:
    answer = server.post("/plan/anytime", {"task": ROOM2, "options": {"discount": 0.6}})
    assert answer.headers["content-type"].startswith("text/event-stream")
    *answers, (last, _) = events(answer.text)
    assert last == "end"
    costs = [data["cost"] for kind, data in answers if kind == "answer"]
    assert costs == sorted(costs, reverse=True)
    assert facts(answers[-1][1]) == expected(discount=0.6)


def test_certificates(server: Server) -> None:
    result = server.post("/plan", {"task": ROOM2, "options": {"discount": 0.6}}).json()
    assert server.post("/verify", {"task": ROOM2, "result": result}).json()["verdict"] == "proved"
    exactly = {"task": ROOM2, "result": result, "method": "program"}
    assert server.post("/verify", exactly).json()["verdict"] == "proved"
    better = {**result, "cost": 1.0}
    assert server.post("/verify", {"task": ROOM2, "result": better}).json()["verdict"] == "refuted"


def test_a_session_goes_on_as_one_of_the_library(server: Server) -> None:
    task = serendipity.example("room2")
    ours = serendipity.Session(task, discount=0.6)
    begun = server.post("/sessions", {"task": ROOM2, "options": {"discount": 0.6}})
    assert begun.status_code == 201
    path = f"/sessions/{begun.json()['id']}"
    for _ in range(4):
        plan = ours.plan()
        theirs = server.post(f"{path}/plan", {}).json()
        assert facts(theirs) == facts(plan.to_dict())
        done = [step.action for step in plan.plan or () if step.epoch == 1]
        ours.execute(done)
        state = server.post(f"{path}/execute", {"actions": done}).json()
        assert state["facts"] == [task.facts[fact] for fact in sorted(ours.task.init)]
        assert state["human_plan"] == list(ours.human_plan or ())
    ours.change({"at mk1 room2": False})
    server.post(f"{path}/change", {"facts": {"at mk1 room2": False}})
    ours.set_goal(["conducted_triage commx room3"])
    state = server.post(f"{path}/goal", {"goal": ["conducted_triage commx room3"]}).json()
    assert state["goal"] == ["conducted_triage commx room3"]
    assert server.client.get(path).json() == state
    *_, (_, last), _ = events(server.post(f"{path}/plan/anytime", {"options": {"mode": "composite"}}).text)
    assert facts(last) == facts(ours.plan(mode="composite").to_dict())
    assert server.client.delete(path).status_code == 204
    assert server.client.get(path).status_code == 404


@pytest.mark.long
def test_a_session_in_time_goes_on_by_what_begins(server: Server) -> None:
    task, options = {"example": "morning"}, {"discount": 0.5}
    session = serendipity.Session(serendipity.example("morning"), **options)
    begun = server.post("/sessions", {"task": task, "options": options}).json()
    for epoch in range(1, 8):
        path = f"/sessions/{begun['id']}"
        answer, own = server.post(f"{path}/plan", {}).json(), session.plan()
        assert (answer["cost"], answer["human_plan"]) == (own.cost, list(own.human_plan or ()))
        now = [step.action for step in own.plan or () if step.epoch == 1]
        session.execute(now)
        moved = server.post(f"{path}/execute?snapshot=true", {"actions": now}).json()
        assert moved["time"]["passed"] == epoch
        if epoch % 3 == 0:
            begun = server.post("/sessions", {"snapshot": moved["snapshot"]}).json()
            assert {**begun, "id": ""} == {name: moved[name] for name in begun} | {"id": ""}
    assert [one["action"] for one in moved["time"]["going"]] == []


def test_a_plan_with_times(server: Server) -> None:
    plan = [[epoch, name] for epoch, name in serendipity.plan(serendipity.example("morning")).human_entries]
    asked = {"task": {"example": "morning"}, "options": {"discount": 0.5}, "human_plan": plan}
    assert server.post("/plan", asked).json()["cost"] == 35
    wrong = server.post("/plan", {**asked, "human_plan": [[1, 2, 3]]})
    assert wrong.status_code == 422 and "human_plan" in wrong.json()["error"]


@pytest.mark.browser
def test_the_interface_is_described_and_can_be_tried_in_a_browser(server: Server, opened: Opened) -> None:
    page = opened(server, at="/docs")
    page.wait_for_selector(".opblock")
    assert page.locator(".opblock").count() == 17
    plan = "#operations-calls-plan_plan_post"
    page.click(f"{plan} button.opblock-summary-control")
    page.click(f"{plan} .try-out__btn")
    page.fill(f"{plan} textarea", '{"task": {"example": "room2"}, "options": {"discount": 0.6}}')
    page.click(f"{plan} .execute")
    page.wait_for_selector(f'{plan} .live-responses-table :text("12.6")')
