"""What a person who starts a station is told: where it is opened, and how the first administrator gets in."""

from __future__ import annotations

import contextlib
import http.client
import sys
import time
from pathlib import Path

from sequence_planner.identity.first_start import new_link_token
from sequence_planner.identity.people import administrator_exists
from sequence_planner.storage.database import Database, StorageError
from sequence_planner.web.certificate import trusting_context
from sequence_planner.web.settings import Endpoint, address_of

PATIENCE = 1.0  # seconds for an answer
TO_ITSELF = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # how this machine reaches what listens on all its addresses


UNWELL = 503  # what /healthz answers while the controller is not heard


def health(endpoint: Endpoint) -> int | None:
    """With which status `endpoint` answers whether it is alive: it may be for its proxy only. None without an answer.

    Over HTTPS it must be the endpoint's own certificate; nobody else needs to trust that here.
    """
    host = str(address_of(endpoint.host))
    host, port = TO_ITSELF.get(host, host), endpoint.port
    if endpoint.certificate is None:
        asking = http.client.HTTPConnection(host, port, timeout=PATIENCE)
    else:
        context = trusting_context(endpoint.certificate)
        asking = http.client.HTTPSConnection(host, port, timeout=PATIENCE, context=context)
    with contextlib.closing(asking):
        try:
            asking.request("GET", "/healthz")
            return asking.getresponse().status
        except (OSError, http.client.HTTPException):
            return None


def announced(endpoint: Endpoint, model: Path) -> str:
    """Where the station in the folder `model` is opened."""
    return f"{model} runs: open {endpoint.address} (operator's watch: {endpoint.address}/watch)"


def first_start(database: str, endpoint: Endpoint, model: Path) -> str | None:
    """How the first administrator gets in, None when there is one already.

    The link is a secret for whoever sits at the terminal; where there is none the output is kept somewhere, such as in
    a journal that others read, and then it is only said how to get it.
    """
    try:
        with contextlib.closing(Database.open(database)) as opened, opened.writing() as connection:
            if administrator_exists(connection):
                return None
            token = new_link_token(connection, time.time()) if sys.stdout.isatty() else None
    except StorageError as error:
        return str(error)
    if token is None:
        how = f"sequence-planner people link {model} --url {endpoint.address}"
        return (
            f"nobody can sign in yet: in a terminal, with the same database, `{how}` prints the link for the first "
            "administrator"
        )
    return f"the first administrator opens, once and within 15 minutes: {endpoint.address}/first-start#{token}"
