"""The OpenAPI document, from which other programs and the page's types are made."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import httpx
import pytest
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts

from sequence_planner.auth.roles import Role
from sequence_planner.server.openapi import document
from sequence_planner.server.openapi_document import describe
from support.places import REPOSITORY
from support.server import Server

COMMITTED = REPOSITORY / "frontend" / "openapi.json"


@pytest.fixture(scope="module")
def printed() -> str:
    """The document, which takes some seconds to make."""
    return document()


@pytest.fixture(scope="module")
def described(printed: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(printed)
    return found


def test_the_stream_is_described(described: dict[str, Any]) -> None:
    schemas = described["components"]["schemas"]
    kinds = {each["$ref"].rpartition("/")[2] for each in schemas["StreamMessage"]["oneOf"]}
    assert kinds == {"Snapshot", "Delta", "Link", "StreamError"}
    assert {"StationView", "StationChange", "StationRemoval", "Resync", "Problem"} <= schemas.keys()
    assert "required" not in schemas["StationChange"]


def test_every_websocket_says_what_it_sends_and_takes(described: dict[str, Any], server: Server) -> None:
    streams = {route.path_format for route in iter_route_contexts(server.app.routes) if route.methods is None}
    assert streams == described["x-websockets"].keys()


def test_tags_servers_and_webhooks_are_described(described: dict[str, Any]) -> None:
    used = {tag for verbs in described["paths"].values() for each in verbs.values() for tag in each["tags"]}
    told = {each["name"]: each["description"] for each in described["tags"]}
    assert used == told.keys()
    assert all(text.endswith(".") for text in told.values())
    assert described["servers"] == [{"url": "/", "description": "The station that this document was read from."}]
    event = described["webhooks"]["event"]["post"]
    assert {each["name"] for each in event["parameters"]} == {"webhook-id", "webhook-timestamp", "webhook-signature"}
    assert event["requestBody"]["content"]["application/json"]["schema"]["$ref"].endswith("/JobEvent")


def test_every_reference_leads_somewhere(printed: str, described: dict[str, Any]) -> None:
    for part in printed.split('"$ref": "')[1:]:
        _, _, kind, name = part.partition('"')[0].split("/")
        assert name in described["components"][kind]


def test_every_operation_and_every_model_has_a_name_of_its_own(described: dict[str, Any]) -> None:
    operations = [operation["operationId"] for verbs in described["paths"].values() for operation in verbs.values()]
    assert len(set(operations)) == len(operations)
    assert [each for each in operations if not re.fullmatch("[a-z]+(_[a-z]+)*", each)] == []
    assert [each for each in described["components"]["schemas"] if not re.fullmatch("[A-Z][A-Za-z]+", each)] == []


def test_every_refusal_is_described_as_a_problem(described: dict[str, Any]) -> None:
    for path, verbs in described["paths"].items():
        for verb, operation in verbs.items():
            for status, answer in operation["responses"].items():
                if "$ref" in answer:
                    answer = described["components"]["responses"][answer["$ref"].rpartition("/")[2]]
                if not status.startswith("2"):
                    assert answer["content"].keys() == {"application/problem+json"}, (path, verb, status)
            assert "default" in operation["responses"]


def test_each_operation_says_with_which_status_it_refuses(described: dict[str, Any]) -> None:
    paths = described["paths"]
    assert paths["/healthz"]["get"]["responses"].keys() == {"200", "431", "503", "default"}
    assert paths["/api/v1/tasks"]["get"]["responses"].keys() == {"200", "401", "403", "431", "503", "default"}
    change = paths["/api/v1/users/{person}"]["patch"]["responses"]
    assert {"401", "403", "404", "409", "412", "415", "422", "428"} < change.keys()
    assert list(change["200"]["headers"]) == ["ETag"]
    assert list(described["components"]["responses"]["Problem429"]["headers"]) == ["Retry-After"]


def test_the_printed_document_is_the_served_one_and_always_the_same(printed: str, client: httpx.Client) -> None:
    again = subprocess.run(
        [sys.executable, "-m", "sequence_planner.server.openapi"],
        env={**os.environ, "PYTHONHASHSEED": "1"},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert again == printed
    assert json.loads(printed) == client.get("/api/v1/openapi.json").json()


def test_nobody_waits_while_the_document_is_made(
    server: Server, client: httpx.Client, described: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It takes more than a second of a processor, in a server that has to take a stop at any time."""
    begun, answered = threading.Event(), threading.Event()

    def slowly(app: FastAPI) -> dict[str, Any]:
        begun.set()
        assert answered.wait(20)
        return describe(app)

    monkeypatch.setattr("sequence_planner.server.app.describe", slowly)
    with ThreadPoolExecutor() as others, server.client(Role.VIEWER) as reader:
        reading = [others.submit(reader.get, "/api/v1/openapi.json", timeout=60) for _ in range(2)]
        assert begun.wait(20)
        try:
            assert client.get("/api/v1/session", timeout=15).status_code == 200
        finally:
            answered.set()
        assert [each.result().json() for each in reading] == [described] * 2


def test_the_page_is_made_from_this_document(printed: str) -> None:
    assert COMMITTED.read_text() == printed, "run `make types`"


def test_no_viewer_is_served_that_needs_the_network(client: httpx.Client) -> None:
    for path in ("/docs", "/redoc", "/api/v1/docs"):
        assert client.get(path).status_code != 200
