"""The server process: binds its port, then serves until it is told to stop.

The port is bound before anything else is built, so that a port that is taken is said at once and in plain words.
"""

from __future__ import annotations

import sys

import uvicorn

from sequence_planner.web.app import create_app
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.settings import Settings, SettingsError, bind

LARGEST_FRAME = 1024 * 1024  # bytes; up to here the stream explains what is wrong, beyond the connection is closed


def uvicorn_config(settings: Settings) -> uvicorn.Config:
    """How uvicorn serves the station."""
    return uvicorn.Config(
        create_app(settings, ControllerClient(settings.controller_socket)),
        ws="websockets-sansio",
        ws_max_size=LARGEST_FRAME,
        ws_per_message_deflate=False,  # nothing to gain on the loopback
        proxy_headers=False,
        server_header=False,
        access_log=False,
        log_level="warning",
        timeout_graceful_shutdown=2,
    )


def serve(settings: Settings) -> None:
    """Serve until SIGTERM or SIGINT. Exits with code 2 and a message when host or port cannot be used."""
    try:
        listener = bind(settings.host, settings.port)
    except SettingsError as refused:
        sys.stderr.write(f"{refused}\n")
        raise SystemExit(2) from refused
    uvicorn.Server(uvicorn_config(settings)).run(sockets=[listener])
