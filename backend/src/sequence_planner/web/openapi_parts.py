"""What the OpenAPI document says beside its routes: what the tags mean, what is sent to others, what WebSockets say."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from pydantic import BaseModel

from sequence_planner.mes.webhooks import signing

CONTACT: Final = {"name": "Whoever runs this station"}
SERVERS: Final = [{"url": "/", "description": "The station that this document was read from."}]
TAGS: Final[dict[str, str]] = {
    "abilities": "Trying an ability by itself.",
    "actions": "Tasks for people, work by order, production, and what devices are told in place of a person.",
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
    "keys": "Keys for other systems.",
    "model": "The model: reading, editing, checking and deploying it.",
    "modes": "The mode of the station, and production.",
    "people": "Who may sign in, and with which role.",
    "pipelines": "How messages become variables, and variables messages.",
    "restart": "Ways back after something went wrong.",
    "ros": "The network of ROS 2 that the station is on.",
    "session": "Signing in and out.",
    "station": "How the station stands now.",
    "watches": "Watches of operators.",
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
                {"name": signing.ID, **_header("`event-` and the number of the event.", pattern="^event-[0-9]+$")},
                {"name": signing.TIMESTAMP, **_header("When it was sent, in whole seconds.", pattern="^[0-9]+$")},
                {
                    "name": signing.SIGNATURE,
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
    """What is said over WebSockets, which OpenAPI has no words for: of each path the models of what the server sends
    and takes.
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
