"""People who may sign in."""

from __future__ import annotations

from sqlalchemy import Connection, Row, delete, func, insert, select, update

from sequence_planner.auth.rate_limit import clear_attempts
from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.auth.tables import LONGEST_KEY, PEOPLE, SESSIONS
from sequence_planner.auth.tokens import (
    UNKNOWN,
    clean_name,
    is_id,
    name_key,
    name_shape,
    new_id,
    record,
    short,
)
from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.core.data_models import DataModel
from sequence_planner.texts.message import message


class Person(DataModel):
    """Somebody who may sign in, unless `disabled`.

    `revision` counts the changes, so that two who change a person at once notice. With `must_change_password` somebody
    else has set the password, and nothing may be done before the person has set another one. `issuer` is the provider
    that vouches for the person, who then has no password here; null where there is one.
    """

    id: str
    name: str
    role: Role
    created: float
    disabled: bool
    must_change_password: bool
    revision: int
    issuer: str | None = None


DEMONSTRATOR = Person(
    id="demonstration",
    name="Demonstration",
    role=Role.ENGINEER,
    created=0.0,
    disabled=False,
    must_change_password=False,
    revision=0,
)
"""Visitor of a demonstration: no person of the database, without a password, and not an administrator."""

_PARTS = [PEOPLE.c[name] for name in Person.model_fields]
_RESERVED = {name_shape(name) for name in (DEMONSTRATOR.name, SYSTEM.name, UNKNOWN)}


def create(
    connection: Connection, name: str, role: Role, password_hash: str, by: Actor, now: float, *, temporary: bool
) -> Person:
    """A new person; with `temporary` the password has to be changed at the first sign-in.

    Raises `IdentityRefused`: `invalid-name` (422), `name-taken` (409) when another's name is this one or looks like it.
    """
    person = add(connection, name, role, password_hash, now, temporary=temporary)
    details = {"id": person.id, "role": role.value}
    record(connection, by, "person-created", _subject(person), now, **details, temporary_password=temporary)
    return person


def add(connection: Connection, name: str, role: Role, password_hash: str, now: float, *, temporary: bool) -> Person:
    """Do what `create` does, without an entry in the journal: that is for the caller, who knows what it means."""
    name = clean_name(name)
    shape = name_shape(name)
    same = (PEOPLE.c.name_key == name_key(name)) | (PEOPLE.c.name_shape == shape)
    other = connection.execute(select(PEOPLE.c.name).where(same)).scalar()
    if other is not None or shape in _RESERVED:
        if other is not None:
            raise IdentityRefused("name-taken", message("refused.name-taken.there", name=name, other=other))
        raise IdentityRefused("name-taken", message("refused.name-taken.program", name=name))
    person = Person(
        id=new_id(),
        name=name,
        role=role,
        created=now,
        disabled=False,
        must_change_password=temporary,
        revision=1,
    )
    keys = {"name_key": name_key(name), "name_shape": shape, "password_hash": password_hash}
    connection.execute(insert(PEOPLE).values(**person.model_dump(), **keys))
    return person


def everybody(connection: Connection) -> list[Person]:
    """All people, also those who are disabled, by name."""
    return [_person(row) for row in connection.execute(select(*_PARTS).order_by(PEOPLE.c.name_key))]


def find(connection: Connection, id: str) -> Person | None:
    """The person with this id; none for whatever is no id."""
    row = connection.execute(select(*_PARTS).where(PEOPLE.c.id == id)).first() if is_id(id) else None
    return None if row is None else _person(row)


def find_by_name(connection: Connection, name: str) -> Person | None:
    """The person of this name, regardless of case and blanks."""
    row = _with_name(connection, name)
    return None if row is None else _person(row)


def find_password(connection: Connection, name: str) -> tuple[Person, str] | None:
    """The person of this name and the hash of the password, for signing in."""
    row = _with_name(connection, name)
    return None if row is None else (_person(row), row.password_hash)


