"""`backup` and `restore`: a station's database, revisions and model, in one file."""

from __future__ import annotations

import contextlib
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import DatabaseOption, StationFolder, database_url, refuse
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database


def backup(
    model: StationFolder,
    to: Annotated[Path, typer.Option(metavar="FILE", help="The file to write; none may be there yet.")],
    database: DatabaseOption = None,
) -> None:
    """Write a station's database, revisions and model to one file, while it runs or not."""
    from sequence_planner.backup.archive import How, Maker  # noqa: PLC0415
    from sequence_planner.backup.service import (  # noqa: PLC0415
        Doing,
        back_up,
        ended,
    )
    from sequence_planner.cli.local_actor import at_the_command_line  # noqa: PLC0415
    from sequence_planner.process.user import user_name  # noqa: PLC0415

    url = database_url(model, database)
    try:
        made = back_up(url, model, to, Maker(how=How.COMMAND_LINE, name=user_name()))
        with contextlib.closing(Database.open(url, create=False)) as opened, opened.writing() as connection:
            details = {"folder": str(to.absolute().parent)}
            ended(connection, Doing.MAKING, at_the_command_line(), to.name, time.time(), details=details)
    except StorageError as error:
        refuse(str(error))
    typer.echo(
        f"{to} holds the journal up to record {made.run.number} of what happened and {made.audit.number} of who did "
        "what"
    )


def restore(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A file that `backup` has written.")],
    model: StationFolder,
    database: DatabaseOption = None,
) -> None:
    """Put a backup in place where there is no database yet, verify it, and sign everybody out."""
    from sequence_planner.backup.service import restore as put_in_place  # noqa: PLC0415
    from sequence_planner.cli.local_actor import at_the_command_line  # noqa: PLC0415

    try:
        restored = put_in_place(file, database_url(model, database), model, at_the_command_line())
    except StorageError as error:
        refuse(str(error))
    made = datetime.fromtimestamp(restored.time, UTC)
    typer.echo(
        f"restored as of {made:%Y-%m-%d %H:%M:%S} UTC, verified up to record {restored.run.number} of what happened "
        f"and {restored.audit.number} of who did what; people, keys and watches that were locked out since are not so: "
        "lock them out again; job orders stand as they did then: abort those that were made since, before production "
        "is started"
    )
