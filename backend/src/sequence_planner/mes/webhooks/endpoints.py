"""Webhook endpoints in the database: subscribed events, sealed secrets and Standard Webhooks signatures."""

from __future__ import annotations

import base64
import hmac
import os
import secrets
from collections.abc import Collection
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit

from sqlalchemy import Connection, RowMapping, delete, func, insert, select

from sequence_planner.auth.tokens import clean_name, is_id, new_id, record
from sequence_planner.core.actor import Actor
from sequence_planner.core.clock import iso
from sequence_planner.core.data_models import DataModel
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.location import PostgresqlServer, SqliteFile
from sequence_planner.journal import checkpoints as signing_key
from sequence_planner.mes import events
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.order import OrderRefused
from sequence_planner.mes.webhooks.tables import WEBHOOK_DELIVERIES, WEBHOOKS
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.ciphers.aead import AESGCM

# Secrets of webhooks in the database: sealed, since they must be there to sign, under a key that is not in it.
#
# The key is in a file of this user alone, beside that of SQLite or in this user's state folder. Whoever has only the
# database, or a backup of it, can neither read a secret nor put another in its place (AES-256-GCM, bound to the
# webhook's id).

_KEY_SIZE: Final = 32  # bytes
_NONCE_SIZE: Final = 12


class UnreadableSecretError(Exception):
    """A secret cannot be read, as its key is not the one that it was sealed with."""


def key_file(place: SqliteFile | PostgresqlServer) -> Path:
    """Return where the key is."""
    checkpoints = signing_key.key_file(place)
    return checkpoints.with_name(checkpoints.name.replace("checkpoint-key", "webhook-key").replace(".pem", ".key"))


