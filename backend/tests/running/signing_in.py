"""Somebody who may act at a station that runs as real processes: a person in its database, signed in."""

from __future__ import annotations

import contextlib
import secrets
import time
from pathlib import Path

import httpx

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import open_session
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.db.location import default_url


def signed_in(model: Path, port: int, url: str | None = None) -> httpx.Client:
    """The browser of an engineer at the station in the folder `model`; its database is at `url`, or by default."""
    now, name = time.time(), f"Engineer {secrets.token_hex(4)}"
    with contextlib.closing(Database.open(url or default_url(model))) as database:
        database.upgrade()
        with database.writing() as connection:
            person = users.create(connection, name, Role.ENGINEER, "none", SYSTEM, now, temporary=False)
            kind = ActorKind.PERSON
            token, _ = open_session(connection, person, now, kind=kind, address="127.0.0.1", agent="tests")
    # A connection for each request: the server may die between two.
    return httpx.Client(
        base_url=f"http://127.0.0.1:{port}/api/v1/",
        cookies={f"sequence-planner-{port}": token},
        limits=httpx.Limits(max_keepalive_connections=0),
    )
