"""Routes of user accounts and API keys."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import Header, Response
from pydantic import ConfigDict, Field, StrictInt, model_validator
from sqlalchemy import Connection

from sequence_planner.auth import api_keys, users
from sequence_planner.auth.api_keys import LONGEST_LIFE, LONGEST_OVERLAP, Key
from sequence_planner.auth.passwords import (
    LONGEST as LONGEST_PASSWORD,
)
from sequence_planner.auth.passwords import (
    SHORTEST as SHORTEST_PASSWORD,
)
from sequence_planner.auth.passwords import (
    check_password,
)
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.sessions import end_sessions_of, live_counts
from sequence_planner.auth.users import Person
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, AnswerModel, Body, Identifier, Identity, Name
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.texts.message import message

# Keys, with which other systems read the station. A secret is answered once, when it is made.

ADMINISTRATOR = allowed(Role.ADMINISTRATOR)
keys_bodiless = interface("/api-keys", tags=["api keys"], dependencies=[ADMINISTRATOR])
keys_router = interface("/api-keys", tags=["api keys"], dependencies=[ADMINISTRATOR, JSON_ONLY])


class KeyAnswer(AnswerModel):
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


class KeysAnswer(AnswerModel):
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


class NewKeyAnswer(AnswerModel):
    """A key and its secret, which is shown this once."""

    key: KeyAnswer
    secret: str


@keys_bodiless.get("")
async def list_api_keys(identity: Identity) -> KeysAnswer:
    """All keys, without their secrets."""
    return KeysAnswer(keys=[_key_answer(key) for key in await identity.read(api_keys.all_keys)])


@keys_router.post("", status_code=201)
async def create_api_key(body: KeyBody, identity: Identity, actor: Actor) -> NewKeyAnswer:
    """Make a key. Its secret is answered this once: only a hash of it is kept."""
    now = identity.now()
    secret, key = await identity.write(
        lambda connection: api_keys.make_key(connection, body.name, frozenset(body.scopes), body.days, actor, now),
        by=actor,
    )
    return NewKeyAnswer(key=_key_answer(key), secret=secret)


@keys_router.post("/{key}/rotation", status_code=201, responses=refused(404, 409))
async def rotate_api_key(key: Identifier, body: RotationBody, identity: Identity, actor: Actor) -> NewKeyAnswer:
    """Give a key another secret, answered this once. The present one works for some hours more; one before it ends.

    409 `key-expired` when the key works no more.
    """
    now = identity.now()
    secret, rotated = await identity.write(
        lambda connection: api_keys.rotate_key(connection, key, body.overlap, body.days, actor, now), by=actor
    )
    return NewKeyAnswer(key=_key_answer(rotated), secret=secret)


@keys_bodiless.delete("/{key}", status_code=204, responses=refused(404))
async def revoke_api_key(key: Identifier, identity: Identity, actor: Actor) -> None:
    """Revoke a key: whoever bears it is refused from now on."""
    now = identity.now()
    await identity.write(lambda connection: api_keys.revoke_key(connection, key, actor, now), by=actor)


def _key_answer(key: Key) -> KeyAnswer:
    return KeyAnswer(**key.model_dump())


# The people of the station: who there is, with which role, and the passwords that an administrator gives them.
#
# A change names the revision that was seen (`If-Match`), so that nobody overwrites what another has changed meanwhile.

people_bodiless = interface("/users", tags=["users"], dependencies=[ADMINISTRATOR])
people_router = interface("/users", tags=["users"], dependencies=[ADMINISTRATOR, JSON_ONLY])
# What is too short is told, but refused by `check_password`, in its words.
TOLD = {"minLength": SHORTEST_PASSWORD}
Password = Annotated[str, Field(min_length=1, max_length=LONGEST_PASSWORD, json_schema_extra=TOLD)]
TAGGED: dict[str, Any] = {
    "headers": {
        "ETag": {
            "description": "The revision, as `If-Match` has to name it.",
            "required": True,
            "schema": {"type": "string", "pattern": '^"[0-9]{1,9}"$'},
        }
    }
}
Condition = Annotated[str | None, Header(pattern=r'^(\*|"[0-9]{1,9}")$')]


class PersonAnswer(AnswerModel):
    """A person. `created` is in seconds since the epoch; `sessions` counts those that are open now.

    `revision` is what a change has to name in `If-Match`, in double quotes. `issuer` is the provider with which the
    person signs in, and which says the role; null where the person has a password here.
    """

    id: str
    name: str
    role: Role
    created: float
    disabled: bool
    must_change_password: bool
    revision: int
    issuer: str | None
    sessions: int


class PeopleAnswer(AnswerModel):
    """Everybody, by name."""

    people: list[PersonAnswer]


class PersonBody(Body):
    """A new person, with a password that has to be changed at the first sign-in."""

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"name": "Ada", "role": "operator", "password": "seven quiet engines"}]}
    )
    name: Name
    role: Role
    password: Password


class PersonChangeBody(Body):
    """Changes of a person; fields left out stay as they are."""

    model_config = ConfigDict(json_schema_extra={"minProperties": 1})
    role: Role | None = None
    disabled: bool | None = None

    @model_validator(mode="after")
    def _something(self) -> PersonChangeBody:
        if self.role is None and self.disabled is None:
            raise ValueError("name the role, or whether the person is disabled")
        return self


class TemporaryPasswordBody(Body):
    """A password that the person has to change at the next sign-in."""

    password: Password


@people_bodiless.get("")
async def list_users(identity: Identity) -> PeopleAnswer:
    """Everybody, by name; those who may no longer sign in too."""
    now = identity.now()

    def read(connection: Connection) -> list[PersonAnswer]:
        counts = live_counts(connection, now)
        return [_person_answer(person, counts) for person in users.everybody(connection)]

    return PeopleAnswer(people=await identity.read(read))


@people_router.post("", status_code=201, responses={201: TAGGED, **refused(409)})
async def create_user(body: PersonBody, identity: Identity, actor: Actor, response: Response) -> PersonAnswer:
    """Enter a person, who signs in with the temporary password and then has to choose another."""
    check_password(body.password, body.name)
    hashed = await identity.passwords.hash(body.password)
    now = identity.now()

    def write(connection: Connection) -> PersonAnswer:
        person = users.create(connection, body.name, body.role, hashed, actor, now, temporary=True)
        return _person_answer(person, {})

    return _with_tag(response, await identity.write(write, by=actor))


@people_router.patch("/{person}", responses={200: TAGGED, **refused(404, 409, 412, 428)})
async def change_user(
    person: Identifier,
    body: PersonChangeBody,
    identity: Identity,
    actor: Actor,
    response: Response,
    if_match: Condition = None,
) -> PersonAnswer:
    """Change the role, or whether the person may sign in; either ends all of that person's sessions.

    428 without `If-Match`, which may be `*` for whatever revision there is; 412 `user-changed` when another has
    changed the person meanwhile; 409 `last-administrator` when nobody would be left to administer, or
    `role-from-provider` where that is not for here.
    """
    if if_match is None:
        raise ProblemFound(428, "revision-needed", message("refused.revision-needed.header"))
    revision, now = None if if_match == "*" else int(if_match.strip('"')), identity.now()

    def write(connection: Connection) -> PersonAnswer:
        changed = users.change(connection, person, revision, actor, now, role=body.role, disabled=body.disabled)
        return _person_answer(changed, live_counts(connection, now))

    return _with_tag(response, await identity.write(write, by=actor))


@people_router.put("/{person}/password", status_code=204, responses=refused(404, 409))
async def set_user_password(person: Identifier, body: TemporaryPasswordBody, identity: Identity, actor: Actor) -> None:
    """Give a temporary password; it ends all of that person's sessions.

    409 `no-password-here` where the person signs in with a provider.
    """
    found = await identity.read(lambda connection: users.get_user(connection, person))
    users.check_has_password(found)
    check_password(body.password, found.name)
    hashed = await identity.passwords.hash(body.password)
    now = identity.now()

    def write(connection: Connection) -> None:
        users.set_password(connection, person, hashed, actor, now, temporary=True)

    await identity.write(write, by=actor)


@people_bodiless.delete("/{person}/sessions", status_code=204, responses=refused(404))
async def end_user_sessions(person: Identifier, identity: Identity, actor: Actor) -> None:
    """Sign the person out everywhere."""
    now = identity.now()
    await identity.write(lambda connection: end_sessions_of(connection, person, actor, now), by=actor)


def _person_answer(person: Person, sessions: dict[str, int]) -> PersonAnswer:
    return PersonAnswer(**person.model_dump(), sessions=sessions.get(person.id, 0))


def _with_tag(response: Response, answer: PersonAnswer) -> PersonAnswer:
    response.headers["ETag"] = f'"{answer.revision}"'
    return answer
