"""`journal`: who did what, and whether the record of it is whole."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import FINDINGS, FINE, DatabaseOption, refuse
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import default_url

Model = Annotated[Path | None, typer.Argument(metavar="[MODEL]", help="The station's folder.", show_default=False)]
DEFAULT_LIMIT = 50


def journal(
    model: Model = None,
    database: DatabaseOption = None,
    limit: Annotated[int, typer.Option(min=1, help="So many records, the latest.")] = DEFAULT_LIMIT,
    action: Annotated[str | None, typer.Option(help="Only records of this action, such as set-mode.")] = None,
    verify: Annotated[bool, typer.Option("--verify", help="Say whether all records are as they were written.")] = False,
    jsonl: Annotated[bool, typer.Option("--jsonl", help="All records in order, one JSON document a line.")] = False,
) -> None:
    """Show who did what, when, from where, on what and why: the latest records, the newest last.

    With --verify the exit code is 1 if a record was changed or is missing.
    """
    if (verify or jsonl) and (action is not None or limit != DEFAULT_LIMIT or (verify and jsonl)):
        refuse("--verify and --jsonl are about all records: give one of them, without --action and --limit")
    if model is None and not database:
        refuse("say whose journal: a station's folder, or --database URL")
    # The other commands do without a database, and start sooner for it.
    from sequence_planner.cli.journal_lines import documents, latest, verification  # noqa: PLC0415
    from sequence_planner.storage.database import Database  # noqa: PLC0415

    try:
        with closing(Database.open(database or default_url(model or Path()), create=False)) as opened:
            opened.check()
            if verify:
                broken, said = verification(opened)
                typer.echo(said)
                raise typer.Exit(FINDINGS if broken else FINE)
            for line in documents(opened) if jsonl else latest(opened, limit, action):
                typer.echo(line)
    except StorageError as error:
        refuse(str(error))
