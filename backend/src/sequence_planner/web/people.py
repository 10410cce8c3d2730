"""The people of the station: who there is, with which role, and the passwords that an administrator gives them.

A change names the revision that was seen (`If-Match`), so that nobody overwrites what another has changed meanwhile.
"""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import Header, Response
from pydantic import BaseModel, ConfigDict, Field, model_validator
from sqlalchemy import Connection

from sequence_planner.identity import people
from sequence_planner.identity.passwords import LONGEST as LONGEST_PASSWORD
from sequence_planner.identity.passwords import SHORTEST as SHORTEST_PASSWORD
from sequence_planner.identity.passwords import check_password
from sequence_planner.identity.people import Person
from sequence_planner.identity.roles import Role
from sequence_planner.identity.sessions import end_sessions_of, live_counts
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Identifier, Name
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Identity

ADMINISTRATOR = allowed(Role.ADMINISTRATOR)
bodiless = interface("/people", tags=["people"], dependencies=[ADMINISTRATOR])
router = interface("/people", tags=["people"], dependencies=[ADMINISTRATOR, JSON_ONLY])
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


class PersonAnswer(BaseModel):
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


class PeopleAnswer(BaseModel):
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
    """What is to change; what is left out stays as it is."""

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


@bodiless.get("")
async def everybody(identity: Identity) -> PeopleAnswer:
    """Everybody, by name; those who may no longer sign in too."""
    now = identity.now()

    def read(connection: Connection) -> list[PersonAnswer]:
        counts = live_counts(connection, now)
        return [_answered(person, counts) for person in people.everybody(connection)]

    return PeopleAnswer(people=await identity.read(read))


@router.post("", status_code=201, responses={201: TAGGED, **refused(409)})
async def create_person(body: PersonBody, identity: Identity, actor: Actor, response: Response) -> PersonAnswer:
    """Enter a person, who signs in with the temporary password and then has to choose another."""
    check_password(body.password, body.name)
    hashed = await identity.passwords.hash(body.password)
    now = identity.now()

    def write(connection: Connection) -> PersonAnswer:
        person = people.create(connection, body.name, body.role, hashed, actor, now, temporary=True)
        return _answered(person, {})

    return _with_tag(response, await identity.write(write, by=actor))


@router.patch("/{person}", responses={200: TAGGED, **refused(404, 409, 412, 428)})
async def change_person(
    person: Identifier,
    body: PersonChangeBody,
    identity: Identity,
    actor: Actor,
    response: Response,
    if_match: Condition = None,
) -> PersonAnswer:
    """Change the role, or whether the person may sign in; either ends all of that person's sessions.

    428 without `If-Match`, which may be `*` for whatever revision there is; 412 `person-changed` when another has
    changed the person meanwhile; 409 `last-administrator` when nobody would be left to administer, or
    `role-from-provider` where that is not for here.
    """
    if if_match is None:
        detail = "Name the revision that you saw in the header If-Match, in double quotes."
        raise ProblemFound(428, "revision-needed", "Which revision was seen is not said", detail)
    revision, now = None if if_match == "*" else int(if_match.strip('"')), identity.now()

    def write(connection: Connection) -> PersonAnswer:
        changed = people.change(connection, person, revision, actor, now, role=body.role, disabled=body.disabled)
        return _answered(changed, live_counts(connection, now))

    return _with_tag(response, await identity.write(write, by=actor))


@router.put("/{person}/password", status_code=204, responses=refused(404, 409))
async def give_password(person: Identifier, body: TemporaryPasswordBody, identity: Identity, actor: Actor) -> None:
    """Give a temporary password; it ends all of that person's sessions.

    409 `no-password-here` where the person signs in with a provider.
    """
    found = await identity.read(lambda connection: people.known(connection, person))
    people.check_has_password(found)
    check_password(body.password, found.name)
    hashed = await identity.passwords.hash(body.password)
    now = identity.now()

    def write(connection: Connection) -> None:
        people.set_password(connection, person, hashed, actor, now, temporary=True)

    await identity.write(write, by=actor)


@bodiless.delete("/{person}/sessions", status_code=204, responses=refused(404))
async def end_sessions(person: Identifier, identity: Identity, actor: Actor) -> None:
    """Sign the person out everywhere."""
    now = identity.now()
    await identity.write(lambda connection: end_sessions_of(connection, person, actor, now), by=actor)


def _answered(person: Person, sessions: dict[str, int]) -> PersonAnswer:
    return PersonAnswer(**person.model_dump(), sessions=sessions.get(person.id, 0))


def _with_tag(response: Response, answer: PersonAnswer) -> PersonAnswer:
    response.headers["ETag"] = f'"{answer.revision}"'
    return answer
