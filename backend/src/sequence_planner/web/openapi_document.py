"""The OpenAPI document, from which other programs and the page's TypeScript types are made.

FastAPI describes the REST routes; this adds what it cannot know: the messages of the WebSockets as components, that
every refusal is a problem document, and who may use a route. `x-role` is the least role of a person, or `public`, or
`watch` where watches alone may, or `beside` where programs on this machine may; `x-scope` is the scope of a key that
may too, null where none does.
"""

from __future__ import annotations

import threading
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

from sequence_planner.identity.roles import Role
from sequence_planner.web.access import Access, allowed, declared
from sequence_planner.web.cookies import NAME, SESSION_COOKIE, WATCH_COOKIE
from sequence_planner.web.interface import interface
from sequence_planner.web.looking_messages import FlowsStreamMessage, NetworkStreamMessage, WorkshopStreamMessage
from sequence_planner.web.openapi_parts import CONTACT, SERVERS, TAGS, WEBHOOKS, complete_arrays, websockets
from sequence_planner.web.openapi_refusals import describe_refusals
from sequence_planner.web.problems import Problem
from sequence_planner.web.stream_messages import Resync, StreamMessage
from sequence_planner.web.watch_messages import WatchStreamMessage
from sequence_planner.workshop.edits import ChangeBody
from sequence_planner.workshop.pipelines.questions import Preview

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
    "/api/v1/watches/stream": WatchStreamMessage,
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
