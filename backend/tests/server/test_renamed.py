"""Addresses of before lead to those of now."""

from __future__ import annotations

import json
import re
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from sequence_planner.server.http.renamed import PAGES, ROUTES
from support.server import Server

from .watching import Device, active

REPOSITORY = Path(__file__).parents[3]
API = "/api/v1"
CHANGES = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
# Every operation of version 0.2 that has another address now, with the one that it has.
OPERATIONS = {
    "GET /advice": "/recovery/proposals",
    "POST /approvals/outputs": "/approvals/restored-outputs",
    "PUT /control": "/control-lock",
    "DELETE /control": "/control-lock",
    "POST /errands": "/operator-plans",
    "POST /errands/goal-preview": "/operator-plans/goal-preview",
    "POST /errands/reset-preview": "/operator-plans/reset-preview",
    "POST /errands/stop": "/operator-plans/stop",
    "POST /first-administrator": "/setup",
    "GET /keys": "/api-keys",
    "POST /keys": "/api-keys",
    "DELETE /keys/{key}": "/api-keys/{key}",
    "POST /keys/{key}/rotation": "/api-keys/{key}/rotation",
    "POST /model/pipelines/fits": "/model/pipelines/suggestions",
    "POST /model/pipelines/trials": "/model/pipelines/test-runs",
    "GET /order-of-work": "/schedule",
    "PUT /outputs": "/restored-outputs",
    "GET /people": "/users",
    "POST /people": "/users",
    "PATCH /people/{person}": "/users/{person}",
    "PUT /people/{person}/password": "/users/{person}/password",
    "DELETE /people/{person}/sessions": "/users/{person}/sessions",
    "PUT /service/{kind}/{name}": "/availability/{kind}/{name}",
    "POST /trials": "/test-runs",
    "GET /watches": "/wearables",
    "POST /watches/offers": "/wearables/offers",
    "DELETE /watches/offers/{offer}": "/wearables/offers/{offer}",
    "POST /watches/pairing": "/wearables/pairing",
    "GET /watches/self": "/wearables/self",
    "DELETE /watches/{watch}": "/wearables/{watch}",
    "POST /watches/{watch}/confirmation": "/wearables/{watch}/confirmation",
    "POST /webhooks/{webhook}/dead-letters/again": "/webhooks/{webhook}/dead-letters/retry",
    "GET /why-not/ability/{name}": "/abilities/{name}/blockers",
    "GET /why-not/operation/{name}": "/operations/{name}/blockers",
    "POST /why-not/goal": "/goals/blockers",
    "PUT /work-by-order": "/settings/job-mode",
}


def named(address: str) -> str:
    """An address with names in it that have to be written in a special way there."""
    return re.sub(r"\{\w+\}", "robot.move%28a%2Fb%20%C3%A5%29", address)


def test_an_old_address_answers_with_the_new_one_and_nothing_else(server: Server) -> None:
    described = json.loads((REPOSITORY / "frontend" / "openapi.json").read_text(encoding="utf-8"))["paths"]
    with httpx.Client(base_url=server.address) as nobody:  # who is not signed in learns what stands in the changelog
        for operation, new in OPERATIONS.items():
            method, _, old = operation.partition(" ")
            assert method.lower() in described[API + new], operation
            answer = nobody.request(method, API + named(old) + "?limit=3&after=%20")
            assert (answer.status_code, answer.content) == (308, b""), operation
            assert answer.headers["location"] == API + named(new) + "?limit=3&after=%20"
            assert nobody.request(method, API + named(old)).headers["location"] == API + named(new)


def test_each_old_address_is_tried_and_told() -> None:
    tried = {operation.partition(" ")[2] for operation in OPERATIONS}
    for old, new in ROUTES.items():
        assert any(each == old or each.startswith(f"{old}/") for each in tried), old
        assert f"| `{old}` | `{new}` |" in CHANGES
    for old, new in PAGES.items():
        assert f"| `{old}` | `{new}` |" in CHANGES


def test_who_follows_keeps_method_and_body_and_is_asked_who_it_is(server: Server, client: httpx.Client) -> None:
    body = {"over": None, "reason": "my shift"}
    assert client.put(f"{API}/control", json=body, follow_redirects=True).status_code == 204
    assert client.delete(f"{API}/control", follow_redirects=True).status_code == 204
    assert client.get(f"{API}/people", follow_redirects=True).status_code == 403
    with httpx.Client(base_url=server.address, follow_redirects=True) as nobody:
        assert nobody.get(f"{API}/people").status_code == 401
        assert nobody.post(f"{API}/errands/stop", json={}).status_code == 401


def test_a_request_of_a_foreign_page_is_not_sent_on(client: httpx.Client) -> None:
    answer = client.put(f"{API}/control", json={"over": None}, headers={"Origin": "https://evil.example"})
    assert (answer.status_code, answer.headers.get("location")) == (403, None)


def test_nothing_else_is_sent_on(client: httpx.Client) -> None:
    for path in ("/api/v1/errands-2", "/api/v1/why-not/resource/robot", "/people/1", "//people", "/control"):
        assert client.get(path).status_code in (404, 503), path


def test_an_old_page_leads_to_the_new_one(client: httpx.Client) -> None:
    for old, new in PAGES.items():
        answer = client.get(f"{old}?name=robot.move")
        assert (answer.status_code, answer.headers["location"]) == (308, f"{new}?name=robot.move"), old


def test_the_old_stream_of_a_watch_goes_on(server: Server, client: httpx.Client, device: Device) -> None:
    with pytest.raises(InvalidStatus, match="401"):
        device.listen("/api/v1/watches/stream")
    active(client, device)
    with device.listen("/api/v1/watches/stream") as stream:
        assert json.loads(stream.recv(5))["kind"] == "watch"


def test_what_an_installed_watch_has_kept_leads_to_the_new_page() -> None:
    """An older service worker answers with what it is answered, and a browser takes no redirection from it."""
    page = (REPOSITORY / "frontend" / "static" / "watch.html").read_text(encoding="utf-8")
    assert '<meta http-equiv="refresh" content="0; url=/operator" />' in page
    assert (REPOSITORY / "frontend" / "src" / "routes" / "operator" / "+page.svelte").exists()
    manifest = json.loads((REPOSITORY / "frontend" / "static" / "manifest.webmanifest").read_text(encoding="utf-8"))
    assert (manifest["id"], manifest["start_url"]) == ("/watch", "/operator"), "it is the same app as before"
