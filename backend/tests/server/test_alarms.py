"""What people do about alarms over REST: each request is a command with its actor."""

from __future__ import annotations

import httpx
import pytest

from sequence_planner.controller.commands.alarms import (
    LONGEST_SHELVING,
    AcknowledgeAlarm,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from support.server import Controller

from .test_acting import problem

KEY = "message:/arm/state:… is no pose"


def test_each_request_is_a_command_with_its_actor(administrator: httpx.Client, controller: Controller) -> None:
    requests = {
        "acknowledge": {"alarm": KEY, "since": 1700000000.1},
        "shelve": {"alarm": KEY, "seconds": 600, "reason": "it is known"},
        "unshelve": {"alarm": KEY},
        "suppress": {"alarm": KEY, "reason": "the sensor is broken"},
        "restore": {"alarm": KEY, "reason": "it is repaired"},
    }
    for name, body in requests.items():
        assert administrator.post(f"/api/v1/alarms/{name}", json=body).status_code == 204
    actor = controller.commands[0].actor
    assert controller.commands == [
        AcknowledgeAlarm(actor=actor, alarm=KEY, since=1700000000.1),
        ShelveAlarm(actor=actor, alarm=KEY, seconds=600, reason="it is known"),
        UnshelveAlarm(actor=actor, alarm=KEY),
        SuppressAlarm(actor=actor, alarm=KEY, reason="the sensor is broken"),
        RestoreAlarm(actor=actor, alarm=KEY, reason="it is repaired"),
    ]


@pytest.mark.parametrize(
    ("name", "body", "field"),
    [
        ("acknowledge", {"alarm": KEY}, "body.since"),
        ("acknowledge", {"alarm": "", "since": 1}, "body.alarm"),
        ("shelve", {"alarm": KEY, "seconds": LONGEST_SHELVING + 1, "reason": "known"}, "body.seconds"),
        ("shelve", {"alarm": KEY, "seconds": 0, "reason": "known"}, "body.seconds"),
        ("shelve", {"alarm": KEY, "seconds": 60}, "body.reason"),
        ("suppress", {"alarm": KEY, "reason": ""}, "body.reason"),
    ],
)
def test_a_wrong_request_is_told_where_it_is_wrong(
    administrator: httpx.Client, controller: Controller, name: str, body: dict[str, object], field: str
) -> None:
    found = problem(administrator.post(f"/api/v1/alarms/{name}", json=body), 422, "invalid-request")
    assert found["errors"][0]["field"] == field
    assert controller.commands == []
