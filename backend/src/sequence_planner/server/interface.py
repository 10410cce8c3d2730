"""Router factory of the REST interface: common prefix, documented error statuses and headers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fastapi import APIRouter, params
from fastapi.routing import APIRoute

from sequence_planner.server.auth import Access
from sequence_planner.server.errors import MEDIA_TYPE
from sequence_planner.server.http.middleware import READING

# With which status each operation of the OpenAPI document may refuse, and the headers that come with a refusal.
#
# What follows from how a route is declared is found here: who may use it, its method, its parameters, its body. What is
# its own it declares in its `responses`, with `problems.refused`. `default` remains for what concerns no operation,
# such as a request that means another host, and for errors of the server itself.

CONTENT = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
# 422 too, or FastAPI describes one of its own there.
PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    status: {"description": "A problem", "content": CONTENT} for status in ("default", 422)
}
HEADERS: dict[int, dict[str, Any]] = {
    401: {
        "WWW-Authenticate": {"description": "The scheme of keys.", "required": True, "schema": {"const": "Bearer"}},
    },
    429: {
        "Retry-After": {
            "description": "The seconds after which it may be tried again.",
            "required": True,
            "schema": {"type": "integer", "minimum": 1},
        },
    },
}
OF_BODIES = (400, 408, 413, 415, 422)


def describe_refusals(components: dict[str, Any], operation: dict[str, Any], method: str, access: Access) -> None:
    """Complete the `responses` of an operation; each refusal is one of the `components`, for all operations alike."""
    described = operation["responses"]
    own = {int(status) for status in described if status.startswith(("4", "5")) and status != "422"}
    shared = components.setdefault("responses", {})
    for status in sorted(own | _of_all(operation, method, access)):
        name = f"Problem{status}"
        headers = {"headers": HEADERS[status]} if status in HEADERS else {}
        shared[name] = {"description": "A problem", "content": CONTENT, **headers}
        described[str(status)] = {"$ref": f"#/components/responses/{name}"}
    if "requestBody" not in operation and "parameters" not in operation:
        described.pop("422", None)


def _of_all(operation: dict[str, Any], method: str, access: Access) -> set[int]:
    """With which status operations of this kind may refuse."""
    found = {431}  # of a head that is too large
    if not access.public:
        found |= {401, 403, 503}  # 503: the database does not answer, or the controller is silent
    if method.upper() not in READING:
        found.add(403)  # sent by a foreign page
    if "requestBody" in operation:
        found.update(OF_BODIES)
    if "parameters" in operation:
        found.add(422)
    return found


# Where routes are declared: with their whole address and all that they have in common.
#
# So the application takes them as they are. Routes that it included under a prefix would each be made once more by
# FastAPI, which took longer than all else of making the application.

PREFIX = "/api/v1"


def interface(
    prefix: str = "",
    *,
    tags: Sequence[str] = (),
    dependencies: Sequence[params.Depends] = (),
    responses: dict[int | str, dict[str, Any]] | None = None,
) -> APIRouter:
    """Routes of the interface for programs."""
    return beside_interface(PREFIX + prefix, tags=tags, dependencies=dependencies, responses=responses)


def beside_interface(
    prefix: str = "",
    *,
    tags: Sequence[str] = (),
    dependencies: Sequence[params.Depends] = (),
    responses: dict[int | str, dict[str, Any]] | None = None,
) -> APIRouter:
    """Routes with an address of their own."""
    return APIRouter(
        prefix=prefix,
        tags=list(tags),
        dependencies=dependencies,
        responses={**PROBLEM_RESPONSES, **(responses or {})},
        redirect_slashes=False,
        generate_unique_id_function=_operation,
    )


def _operation(route: APIRoute) -> str:
    """Return what generated clients call the operation of a route: the name of its function, which no other one has."""
    return route.name