class Seal:
    """Seals and opens with the key in a file, which is made with the first secret."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def seal(self, secret: str, webhook: str) -> str:
        """A secret as it is stored. Raises `StorageError` when there is no key and none can be made."""
        nonce = os.urandom(_NONCE_SIZE)
        return base64.b64encode(
            nonce + self._cipher(make=True).encrypt(nonce, secret.encode(), webhook.encode())
        ).decode()

    def open(self, sealed: str, webhook: str) -> str:
        """The secret. Raises `UnreadableSecretError`, and `StorageError` when the file cannot be read."""
        from cryptography.exceptions import InvalidTag  # noqa: PLC0415 - see above

        stored = base64.b64decode(sealed)
        if not self._file.exists():
            raise UnreadableSecretError(f"{self._file} is not there, with which its secret was sealed")
        try:
            opened = self._cipher().decrypt(stored[:_NONCE_SIZE], stored[_NONCE_SIZE:], webhook.encode())
        except InvalidTag:
            raise UnreadableSecretError(f"its secret was sealed with another key than that in {self._file}") from None
        return opened.decode()

    def _cipher(self, *, make: bool = False) -> AESGCM:
        from cryptography.hazmat.primitives.ciphers.aead import AESGCM  # noqa: PLC0415 - see above

        try:
            if make and not self._file.exists():
                _make(self._file)
            key = self._file.read_bytes()
        except OSError as error:
            raise StorageError(
                f"{self._file}, the key of webhooks' secrets, cannot be used: {error.strerror}"
            ) from error
        if len(key) != _KEY_SIZE:
            raise StorageError(f"{self._file} holds no key of webhooks' secrets: put the right one in its place")
        return AESGCM(key)


def _make(file: Path) -> None:
    """Write a new key, whole or not at all; of several that do so at once the first wins."""
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    new = file.with_name(f"{file.name}.{os.getpid()}.{os.urandom(4).hex()}")
    descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
    try:
        with os.fdopen(descriptor, "wb") as opened:
            opened.write(os.urandom(_KEY_SIZE))
            opened.flush()
            os.fsync(opened.fileno())
        try:
            os.link(new, file)
        except FileExistsError:
            return
    finally:
        new.unlink()


# How a delivery says that it comes from this station and is new: the signature of Standard Webhooks.
#
# `webhook-signature` is `v1,` and the HMAC-SHA256, in base64, of the text `ID.TIMESTAMP.BODY` under the webhook's
# secret, of which the part after `whsec_` is the key in base64. A receiver refuses what is signed otherwise, what is
# older than its replay window, and does nothing for an id that it has seen. See standardwebhooks.com.

ID_HEADER, TIMESTAMP, SIGNATURE = "webhook-id", "webhook-timestamp", "webhook-signature"
PREFIX: Final = "whsec_"


def new_secret() -> str:
    """A secret of 32 random bytes."""
    return PREFIX + base64.b64encode(secrets.token_bytes(32)).decode()


def signed(secret: str, id: str, now: float, body: bytes) -> dict[str, str]:
    """The headers that sign a body which is sent now."""
    key, stamp = base64.b64decode(secret.removeprefix(PREFIX)), str(int(now))
    mac = hmac.new(key, f"{id}.{stamp}.".encode() + body, sha256).digest()
    return {ID_HEADER: id, TIMESTAMP: stamp, SIGNATURE: f"v1,{base64.b64encode(mac).decode()}"}


# Webhooks in the database: who is told of which events.
#
# Each change is one transaction, with the record of who did it.

MOST_WEBHOOKS: Final = 20


class Webhook(DataModel):
    """Who is told, without the secret.

    Events up to `position` were delivered, or wait, or were given up; `waiting` and `given_up` say how many. `failures`
    counts attempts since the last delivery, after which nothing is sent before `held_until`; `trouble` is what went
    wrong in the last of them. No `kinds` are all kinds of events.
    """

    id: str
    title: str
    url: str
    kinds: tuple[EventKind, ...]
    created: float
    created_at = iso("created")
    created_by: str
    position: int
    delivered: int
    last_delivered: float | None
    last_delivered_at = iso("last_delivered", optional=True)
    waiting: int
    given_up: int
    failures: int
    held_until: float
    held_until_at = iso("held_until")
    trouble: str | None


def make(
    connection: Connection,
    seal: Seal,
    title: str,
    url: str,
    kinds: Collection[EventKind],
    after: int | None,
    by: Actor,
    now: float,
) -> tuple[str, Webhook]:
    """A new webhook, told of the events after that one (None: after the last that there is), and its secret.

    `url` must be one that may be sent to. Raises `OrderRefused` (`too-many-webhooks`, 409; `events-gone`, 410), and
    `IdentityRefused` (`invalid-name`, 422).
    """
    if (connection.execute(select(func.count()).select_from(WEBHOOKS)).scalar_one()) >= MOST_WEBHOOKS:
        raise OrderRefused("too-many-webhooks", message("refused.too-many-webhooks.most", most=MOST_WEBHOOKS))
    if after is not None:
        events.require_kept(connection, after)
    id, secret, last = new_id(), new_secret(), events.last(connection)
    asked = " ".join(each for each in EventKind if each in kinds)
    row = {
        "id": id,
        "title": clean_name(title),
        "url": url,
        "kinds": asked,
        "secret": seal.seal(secret, id),
        "created": now,
        "created_by": by.name,
        "position": last if after is None else min(after, last),
        "delivered": 0,
        "failures": 0,
        "held_until": 0.0,
    }
    connection.execute(insert(WEBHOOKS), row)
    record(connection, by, "webhook-created", f"webhook {row['title']}", now, id=id, to=_host(url), kinds=asked)
    return secret, get(connection, id)


def get(connection: Connection, id: str) -> Webhook:
    """The webhook with this id. Raises `OrderRefused` (`no-webhook`, 404)."""
    row = connection.execute(select(WEBHOOKS).where(WEBHOOKS.c.id == id)).mappings().first() if is_id(id) else None
    if row is None:
        raise OrderRefused("no-webhook", message("refused.no-webhook.id"), 404)
    return _webhook(row, _counts(connection))


def everyone(connection: Connection) -> list[Webhook]:
    """All webhooks, the newest first."""
    counts = _counts(connection)
    rows = connection.execute(select(WEBHOOKS).order_by(WEBHOOKS.c.created.desc(), WEBHOOKS.c.id)).mappings()
    return [_webhook(row, counts) for row in rows]


def remove(connection: Connection, id: str, by: Actor, now: float) -> None:
    """Tell it of nothing more; what waits for it goes. Raises `OrderRefused` (`no-webhook`, 404)."""
    webhook = get(connection, id)
    connection.execute(delete(WEBHOOK_DELIVERIES).where(WEBHOOK_DELIVERIES.c.webhook == id))
    connection.execute(delete(WEBHOOKS).where(WEBHOOKS.c.id == id))
    left = webhook.waiting + webhook.given_up
    to = _host(webhook.url)
    record(connection, by, "webhook-deleted", f"webhook {webhook.title}", now, id=id, to=to, undelivered=left)


def _host(url: str) -> str:
    """All that the journal has of a URL: more people read that than webhooks, and a path or a query may be a secret."""
    return urlsplit(url).netloc


def _counts(connection: Connection) -> dict[tuple[str, bool], int]:
    """Return how many events wait for each webhook, and how many were given up."""
    given_up = WEBHOOK_DELIVERIES.c.died.is_not(None)
    grouped = select(WEBHOOK_DELIVERIES.c.webhook, given_up, func.count()).group_by(
        WEBHOOK_DELIVERIES.c.webhook, given_up
    )
    return {(id, bool(dead)): count for id, dead, count in connection.execute(grouped)}


def _webhook(row: RowMapping, counts: dict[tuple[str, bool], int]) -> Webhook:
    shown = {name: value for name, value in row.items() if name != "secret"}
    return Webhook.model_validate(
        {
            **shown,
            "kinds": tuple(row["kinds"].split()),
            "waiting": counts.get((row["id"], False), 0),
            "given_up": counts.get((row["id"], True), 0),
        }
    )
