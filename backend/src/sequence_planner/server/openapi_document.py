"""The OpenAPI document: generation, tag descriptions, webhooks and WebSocket documentation."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any, Final

from fastapi import FastAPI, Request
from fastapi.encoders import jsonable_encoder
from fastapi.openapi.models import Schema
from fastapi.openapi.utils import get_openapi
from fastapi.responses import JSONResponse, Response
from fastapi.routing import iter_route_contexts
from pydantic import BaseModel
from pydantic.json_schema import JsonSchemaMode, models_json_schema
from starlette.concurrency import run_in_threadpool

from sequence_planner.auth.roles import Role
from sequence_planner.editor.draft import ChangeBody
from sequence_planner.editor.pipelines.schemas import Preview
from sequence_planner.mes.webhooks import endpoints
from sequence_planner.server.api.watches import WatchStreamMessage
from sequence_planner.server.auth import Access, allowed, declared
from sequence_planner.server.errors import Problem
from sequence_planner.server.http.credentials import NAME, SESSION_COOKIE, WATCH_COOKIE
from sequence_planner.server.interface import describe_refusals, interface
from sequence_planner.server.stream.messages import (
    FlowsStreamMessage,
    NetworkStreamMessage,
    Resync,
    StreamMessage,
    WorkshopStreamMessage,
)

# What the OpenAPI document says beside its routes: what the tags mean, what is sent to others, what WebSockets say.

CONTACT: Final = {"name": "Whoever runs this station"}
SERVERS: Final = [{"url": "/", "description": "The station that this document was read from."}]
TAGS: Final[dict[str, str]] = {
    "abilities": "Trying an ability by itself.",
    "actions": "Tasks for people, work by order, production, and what devices are told in place of a person.",
    "api keys": "Keys for other systems.",
    "alarms": "What wants a person's attention, and what people do about it.",
    "approvals": "What waits for a second person.",
    "audit": "The record of who did what.",
    "backups": "Copies of the database and the model.",
    "storage": "How much is kept, for how long, and the archive.",
    "control": "Who is in control, and may let devices move.",
    "corrections": "Values that a person knows better than the station.",
    "health": "Whether the server is alive and ready, and its figures.",
    "history": "What has happened at the station.",
    "job orders": "What a MES orders, what became of it, and what has happened: the job control of ISA-95.",
    "model": "The model: reading, editing, checking and deploying it.",
    "modes": "The mode of the station, and production.",
    "pipelines": "How messages become variables, and variables messages.",
    "recovery": "Plans back to work after something went wrong.",
    "ros": "The network of ROS 2 that the station is on.",
    "session": "Signing in and out.",
    "station": "How the station stands now.",
    "wearables": "Devices, such as watches, that show operators their tasks.",
    "users": "Who may sign in, and with which role.",
    "webhooks": "Other systems that are told of events.",
}


def _header(description: str, **schema: object) -> dict[str, Any]:
    return {"in": "header", "required": True, "description": description, "schema": {"type": "string", **schema}}


WEBHOOKS: Final[dict[str, Any]] = {
    "event": {
        "post": {
            "tags": ["webhooks"],
            "operationId": "receive_event",
            "summary": "Receive Event",
            "description": (
                "An event, as `GET /api/v1/events` has it, sent to whoever made a webhook for its kind. It is sent at "
                "least once, and events may come out of order. Refuse what is signed otherwise, and what was sent more "
                "than five minutes ago; ignore kinds that you do not know."
            ),
            "security": [],
            "parameters": [
                {
                    "name": endpoints.ID_HEADER,
                    **_header("`event-` and the number of the event.", pattern="^event-[0-9]+$"),
                },
                {"name": endpoints.TIMESTAMP, **_header("When it was sent, in whole seconds.", pattern="^[0-9]+$")},
                {
                    "name": endpoints.SIGNATURE,
                    **_header(
                        "`v1,` and the HMAC-SHA256, in base64, of id, timestamp and body, divided by dots, under the "
                        "secret of the webhook.",
                        pattern="^v1,",
                    ),
                },
            ],
            "requestBody": {
                "required": True,
                "content": {"application/json": {"schema": {"$ref": "#/components/schemas/JobEvent"}}},
            },
            "responses": {
                "2XX": {"description": "It is taken. Nothing of the body is read."},
                "default": {"description": "It is not taken, and sent again later."},
            },
        }
    }
}


def websockets(sent: Mapping[str, type[BaseModel]], taken: str) -> dict[str, Any]:
    """Return what is said over WebSockets, for which OpenAPI has no words: the models sent and taken by the server, by
    path.
    """
    ref = "#/components/schemas/{}"
    takes = {"$ref": ref.format(taken)}
    return {path: {"sends": {"$ref": ref.format(model.__name__)}, "takes": takes} for path, model in sent.items()}


def complete_arrays(part: object) -> None:
    """Say what the items of arrays of fixed length are, too: readers of before 2020-12 know no `prefixItems`."""
    if isinstance(part, dict):
        items = part.get("prefixItems")
        if items and "items" not in part and all(each == items[0] for each in items):
            part["items"] = items[0]
        for each in part.values():
            complete_arrays(each)
    elif isinstance(part, list):
        for each in part:
            complete_arrays(each)


# The OpenAPI document, from which other programs and the page's TypeScript types are made.
#
# FastAPI describes the REST routes; this adds what it cannot know: the messages of the WebSockets as components, that
# every refusal is a problem document, and who may use a route. `x-role` is the least role of a person, or `public`, or
# `watch` where watches alone may, or `beside` where programs on this machine may; `x-scope` is the scope of a key that
# may too, null where none does.

REFERENCE = "#/components/schemas/{model}"
ON_THE_LOOPBACK = "Over plain HTTP, on the loopback alone, it is called `{name}-` and the server's port."
SCHEMES = {
    "session": {
        "type": "apiKey",
        "in": "cookie",
        "name": SESSION_COOKIE,
        "description": f"What signing in gives. {ON_THE_LOOPBACK.format(name=NAME)}",
    },
    "watch": {
        "type": "apiKey",
        "in": "cookie",
        "name": WATCH_COOKIE,
        "description": f"What pairing gives a watch. {ON_THE_LOOPBACK.format(name=f'{NAME}-watch')}",
    },
    "key": {"type": "http", "scheme": "bearer", "description": "A key for other systems; `x-scope` is what it needs."},
}
# By their paths, the models of what the server says over WebSockets; all take the same.
STREAMS: Final[dict[str, type[BaseModel]]] = {
    "/api/v1/stream": StreamMessage,
    "/api/v1/ros/stream": NetworkStreamMessage,
    "/api/v1/pipelines/stream": FlowsStreamMessage,
    "/api/v1/model/stream": WorkshopStreamMessage,
    "/api/v1/wearables/stream": WatchStreamMessage,
}

_WRITING: Final = threading.Lock()

router = interface()


@router.get("/openapi.json", include_in_schema=False, dependencies=[allowed(Role.VIEWER, any_key=True)])
async def openapi(request: Request) -> Response:
    """The document of this server."""
    return Response(await run_in_threadpool(_written, request.app), media_type="application/json")


def _written(app: FastAPI) -> bytes:
    """The document as it is sent. Made once, beside what else the server does: it takes more than a second."""
    with _WRITING:
        if (known := getattr(app.state, "openapi_document", None)) is None:
            known = app.state.openapi_document = JSONResponse(app.openapi()).body
    return bytes(known)


def describe(app: FastAPI) -> dict[str, Any]:
    """The document of `app`, with the components of the streams and of problems, and who may use what."""
    document = get_openapi(
        title=app.title,
        version=app.version,
        description=app.description,
        routes=app.routes,
        tags=[{"name": name, "description": text} for name, text in TAGS.items()],
        servers=[*SERVERS],
        contact=dict(CONTACT),
    )
    document["webhooks"] = WEBHOOKS
    sent: list[tuple[type[BaseModel], JsonSchemaMode]] = [(each, "serialization") for each in STREAMS.values()]
    _, definitions = models_json_schema(
        [
            *sent,
            (Resync, "validation"),
            (Problem, "serialization"),
        ],
        ref_template=REFERENCE,
    )
    components = document.setdefault("components", {})
    schemas = components.setdefault("schemas", {})
    for name, schema in {**definitions["$defs"], **_of_unread_bodies()}.items():
        if schemas.setdefault(name, schema) != schema:
            raise RuntimeError(f"two models are called {name}, and a program made from the document would know one")
    document["x-websockets"] = websockets(STREAMS, Resync.__name__)
    complete_arrays(schemas)
    components["securitySchemes"] = SCHEMES
    for route in iter_route_contexts(app.routes):
        operations = document["paths"].get(route.path_format, {})
        for method in route.methods or ():
            if method.lower() in operations:
                operation, access = operations[method.lower()], declared(route)
                operation.update(_who(access))
                describe_refusals(components, operation, method, access)
    return document


def _of_unread_bodies() -> dict[str, Any]:
    """The schemas of bodies that FastAPI does not read itself, written as it writes those that it does."""
    _, found = models_json_schema([(ChangeBody, "validation"), (Preview, "validation")], ref_template=REFERENCE)
    return {
        name: jsonable_encoder(Schema.model_validate(schema), by_alias=True, exclude_none=True)
        for name, schema in found["$defs"].items()
    }


def _who(access: Access) -> dict[str, Any]:
    ways = {"session": access.role is not None, "watch": access.watch, "key": access.scope is not None}
    security: list[dict[str, list[str]]] = [{way: []} for way, open_to in ways.items() if open_to]
    security += [{}] if access.beside else []  # nothing is needed on this machine
    scope = None if access.scope is None else access.scope.value
    return {"x-role": access.who, "x-scope": scope, "security": security}
