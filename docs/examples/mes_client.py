"""A client of a station's job orders, for a MES to begin from. It needs Python 3.11 and nothing else.

What has got no answer is sent again: an order with its `Idempotency-Key`, so that it is stored once; a command only
after a look at the order. Events are read on from the number of the last one.

    mes = Mes("https://station.example", os.environ["STATION_KEY"])
    mes.order("engine-4711", "truck_engine", priority=5, due=time.time() + 3600)
    for event in mes.events():
        print(event["kind"], event["job_order"])
"""

from __future__ import annotations

import base64
import hmac
import json
import time
import urllib.error
import urllib.request
from collections.abc import Iterator, Mapping
from hashlib import sha256
from typing import Any
from urllib.parse import quote

REPLAY_WINDOW = 300.0  # seconds by which the time stamp of a webhook may differ from the clock here


class Refused(Exception):
    """The station says no: `type` is what a program decides by, the text is for people."""

    def __init__(self, status: int, problem: Mapping[str, Any]) -> None:
        super().__init__(f"{problem.get('title', status)}: {problem.get('detail', '')}")
        self.status = status
        self.type = str(problem.get("type", ""))
        self.problem = problem


class Mes:
    """Speaks to the station at `address` with a key that has the scopes `orders-read` and `orders-write`.

    `last` is the number of the last event that was read: keep it, and nothing is missed or read twice. While the
    station is away what is asked is tried again for `patience` seconds; then `OSError` is raised.
    """

    def __init__(self, address: str, key: str = "", *, last: int = 0, patience: float = 120.0) -> None:
        self.last = last
        self.headers = {"Authorization": f"Bearer {key}"} if key else {}
        self._root = f"{address.rstrip('/')}/api/v1/"
        self._patience = patience

    def order(self, id: str, work_master: str, *, start: bool = True, **content: object) -> dict[str, Any]:
        """Store an order, and let it start. `content`: priority, due, earliest, description."""
        body = {"id": id, "work_master": work_master, "start": start, **content}
        return dict(self.ask("POST", "job-orders", body, {"Idempotency-Key": f"order-{id}"}))

    def change(self, id: str, **content: object) -> dict[str, Any]:
        """Change an order that has not begun. Raises `Refused` (409 `job-order-started`) when it has."""
        while True:
            found = self.get(id)
            body = {name: found[name] for name in ("work_master", "description", "priority", "due", "earliest")}
            try:
                revision = {"If-Match": f'"{found["revision"]}"'}
                return dict(self.ask("PUT", f"job-orders/{quote(id)}", body | content, revision))
            except Refused as refused:
                if refused.type != "/problems/job-order-changed":  # by the station meanwhile
                    raise

    def command(self, id: str, command: str, reason: str) -> dict[str, Any]:
        """Start, RevokeStart, Pause, Resume, Stop, Abort, Cancel or Clear. Raises `Refused`; `allowed` is what it
        allows."""
        body = {"command": command, "reason": reason}
        return dict(self.ask("POST", f"job-orders/{quote(id)}/commands", body))

    def get(self, id: str) -> dict[str, Any]:
        """An order, its state and what it waits for."""
        return dict(self.ask("GET", f"job-orders/{quote(id)}"))

    def response(self, id: str) -> dict[str, Any]:
        """What was made of an order that is over."""
        return dict(self.ask("GET", f"job-responses/{quote(id)}"))

    def events(self) -> Iterator[dict[str, Any]]:
        """What has happened since the last event that was read, up to now."""
        while found := self.ask("GET", f"events?after={self.last}&limit=200")["events"]:
            for event in found:
                yield event
                self.last = event["number"]  # only now: what was not worked on is read again

    def ask(self, method: str, path: str, body: object = None, headers: Mapping[str, str] | None = None) -> Any:
        """The answer to a request, which is sent again while the station is away. Raises `Refused` and `OSError`."""
        end, pause = time.monotonic() + self._patience, 0.25
        while True:
            try:
                with self.open(method, path, body, headers) as answer:
                    text = answer.read()
                    return json.loads(text) if text else None
            except urllib.error.HTTPError as error:
                with error:
                    refused = Refused(error.code, _problem(error.read()))
                if error.code < 500 or time.monotonic() > end:
                    raise refused from None
            except (OSError, json.JSONDecodeError):
                if time.monotonic() > end:
                    raise
            time.sleep(pause)
            pause = min(2 * pause, 10.0)

    def open(self, method: str, path: str, body: object = None, headers: Mapping[str, str] | None = None) -> Any:
        """The answer as it comes, once."""
        data = None if body is None else json.dumps(body).encode()
        kind = {} if body is None else {"Content-Type": "application/json"}
        request = urllib.request.Request(
            self._root + path, data, {**self.headers, **kind, **(headers or {})}, method=method
        )
        return urllib.request.urlopen(request, timeout=15)


def _problem(text: bytes) -> Mapping[str, Any]:
    try:
        found = json.loads(text)
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def verified(secret: str, headers: Mapping[str, str], body: bytes, now: float | None = None) -> dict[str, Any]:
    """The event of a webhook. Raises `ValueError` unless the station has signed it, lately.

    The same event may come again: it has the same `webhook-id`, and is to be worked on once.
    """
    given = {name.lower(): value for name, value in headers.items()}
    stamp, id = given.get("webhook-timestamp", ""), given.get("webhook-id", "")
    if not stamp.isdecimal() or abs((time.time() if now is None else now) - int(stamp)) > REPLAY_WINDOW:
        raise ValueError("it is too old, or the clocks differ")
    key = base64.b64decode(secret.removeprefix("whsec_"))
    mac = base64.b64encode(hmac.new(key, f"{id}.{stamp}.".encode() + body, sha256).digest()).decode()
    signatures = given.get("webhook-signature", "").split()
    if not any(hmac.compare_digest(f"v1,{mac}".encode(), each.encode()) for each in signatures):
        raise ValueError("it is not signed with this secret")
    event: dict[str, Any] = json.loads(body)
    return event
