"""What a person who starts a station is told first: where it is opened, as soon as somebody answers there."""

from __future__ import annotations

import contextlib
import http.client
from pathlib import Path

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
