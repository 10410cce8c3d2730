"""Addresses that name nothing, whatever they hold: each route says so, and none fails."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.audit import entry_of
from sequence_planner.controller.commands.execution import SetService
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.journal.entry import LONGEST_SUBJECT

from .fuzzing import documented, station
from .test_acting import problem

ODD = [
    "x" * 400,
    "x" * 8000,
    "%00",
    "a%00b",
    "%0d%0aX-More:%201",
    "%1b%5b2J",
    "%ff%fe",
    "%ed%a0%80",
    "%E2%80%AE",
    "..%2f..%2fetc%2fpasswd",
    "%2e%2e",
    "'%3b--",
    "-1",
    "9" * 400,
    "%25",
    "robot[%22",
]
NO_ADDRESS = ("%00", "a%00b", "%ff%fe", "%1b%5b2J")  # of those above: nothing has such a name


def test_no_route_fails_for_what_stands_in_its_address(tmp_path: Path) -> None:
    with station(tmp_path, with_model=True) as (server, _), server.client(Role.ADMINISTRATOR) as client:
        client.timeout = httpx.Timeout(60)
        document = documented(server)
        routes = [
            (verb, path, body_of(operation, document))
            for path, verbs in document["paths"].items()
            for verb, operation in verbs.items()
            if "{" in path
        ]
        assert len(routes) > 20
        for verb, path, body in routes:
            for odd in ODD:
                address = re.sub(r"\{(?!of\})\w+\}", odd, path).replace("{of}", "resource")
                answer = client.request(verb, address, json=body)
                # The controller of these tests does whatever it is told to, and knows no past.
                assert answer.status_code < 500 or "/history" in path, (verb, address[:100], body, answer.text)
                if answer.status_code >= 400:
                    assert answer.headers["content-type"] == "application/problem+json"
                    wrong = [each["field"] for each in answer.json()["errors"]]
                    assert not any(each.startswith("body") for each in wrong), (verb, path, body, wrong)
                if odd in NO_ADDRESS:
                    problem(answer, 404, "not-found")


def test_what_is_wrong_with_a_body_is_told_in_words_of_the_interface(tmp_path: Path) -> None:
    with station(tmp_path, with_model=True) as (server, _), server.client(Role.ADMINISTRATOR) as client:
        document, told = documented(server), dict[str, str]()
        for path, verbs in document["paths"].items():
            for verb, operation in verbs.items():
                body = body_of(operation, document)
                if not isinstance(body, dict) or not body:
                    continue
                address = re.sub(r"\{\w+\}", "x", path).replace("{of}", "resource")
                first = next(iter(body))
                for wrong in ({**body, f"{first}x": 1}, {**body, first: [[3]]}, {first: body[first]}, 7):
                    answer = client.request(verb, address, json=wrong)
                    if answer.status_code == 422 and answer.json()["type"] == "/problems/invalid-request":
                        told |= {each["expected"]: f"{path} {each}" for each in answer.json()["errors"]}
        assert {"this is missing", "expected a text", "expected an object with named members"} <= told.keys()
        assert any(each.startswith("this is not known here; did you mean `") for each in told)
        pydantic = ("Input should", "Extra inputs", "Field required", "valid", "permitted")
        assert not [where for each, where in told.items() if any(word in each for word in pydantic)]


def body_of(operation: dict[str, Any], document: dict[str, Any]) -> object:
    """A body that the operation takes, so that what is refused is refused for its address."""
    content = operation.get("requestBody", {}).get("content", {})
    return smallest(content["application/json"]["schema"], document) if "application/json" in content else None


def smallest(schema: dict[str, Any], document: dict[str, Any]) -> Any:  # noqa: ANN401 - JSON
    """A value that fits a schema of the document, with little more than what has to be there."""
    if "$ref" in schema:
        return smallest(document["components"]["schemas"][schema["$ref"].rpartition("/")[2]], document)
    if not schema:
        return None  # anything does
    if "const" in schema:
        return schema["const"]
    if "enum" in schema:
        return schema["enum"][0]
    if "discriminator" in schema:
        which = schema["discriminator"]
        kind, place = next(iter(which["mapping"].items()))
        return {which["propertyName"]: kind, **smallest({"$ref": place}, document)}
    if "anyOf" in schema:
        return smallest(schema["anyOf"][0], document)
    match schema.get("type"):
        case "object":
            named, least = schema.get("properties", {}), schema.get("minProperties", 0)
            needed = schema.get("required") or list(named)[:least]
            told = {name: smallest(named[name], document) for name in needed}
            rest = schema.get("additionalProperties")
            return {"x": smallest(rest, document)} if rest and least and not told else told
        case "array":
            return [smallest(schema["items"], document)] * schema.get("minItems", 0)
        case "string":
            return "x" * max(1, schema.get("minLength", 1))
        case "integer" | "number":
            return 1
        case "boolean":
            return False
    raise AssertionError(f"what fits {schema}?")


@pytest.mark.parametrize("address", ["/api/v1/audit?action=%00", "/api/v1/model/files?path=a%00b"])
def test_no_question_holds_what_no_database_keeps(client: httpx.Client, address: str) -> None:
    problem(client.get(address), 422, "invalid-request")


@pytest.mark.parametrize("of", ServiceKind)
def test_a_command_about_the_longest_name_can_be_recorded(of: ServiceKind) -> None:
    eva = Actor(kind=ActorKind.PERSON, id="1", name="Eva")
    command = SetService(actor=eva, of=of, name="x" * 400, in_service=False, reason="why")
    entry = entry_of(command)
    assert len(entry.subject) == LONGEST_SUBJECT
    assert entry.details["name"] == command.name


@pytest.mark.parametrize("body", [b'{"a": "\xff"}', b"[" * 50_000, b'{"a":' * 5_000 + b"1" + b"}" * 5_000])
def test_a_body_that_cannot_be_read_says_what_it_has_to_be(client: httpx.Client, body: bytes) -> None:
    answer = client.post("/api/v1/job-orders", content=body, headers={"Content-Type": "application/json"})
    assert problem(answer, 400, "bad-request")["detail"].startswith("The body cannot be read: it has to be JSON")
