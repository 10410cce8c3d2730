"""The server process: binds its port, then serves until it is told to stop.

The port is bound and the database opened before anything else is built, so that what cannot be used is said at once and
in plain words.
"""

from __future__ import annotations

import contextlib
import logging
import resource
import ssl
import sys

import uvicorn

from sequence_planner.storage.database import Database, StorageError
from sequence_planner.web.app import create_app
from sequence_planner.web.binding import bind, check_demonstration
from sequence_planner.web.certificate import server_context
from sequence_planner.web.connections import (
    IDLE_SECONDS,
    LARGEST_HEAD,
    MOST_CONNECTIONS,
    PromptConnection,
    ProxiedConnection,
    Stream,
)
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.settings import Endpoint, Settings, SettingsError

LARGEST_FRAME = 1024 * 1024  # bytes; up to here the stream explains what is wrong, beyond the connection is closed
# What uvicorn takes for an error whenever a handshake is refused, though the refusal was sent.
REFUSED_HANDSHAKE = "ASGI callable returned without completing handshake."
OPEN_FILES = 8192  # connections that never finish a TLS handshake are kept for a minute and must not use them up


def uvicorn_config(settings: Settings) -> uvicorn.Config:
    """How uvicorn serves the station. Raises `SettingsError` when its certificate cannot be used."""
    tls = _tls(settings)
    return uvicorn.Config(
        create_app(settings, ControllerClient(settings.controller_socket)),
        http=ProxiedConnection if settings.proxies else PromptConnection,
        ws=Stream,
        ws_max_size=LARGEST_FRAME,
        ws_per_message_deflate=False,  # what is secret and what an attacker chose are not compressed together
        ssl_context_factory=None if tls is None else lambda *_: tls,
        proxy_headers=False,  # `Forwarded` believes one hop only, uvicorn as many as there are known addresses
        server_header=False,
        access_log=False,
        log_config=None,  # its events are written as all others are
        log_level="warning",
        limit_concurrency=MOST_CONNECTIONS + 1,  # beyond, connections are closed at once
        h11_max_incomplete_event_size=LARGEST_HEAD,
        timeout_keep_alive=IDLE_SECONDS,
        timeout_graceful_shutdown=2,
    )


def serve(settings: Settings) -> None:
    """Serve until SIGTERM or SIGINT.

    Exits with code 2 and a message when host, port, certificate or database cannot be used.
    """
    try:
        if settings.demonstration:
            check_demonstration(settings)
        listener = bind(settings)
        with contextlib.closing(Database.open(settings.database)) as database:
            database.upgrade()
        config = uvicorn_config(settings)
    except (SettingsError, StorageError) as refused:
        sys.stderr.write(f"{refused}\n")
        raise SystemExit(2) from refused
    logging.getLogger("uvicorn.error").addFilter(lambda record: record.msg != REFUSED_HANDSHAKE)
    _allow_open_files()
    uvicorn.Server(config).run(sockets=[listener])


def _tls(endpoint: Endpoint) -> ssl.SSLContext | None:
    if endpoint.certificate is None or endpoint.private_key is None:
        return None
    return server_context(endpoint.certificate, endpoint.private_key)


def _allow_open_files() -> None:
    """Let this process have as many files open as it may, up to what connections can need."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = OPEN_FILES if hard == resource.RLIM_INFINITY else min(hard, OPEN_FILES)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
