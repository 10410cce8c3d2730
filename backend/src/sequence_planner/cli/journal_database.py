"""The database whose journal a command is about."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sequence_planner.cli.options import refuse
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import default_url

if TYPE_CHECKING:
    from sequence_planner.storage.database import Database

ArchiveOption = Annotated[
    Path | None,
    typer.Option(
        "--archive",
        metavar="FOLDER",
        exists=True,
        file_okay=False,
        help="Where the archive is by now. By default it is where the station has put it.",
    ),
]


@contextmanager
def the_database(model: Path | None, database: str | None) -> Iterator[Database]:
    """A station's database; what cannot be read or written is said with exit code 2."""
    if model is None and not database:
        refuse("say whose journal: a station's folder, or --database URL")
    # The help of the commands does without a database, and is there sooner for it.
    from sequence_planner.storage.database import Database  # noqa: PLC0415

    try:
        opened = Database.open(database or default_url(model or Path()), create=False)
        try:
            opened.check()
            yield opened
        finally:
            opened.close()
    except StorageError as error:
        refuse(str(error))
