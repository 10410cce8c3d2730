"""The OpenAPI document, from which other programs and the page's TypeScript types are made.

FastAPI describes the REST routes; this adds what it cannot know: the messages of the WebSocket as components, and
that every refusal is a problem document.
"""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic.json_schema import models_json_schema

from sequence_planner.web.looking_messages import FlowsStreamMessage, NetworkStreamMessage
from sequence_planner.web.problems import MEDIA_TYPE, Problem
from sequence_planner.web.stream_messages import ClientMessage, StreamMessage

REFERENCE = "#/components/schemas/{model}"
PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    status: {
        "description": "A problem",
        "content": {MEDIA_TYPE: {"schema": {"$ref": REFERENCE.format(model="Problem")}}},
    }
    for status in ("default", 422)  # 422 too, or FastAPI describes one of its own there
}


def describe(app: FastAPI) -> dict[str, Any]:
    """The document of `app`, with the components of the stream and of problems."""
    document = get_openapi(title=app.title, version=app.version, description=app.description, routes=app.routes)
    _, definitions = models_json_schema(
        [
            (StreamMessage, "serialization"),
            (NetworkStreamMessage, "serialization"),
            (FlowsStreamMessage, "serialization"),
            (ClientMessage, "validation"),
            (Problem, "serialization"),
        ],
        ref_template=REFERENCE,
    )
    components = document.setdefault("components", {}).setdefault("schemas", {})
    components.update(definitions["$defs"])
    return document
