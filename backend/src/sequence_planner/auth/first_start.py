"""The first start: a link that is shown on the terminal lets whoever starts the program become administrator.

There is no password that everybody knows. A link works once, for 15 minutes, and only while there is no administrator;
a new one replaces those before it.
"""

from __future__ import annotations

from sqlalchemy import Connection, delete, insert, select

from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.auth.tables import FIRST_START_LINKS
from sequence_planner.auth.tokens import hash_of, new_token, record, same, short
from sequence_planner.auth.users import Person, add, administrator_exists
from sequence_planner.core.actor import SYSTEM, Actor, ActorKind
from sequence_planner.texts.message import message

LIFE = 900.0  # seconds that a link works


def new_link_token(connection: Connection, now: float) -> str:
    """The token of a new link. Raises `IdentityRefused` (`administrator-exists`, 409)."""
    if administrator_exists(connection):
        raise IdentityRefused("administrator-exists", message("refused.administrator-exists.ask"), 409)
    token = new_token()
    connection.execute(delete(FIRST_START_LINKS))
    connection.execute(insert(FIRST_START_LINKS).values(token_hash=hash_of(token), expires=now + LIFE))
    record(connection, SYSTEM, "first-start-link", "", now)
    return token


def link_usable(connection: Connection, token: str, now: float) -> bool:
    """Return whether `use_link` would take the token: to be asked before a password is hashed for it."""
    live = select(FIRST_START_LINKS.c.token_hash).where(FIRST_START_LINKS.c.expires > now)
    hashed = connection.execute(live).scalar()
    return hashed is not None and same(hashed, hash_of(token)) and not administrator_exists(connection)


def use_link(connection: Connection, token: str, name: str, password_hash: str, now: float, *, address: str) -> Person:
    """Make the first administrator. The link works no more.

    Raises `IdentityRefused`: `setup-link-invalid` (403) when the link is unknown, used, replaced or too old, or there
    is an administrator; `invalid-name` (422), `name-taken` (409), after which the link can be used again.
    """
    if not link_usable(connection, token, now):
        raise unusable()
    person = add(connection, name, Role.ADMINISTRATOR, password_hash, now, temporary=False)
    connection.execute(delete(FIRST_START_LINKS))
    actor = Actor(kind=ActorKind.PERSON, id=person.id, name=person.name, address=short(address))
    record(connection, actor, "first-administrator", f"person {person.name}", now, id=person.id)
    return person


def unusable() -> IdentityRefused:
    """Return what to say of a link that does not work, whatever the reason."""
    return IdentityRefused("setup-link-invalid", message("refused.setup-link-invalid.new"), 403)
