"""`journal`: who did what, what has happened at the station, and whether the record of both is whole."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from sequence_planner.cli import journal_replay
from sequence_planner.cli.journal_database import ArchiveOption, the_database
from sequence_planner.cli.options import FINDINGS, FINE, DatabaseOption, refuse
from sequence_planner.counting import counted
from sequence_planner.retention.settings import NO_ARCHIVE
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import default_url

Model = Annotated[Path | None, typer.Argument(metavar="[MODEL]", help="The station's folder.", show_default=False)]
DEFAULT_LIMIT = 50
_DAY = 86400.0  # seconds
_LIST = "list"


class _Group(TyperGroup):
    """`journal MODEL` is `journal list MODEL`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:  # noqa: ANN401 (a class that typer does not show)
        named = bool(args) and (args[0] in self.commands or args[0] == "--help")
        return super().parse_args(ctx, args if named else [_LIST, *args])


journal = typer.Typer(
    name="journal",
    cls=_Group,
    add_completion=False,
    help="Who did what, and what has happened. Without a command it is list, as in: journal MODEL --verify",
)


@journal.command(_LIST)
def list_acts(
    model: Model = None,
    database: DatabaseOption = None,
    limit: Annotated[int, typer.Option(min=1, help="So many records, the latest.")] = DEFAULT_LIMIT,
    action: Annotated[str | None, typer.Option(help="Only records of this action, such as set-mode.")] = None,
    verify: Annotated[bool, typer.Option("--verify", help="Say whether all records are as they were written.")] = False,
    checkpoint: Annotated[
        Path | None,
        typer.Option(metavar="FILE", exists=True, dir_okay=False, help="With --verify: a checkpoint kept elsewhere."),
    ] = None,
    jsonl: Annotated[bool, typer.Option("--jsonl", help="All records in order, one JSON document a line.")] = False,
    archive: ArchiveOption = None,
) -> None:
    """Show who did what, when, from where, on what and why: the latest records, the newest last.

    With --verify, which is also about what has happened and the archive, the exit code is 1 if a record was changed or
    is missing.
    """
    if (verify or jsonl) and (action is not None or limit != DEFAULT_LIMIT or (verify and jsonl)):
        refuse("--verify and --jsonl are about all records: give one of them, without --action and --limit")
    if checkpoint is not None and not verify:
        refuse("--checkpoint is what --verify compares with: give both")
    with the_database(model, database) as opened:
        from sequence_planner.cli.journal_lines import documents, latest, verification  # noqa: PLC0415

        if verify:
            wrong, lines = verification(opened, checkpoint, archive)
            typer.echo("\n".join(lines))
            raise typer.Exit(FINDINGS if wrong else FINE)
        for line in documents(opened) if jsonl else latest(opened, limit, action):
            typer.echo(line)


@journal.command()
def export(
    model: Model = None,
    database: DatabaseOption = None,
    after: Annotated[int, typer.Option(min=0, help="Only records with numbers above this one.")] = 0,
    archive: ArchiveOption = None,
) -> None:
    """Write all that has happened, in order, one JSON document a line; what is in the archive too."""
    with the_database(model, database) as opened:
        from sequence_planner.cli.journal_lines import happenings  # noqa: PLC0415

        for line in happenings(opened, after, archive):
            typer.echo(line)


@journal.command()
def checkpoint(model: Model = None, database: DatabaseOption = None) -> None:
    """Sign how far the journal has come, and print that, to be kept where nobody of the station can write."""
    with the_database(model, database) as opened:
        from sequence_planner.journal import checkpoints  # noqa: PLC0415

        typer.echo(checkpoints.make(opened, time.time()).model_dump_json())


@journal.command()
def trim(
    older_than: Annotated[float, typer.Option(metavar="DAYS", min=0, help="What happened so many days ago goes.")],
    model: Model = None,
    database: DatabaseOption = None,
    archive_folder: Annotated[
        str | None,
        typer.Option(
            metavar="FOLDER", help=f"Where it goes to, a folder that is there; {NO_ARCHIVE}: it is gone for good."
        ),
    ] = None,
) -> None:
    """Take out what happened long ago, up to the last snapshot before, to the archive; who did what stays."""
    with the_database(model, database) as opened:
        from sequence_planner.cli.acting import at_the_command_line  # noqa: PLC0415
        from sequence_planner.journal.retention import trim  # noqa: PLC0415

        folder = _archive_folder(archive_folder, model, database)
        trimmed = trim(opened, time.time() - older_than * _DAY, at_the_command_line(), folder)
    where = "" if folder is None else f"; what was cut is in {folder}"
    removed = counted(trimmed.removed, "record was", "records were")
    typer.echo(f"{removed} taken out; the database begins with record {trimmed.begin + 1}{where}")


@journal.command("archive")
def list_archive(model: Model = None, database: DatabaseOption = None, archive: ArchiveOption = None) -> None:
    """List the files of the archive: which records and orders each has, how large it is, and where."""
    with the_database(model, database) as opened:
        from sequence_planner.cli.archive_lines import archived  # noqa: PLC0415

        for line in archived(opened, archive):
            typer.echo(line)


def _archive_folder(named: str | None, model: Path | None, database: str | None) -> Path | None:
    """Where what is cut goes to; None where that was said to be nowhere."""
    if named == NO_ARCHIVE:
        return None
    from sequence_planner.retention.folder import usable  # noqa: PLC0415
    from sequence_planner.storage.address import SqliteFile, address  # noqa: PLC0415

    try:
        if named is None and model is None and not isinstance(address(database or ""), SqliteFile):
            refuse(
                f"say where what is cut goes to: name the station's folder, or --archive-folder FOLDER or {NO_ARCHIVE}"
            )
        return usable(None if named is None else Path(named), database or default_url(model or Path()), model)
    except StorageError as error:
        refuse(str(error))


journal.command()(journal_replay.replay)
journal.command()(journal_replay.show)
