"""The page that describes the interface, in a real Chromium: complete, and with nothing from elsewhere."""

from typing import Any

import pytest

from tests.live.server import Server


@pytest.mark.browser
def test_the_interface_is_described_and_can_be_tried(server: Server, browser: Any) -> None:
    complaints: list[str] = []
    page = browser.new_page()
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.on("request", lambda asked: None if server.url[7:] in asked.url else complaints.append(asked.url))
    page.goto(f"{server.url}/docs")
    page.wait_for_selector(".opblock")
    assert page.locator(".opblock").count() == 17
    page.click("#operations-calls-plan_plan_post button.opblock-summary-control")
    page.click("#operations-calls-plan_plan_post .try-out__btn")
    page.fill(
        "#operations-calls-plan_plan_post textarea",
        '{"task": {"example": "room2"}, "options": {"discount": 0.6}}',
    )
    page.click("#operations-calls-plan_plan_post .execute")
    page.wait_for_selector('#operations-calls-plan_plan_post .live-responses-table :text("12.6")')
    page.close()
    assert [said for said in complaints if not said.startswith("data:")] == []
