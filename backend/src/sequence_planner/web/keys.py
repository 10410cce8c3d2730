"""Keys, with which other systems read the station. A secret is answered once, when it is made."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field, StrictInt

from sequence_planner.identity import keys
from sequence_planner.identity.keys import LONGEST_LIFE, LONGEST_OVERLAP, Key
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Identifier, Name
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Identity

ADMINISTRATOR = allowed(Role.ADMINISTRATOR)
bodiless = interface("/keys", tags=["keys"], dependencies=[ADMINISTRATOR])
router = interface("/keys", tags=["keys"], dependencies=[ADMINISTRATOR, JSON_ONLY])


class KeyAnswer(BaseModel):
    """A key without its secret. Times are in seconds since the epoch; `created_by` is the person's name.

    `former_until` is when the secret before the last rotation works no more; null without a rotation.
    """

    id: str
    name: str
    scopes: list[Scope]
    created: float
    created_by: str
    expires: float
    last_used: float | None
    revoked: float | None
    former_until: float | None


class KeysAnswer(BaseModel):
    """All keys, the newest first; those that work no more are among them for 90 days."""

    keys: list[KeyAnswer]


class KeyBody(Body):
    """A new key: what its bearer may do, and for how many days."""

    name: Name
    scopes: Annotated[list[Scope], Field(min_length=1)]
    days: Annotated[StrictInt, Field(ge=1, le=LONGEST_LIFE)]


class RotationBody(Body):
    """For how many hours the present secret works on, and for how many days the key does; null: as long as now."""

    overlap: Annotated[StrictInt, Field(ge=0, le=LONGEST_OVERLAP)]
    days: Annotated[StrictInt, Field(ge=1, le=LONGEST_LIFE)] | None = None


class NewKeyAnswer(BaseModel):
    """A key and its secret, which is shown this once."""

    key: KeyAnswer
    secret: str


@bodiless.get("")
async def all_keys(identity: Identity) -> KeysAnswer:
    """All keys, without their secrets."""
    return KeysAnswer(keys=[_answered(key) for key in await identity.read(keys.all_keys)])


@router.post("", status_code=201)
async def make_key(body: KeyBody, identity: Identity, actor: Actor) -> NewKeyAnswer:
    """Make a key. Its secret is answered this once: only a hash of it is kept."""
    now = identity.now()
    secret, key = await identity.write(
        lambda connection: keys.make_key(connection, body.name, frozenset(body.scopes), body.days, actor, now),
        by=actor,
    )
    return NewKeyAnswer(key=_answered(key), secret=secret)


@router.post("/{key}/rotation", status_code=201, responses=refused(404, 409))
async def rotate_key(key: Identifier, body: RotationBody, identity: Identity, actor: Actor) -> NewKeyAnswer:
    """Give a key another secret, answered this once. The present one works for some hours more; one before it ends.

    409 `key-over` when the key works no more.
    """
    now = identity.now()
    secret, rotated = await identity.write(
        lambda connection: keys.rotate_key(connection, key, body.overlap, body.days, actor, now), by=actor
    )
    return NewKeyAnswer(key=_answered(rotated), secret=secret)


@bodiless.delete("/{key}", status_code=204, responses=refused(404))
async def revoke_key(key: Identifier, identity: Identity, actor: Actor) -> None:
    """Revoke a key: whoever bears it is refused from now on."""
    now = identity.now()
    await identity.write(lambda connection: keys.revoke_key(connection, key, actor, now), by=actor)


def _answered(key: Key) -> KeyAnswer:
    return KeyAnswer(**key.model_dump())
