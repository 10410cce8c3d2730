"""Tasks that are done once as a station begins, in a process of its own: see `prestart`."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from datetime import UTC, datetime
from multiprocessing.connection import Connection
from pathlib import Path

from sequence_planner.auth.first_start import new_link_token
from sequence_planner.auth.users import administrator_exists
from sequence_planner.core.logging import LogFormat, configure_logs, log_format
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer
from sequence_planner.editor import draft as drafts
from sequence_planner.journal.last_accepted import set_aside
from sequence_planner.model.source import ModelError
from sequence_planner.server.settings import Endpoint
from sequence_planner.startup.prestart import Begun, StationBeginning
from sequence_planner.station import prepare_station


def begin(to: Connection, what: StationBeginning) -> None:
    """Send what was `Begun`."""
    if log_format() is LogFormat.JSON:
        configure_logs()
    said: list[str] = []
    try:
        said.extend(_lines(what))
    except (_RefusedError, StorageError) as error:
        to.send(Begun(tuple(said), str(error)))
    else:
        to.send(Begun(tuple(said)))


class _RefusedError(Exception):
    """The station cannot begin."""


def _lines(what: StationBeginning) -> Iterator[str]:
    """Read the model, and have the database ready; what is said of that."""
    unusable = _unusable(what.model)
    if unusable is not None:
        if not _has_draft(what.database):
            raise _RefusedError(unusable)
        yield f"{unusable}\nthe model cannot be used: change its draft on its page, and deploy that"
    with contextlib.closing(Database.open(what.database, new=what.new)) as database:
        if what.shared and not isinstance(database.place, PostgresqlServer):
            raise _RefusedError(f"several stations cannot share {database.place}: --hot-standby takes PostgreSQL")
        if what.new and database.is_empty:
            for path, kept in set_aside(database.place, datetime.now(UTC)):
                yield f"a new station begins: the last word of another one, {path}, is kept as {kept}"
        database.upgrade(new=what.new)


def _unusable(model: Path) -> str | None:
    """Return why the model cannot be used, if it cannot."""
    try:
        prepare_station(model)
    except ModelError as error:
        return str(error)
    return None


def _has_draft(url: str) -> bool:
    """Return whether somebody has edited the model in the browser, so that it can be repaired there. No database is
    made.
    """
    try:
        with contextlib.closing(Database.open(url, create=False)) as database:
            database.upgrade()
            with database.reading() as connection:
                return drafts.read(connection).number > 0
    except StorageError:
        return False


def first_start(to: Connection, model: Path, database: str, endpoint: Endpoint, at_terminal: bool) -> None:
    """Send how the first administrator gets in, or None."""
    to.send(_first_start(model, database, endpoint, at_terminal=at_terminal))


def _first_start(model: Path, url: str, endpoint: Endpoint, *, at_terminal: bool) -> str | None:
    try:
        with contextlib.closing(Database.open(url)) as database, database.writing() as connection:
            if administrator_exists(connection):
                return None
            token = new_link_token(connection, time.time()) if at_terminal else None
    except StorageError as error:
        return str(error)
    if token is None:
        how = f"sequence-planner users setup-link {model} --url {endpoint.address}"
        return (
            f"nobody can sign in yet: in a terminal, with the same database, `{how}` prints the link for the first "
            "administrator"
        )
    return f"the first administrator opens, once and within 15 minutes: {endpoint.address}/setup#{token}"
