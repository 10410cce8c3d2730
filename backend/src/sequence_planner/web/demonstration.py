"""Where a demonstration may be opened: at the machine itself, and only as long as all devices are emulated."""

from __future__ import annotations

import ipaddress

from starlette.requests import HTTPConnection

from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.settings import Settings

FORWARDED = ("forwarded", "x-forwarded-for", "x-real-ip")  # somebody stands between: the other end is not the browser


def may_be_demonstration(connection: HTTPConnection, settings: Settings, controller: ControllerClient) -> bool:
    """Whether a demonstration that was opened may go on: nothing speaks against it."""
    is_real = controller.view is not None and not controller.view.station.emulated
    return settings.demonstration and is_beside(connection) and not is_real


def may_open_demonstration(connection: HTTPConnection, settings: Settings, controller: ControllerClient) -> bool:
    """Whether a demonstration may be opened: the controller itself says now that its devices are emulated."""
    is_emulated = controller.heard and controller.view is not None and controller.view.station.emulated
    return is_emulated and may_be_demonstration(connection, settings, controller)


def is_beside(connection: HTTPConnection) -> bool:
    """Whether the other end of the connection is on this machine."""
    if connection.client is None or any(name in connection.headers for name in FORWARDED):
        return False
    try:
        return ipaddress.ip_address(connection.client.host).is_loopback
    except ValueError:
        return False
