"""A session that another worker goes on with knows what it knew."""

from typing import Any

from serendipity.live.workers.jobs import State, WorkerState, session
from serendipity.model import Deadline


def _said(worker: WorkerState, remembered: dict[str, Any], call: str, **given: Any) -> list[dict[str, Any]]:
    *answers, state = session(worker, {"session": remembered, "call": call, "given": given}, Deadline())
    assert isinstance(state, State)
    remembered.update(state=dict(state), version=remembered["version"] + 1)
    return list(answers)


def test_another_worker_begins_with_the_rest_of_the_last_answer() -> None:
    begun = {"task": {"example": "room2"}, "options": {"discount": 0.6}, "human_plan": None}
    remembered: dict[str, Any] = {"id": "a", "version": 0, "state": None, "begun": begun}
    one, other = WorkerState(), WorkerState()
    _said(one, remembered, "begin")
    (first,) = _said(one, remembered, "plan", options={})
    now = [step["action"] for step in first["plan"] if step["epoch"] == 1]
    _said(one, remembered, "execute", actions=now)
    (answer,) = _said(other, remembered, "plan", options={})
    assert (answer["status"], answer["opportunity"]) == ("optimal", True)
    assert answer["statistics"]["expanded"] == 0, "what was proved stays proved"
    assert answer["cost"] == first["cost"] - sum(s["cost"] for s in first["plan"] if s["epoch"] == 1)
    (silent,) = _said(WorkerState(), remembered, "plan", options={"mode": "assistance"})
    assert silent["status"] == "optimal", "the human's plan was predicted, not given"
