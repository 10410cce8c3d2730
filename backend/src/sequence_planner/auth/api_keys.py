"""Keys of systems that read from the station. A secret is shown once; only its hash is kept.

A rotation gives a key another secret. The one before works on for a while, so that its system can be given the new one
without a gap, and then ends by itself.
"""

from __future__ import annotations

import re

from sqlalchemy import Connection, Row, insert, select, update

from sequence_planner.auth.roles import IdentityRefused, Scope
from sequence_planner.auth.tables import KEYS
from sequence_planner.auth.tokens import clean_name, hash_of, is_id, new_id, new_token, record, same, short
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.data_models import DataModel
from sequence_planner.texts.message import message

DAY = 86400.0  # seconds
LONGEST_LIFE = 730  # days
LONGEST_OVERLAP = 720  # hours
HOUR = 3600.0  # seconds
KEPT = 90 * DAY  # seconds that a key or a watch which works no more is still listed
NOTED_EVERY = 60.0  # seconds; how exactly it is known when a key was last used
_SECRET = re.compile(r"sp_([0-9a-f]{16})_[0-9A-Za-z_-]{43}")


class Key(DataModel):
    """A key, without its secret. It works until it `expires`, or was `revoked`; `created_by` is a name.

    `former_until` is when the secret before the last rotation works no more; null without a rotation.
    """

    id: str
    name: str
    scopes: tuple[Scope, ...]
    created: float
    created_by: str
    expires: float
    last_used: float | None
    revoked: float | None
    former_until: float | None = None

    def actor(self, address: str) -> Actor:
        """The system that acts with this key, from where the request comes."""
        return Actor(kind=ActorKind.KEY, id=self.id, name=self.name, address=short(address))

    def due(self, now: float) -> bool:
        """Return whether `used` would write."""
        return self.last_used is None or self.last_used <= now - NOTED_EVERY


def make_key(
    connection: Connection, name: str, scopes: frozenset[Scope], days: int, by: Actor, now: float
) -> tuple[str, Key]:
    """A new key and its secret, `sp_<id>_<random>`, which works for so many days (1 to 730).

    Raises `IdentityRefused` (422): `invalid-name`, `no-scope`, `invalid-days`.
    """
    name = clean_name(name)
    _check_days(days)
    if not scopes:
        raise IdentityRefused("no-scope", message("refused.no-scope.say"), 422)
    key = Key(
        id=new_id(),
        name=name,
        scopes=tuple(each for each in Scope if each in scopes),
        created=now,
        created_by=by.name,
        expires=now + days * DAY,
        last_used=None,
        revoked=None,
    )
    secret = f"sp_{key.id}_{new_token()}"
    words = " ".join(key.scopes)
    connection.execute(insert(KEYS).values(**{**key.model_dump(), "scopes": words, "secret_hash": hash_of(secret)}))
    record(connection, by, "key-created", _subject(key), now, id=key.id, scopes=words, expires=key.expires)
    return secret, key


def find_key(connection: Connection, secret: str, now: float) -> Key | None:
    """The key with this secret: none when it is unknown, expired or revoked. One found by the secret before a rotation
    expires with that.
    """
    form = _SECRET.fullmatch(secret)
    if form is None:
        return None
    live = (KEYS.c.id == form[1]) & (KEYS.c.expires > now) & KEYS.c.revoked.is_(None)
    row = connection.execute(select(KEYS).where(live)).first()
    if row is None:
        return None
    hashed, key = hash_of(secret), _key(row)
    if same(row.secret_hash, hashed):
        return key
    is_former = row.former_hash is not None and same(row.former_hash, hashed)
    if not is_former or key.former_until is None or key.former_until <= now:
        return None
    return key.model_copy(update={"expires": min(key.expires, key.former_until)})


def require_live(connection: Connection, by: Actor, now: float) -> None:
    """Raises `IdentityRefused` (`signed-out`, 401) when `by` is a key that has ended since it was let in."""
    if by.kind is not ActorKind.KEY:
        return
    row = _row(connection, by.id)
    if row.revoked is not None or row.expires <= now:
        raise IdentityRefused("signed-out", message("refused.signed-out.key-ended"), 401)


def used(connection: Connection, id: str, now: float) -> None:
    """Note that a key is in use; written at most once a minute."""
    due = KEYS.c.last_used.is_(None) | (KEYS.c.last_used <= now - NOTED_EVERY)
    connection.execute(update(KEYS).where((KEYS.c.id == id) & due).values(last_used=now))


def all_keys(connection: Connection) -> list[Key]:
    """All keys, the newest first; those that work no more are among them for 90 days."""
    return [_key(row) for row in connection.execute(select(KEYS).order_by(KEYS.c.created.desc(), KEYS.c.id))]


def rotate_key(
    connection: Connection, id: str, overlap: float, days: int | None, by: Actor, now: float
) -> tuple[str, Key]:
    """Another secret for a key; the present one works for `overlap` hours more (0 to 720), and one before that no more.

    With `days` the key works for so many from now on, else as long as it would have. Raises `IdentityRefused`: `no-key`
    (404), `key-expired` (409) when it works no more, `invalid-days` and `invalid-overlap` (422).
    """
    row = _row(connection, id)
    if days is not None:
        _check_days(days)
    if not 0 <= overlap <= LONGEST_OVERLAP:
        raise IdentityRefused("invalid-overlap", message("refused.invalid-overlap.hours", longest=LONGEST_OVERLAP), 422)
    if row.revoked is not None or row.expires <= now:
        raise IdentityRefused("key-expired", message("refused.key-expired.another"))
    expires = row.expires if days is None else now + days * DAY
    changes = {"expires": expires, "former_until": min(now + overlap * HOUR, row.expires)}
    key = _key(row).model_copy(update=changes)
    secret = f"sp_{key.id}_{new_token()}"
    values = {**changes, "secret_hash": hash_of(secret), "former_hash": row.secret_hash}
    connection.execute(update(KEYS).where(KEYS.c.id == id).values(**values))
    record(connection, by, "key-rotated", _subject(key), now, id=id, **changes)
    return secret, key


def revoke_key(connection: Connection, id: str, by: Actor, now: float) -> None:
    """Let a key work no more; nothing happens when it was revoked already. Raises `IdentityRefused` (`no-key`, 404)."""
    row = _row(connection, id)
    if row.revoked is None:
        connection.execute(update(KEYS).where(KEYS.c.id == id).values(revoked=now))
        record(connection, by, "key-revoked", _subject(_key(row)), now, id=id)


def _row(connection: Connection, id: str) -> Row[tuple[object, ...]]:
    row = connection.execute(select(KEYS).where(KEYS.c.id == id)).first() if is_id(id) else None
    if row is None:
        raise IdentityRefused("no-key", message("refused.no-key.id"), 404)
    return row


def _check_days(days: int) -> None:
    if not 1 <= days <= LONGEST_LIFE:
        raise IdentityRefused("invalid-days", message("refused.invalid-days.most", longest=LONGEST_LIFE), 422)


def _key(row: Row[tuple[object, ...]]) -> Key:
    return Key(
        id=row.id,
        name=row.name,
        scopes=tuple(Scope(each) for each in row.scopes.split()),
        created=row.created,
        created_by=row.created_by,
        expires=row.expires,
        last_used=row.last_used,
        revoked=row.revoked,
        former_until=row.former_until,
    )


def _subject(key: Key) -> str:
    return f"key {key.name}"