def change(
    connection: Connection,
    id: str,
    revision: int | None,
    by: Actor,
    now: float,
    *,
    role: Role | None = None,
    disabled: bool | None = None,
) -> Person:
    """Change a person as of `revision` (None: whichever it is).

    Sessions of a person whose role changes, or who is disabled, end.

    Raises `IdentityRefused`: `no-user` (404), `user-changed` (412) since that revision, `last-administrator` (409)
    when nobody would be left who can manage people, `role-from-provider` (409) where a provider says who has which.
    """
    person = get_user(connection, id)
    if revision is not None and person.revision != revision:
        raise IdentityRefused("user-changed", message("refused.user-changed.look", name=person.name), 412)
    wanted = {"role": role, "disabled": disabled}
    changes = {key: value for key, value in wanted.items() if value is not None and value != getattr(person, key)}
    if not changes:
        return person
    if "role" in changes and person.issuer is not None:
        raise IdentityRefused(
            "role-from-provider", message("refused.role-from-provider.issuer", name=person.name, issuer=person.issuer)
        )
    changed = person.model_copy(update={**changes, "revision": person.revision + 1})
    if _administers(person) and not _administers(changed) and not administrator_exists(connection, but=id):
        raise IdentityRefused("last-administrator", message("refused.last-administrator.other", name=person.name), 409)
    connection.execute(update(PEOPLE).where(PEOPLE.c.id == id).values(**changes, revision=changed.revision))
    ended = connection.execute(delete(SESSIONS).where(SESSIONS.c.person == id)).rowcount
    told = {key: [getattr(person, key), value] for key, value in changes.items()}
    record(connection, by, "person-changed", _subject(person), now, id=id, sessions_ended=ended, **told)
    return changed


def set_password(
    connection: Connection,
    id: str,
    password_hash: str,
    by: Actor,
    now: float,
    *,
    temporary: bool,
    recovery: bool = False,
) -> None:
    """Give a person another password. All sessions of the person end, and wrong attempts so far are forgotten.

    For whom a provider vouches has none, but an administrator in a `recovery`, until the provider signs that one in
    again. Raises `IdentityRefused`: `no-user` (404), `no-password-here` (409).
    """
    person = get_user(connection, id)
    check_has_password(person, recovery=recovery)
    replace_password(connection, person, password_hash, temporary=temporary)
    clear_attempts(connection, person.name)
    record(connection, by, "password-reset", _subject(person), now, id=id, temporary_password=temporary)


def check_has_password(person: Person, *, recovery: bool = False) -> None:
    """Raises `IdentityRefused` (`no-password-here`, 409) where `set_password` would."""
    if person.issuer is not None and not (recovery and person.role is Role.ADMINISTRATOR):
        raise IdentityRefused(
            "no-password-here", message("refused.no-password-here.issuer", name=person.name, issuer=person.issuer)
        )


def replace_password(connection: Connection, person: Person, password_hash: str, *, temporary: bool) -> Person:
    """Store another hash and end all sessions of the person, without an entry in the journal."""
    changed = person.model_copy(update={"must_change_password": temporary, "revision": person.revision + 1})
    values = {"must_change_password": temporary, "revision": changed.revision, "password_hash": password_hash}
    connection.execute(update(PEOPLE).where(PEOPLE.c.id == person.id).values(values))
    connection.execute(delete(SESSIONS).where(SESSIONS.c.person == person.id))
    return changed


def renew_hash(connection: Connection, person: Person, password_hash: str) -> None:
    """Store the same password, hashed with newer parameters."""
    connection.execute(update(PEOPLE).where(PEOPLE.c.id == person.id).values(password_hash=password_hash))


def administrator_exists(connection: Connection, *, but: str | None = None) -> bool:
    """Return whether there is an administrator who is not disabled, other than the person `but`."""
    administers = (PEOPLE.c.role == Role.ADMINISTRATOR.value) & PEOPLE.c.disabled.is_(False)
    counted = select(func.count()).select_from(PEOPLE).where(administers)
    if but is not None:
        counted = counted.where(PEOPLE.c.id != but)
    return connection.execute(counted).scalar_one() > 0


def anybody_exists(connection: Connection) -> bool:
    """Return whether there is somebody who may sign in."""
    counted = select(func.count()).select_from(PEOPLE).where(PEOPLE.c.disabled.is_(False))
    return connection.execute(counted).scalar_one() > 0


def get_user(connection: Connection, id: str) -> Person:
    """The person with this id. Raises `IdentityRefused` (`no-user`, 404)."""
    person = find(connection, id)
    if person is None:
        raise IdentityRefused("no-user", message("refused.no-user.id"), 404)
    return person


def _administers(person: Person) -> bool:
    return person.role is Role.ADMINISTRATOR and not person.disabled


def _with_name(connection: Connection, name: str) -> Row[tuple[object, ...]] | None:
    key = name_key(name)
    if key != short(key, LONGEST_KEY):  # nobody's: and no database takes each character that can be typed
        return None
    return connection.execute(select(PEOPLE).where(PEOPLE.c.name_key == key)).first()


def _person(row: Row[tuple[object, ...]]) -> Person:
    return Person.model_validate({name: getattr(row, name) for name in Person.model_fields})


def _subject(person: Person) -> str:
    return f"person {person.name}"
