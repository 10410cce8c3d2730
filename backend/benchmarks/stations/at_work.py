"""Somebody who has a station work: opens a demonstration, starts production and does what it asks people for."""

from __future__ import annotations

import contextlib
import time

import httpx

_PATIENCE = 60.0  # seconds until production may be started
_LOOK_EVERY = 0.2  # seconds


class Person:
    """At the station whose page is at that port of this machine, a demonstration."""

    def __init__(self, port: int) -> None:
        self._client = httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1/", timeout=10)

    def begin(self) -> None:
        """Start production. Raises TimeoutError."""
        self._client.post("session/demonstration", json={}).raise_for_status()
        self._client.put("control-lock", json={"over": None}).raise_for_status()
        end = time.monotonic() + _PATIENCE
        while not self._client.post("production/start", json={}).is_success:
            if time.monotonic() > end:
                raise TimeoutError("production could not be started")
            time.sleep(_LOOK_EVERY)

    def acknowledge(self) -> None:
        """Acknowledge whatever waits for a person, and take a moment for it."""
        for name, task in self._client.get("tasks").raise_for_status().json()["tasks"].items():
            self._client.post(f"tasks/{name}/acknowledgement", json={"revision": task["revision"]})
        time.sleep(_LOOK_EVERY)

    def completed(self, operation: str) -> int:
        """How often that operation was completed."""
        found: dict[str, dict[str, int]] = self._client.get("operations").raise_for_status().json()["operations"]
        return found[operation]["completed"]

    def leave(self) -> None:
        """Go away."""
        with contextlib.suppress(httpx.HTTPError):
            self._client.close()
