"""`journal`: query, replay, export, verify, checkpoint and trim the audit and run journals."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from sequence_planner.cli.options import (
    FINDINGS,
    FINE,
    AsJson,
    DatabaseOption,
    StationFolder,
    print_json,
    refuse,
)
from sequence_planner.core.numerals import counted
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.location import default_url
from sequence_planner.retention.settings import NO_ARCHIVE

if TYPE_CHECKING:
    from sequence_planner.automaton.automaton import Automaton
    from sequence_planner.automaton.state_set import Supervisor
    from sequence_planner.db.database import Database
    from sequence_planner.history.timeline import PastView
    from sequence_planner.journal.full_run import WholeRun

# The database whose journal a command is about.

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
    from sequence_planner.db.database import Database  # noqa: PLC0415

    try:
        opened = Database.open(database or default_url(model or Path()), create=False)
        try:
            opened.check()
            yield opened
        finally:
            opened.close()
    except StorageError as error:
        refuse(str(error))


# `journal replay` and `journal show`: the run done again from its journal.

From = Annotated[int, typer.Option("--from", metavar="N", min=1, help="Begin with the last whole record up to this.")]
To = Annotated[int | None, typer.Option("--to", metavar="N", min=1, help="End with this record.")]


def replay(
    model: StationFolder,
    from_: From = 1,
    to: To = None,
    database: DatabaseOption = None,
    archive: ArchiveOption = None,
) -> None:
    """Do all that has happened again, with the model as it is, and compare each state with the one that was.

    The exit code is 1 if a state is another one.
    """
    from sequence_planner.execution.record.replay import replay as replayed  # noqa: PLC0415

    with _replaying(model, database, archive) as (run, automaton, supervisor):
        last = None
        for last in replayed(run, automaton, supervisor, from_, to):
            if last.difference is not None:
                typer.echo(last.difference)
                raise typer.Exit(FINDINGS)
        if last is None:
            refuse("there is nothing to replay up to that record")
        typer.echo(f"replayed up to record {last.record.number}: every state is as it was")


def show(
    model: StationFolder,
    number: Annotated[int, typer.Argument(min=1, help="The number of a record.")],
    database: DatabaseOption = None,
    archive: ArchiveOption = None,
    json: AsJson = False,
) -> None:
    """Show a record, and how the station was right after it."""
    from sequence_planner.history.state_at import looking_back, moment_view  # noqa: PLC0415

    with _replaying(model, database, archive) as (run, automaton, supervisor):
        found = moment_view(run, looking_back(run, automaton, supervisor, number))
    if json:
        print_json(found.model_dump(mode="json"))
        return
    record = found.record
    typer.echo(f"record {record.number}, {record.kind}, at {record.time:.3f} s")
    for line in _replay_lines(found.past):
        typer.echo(f"  {line}")


def _replay_lines(past: PastView) -> Iterator[str]:
    yield f"mode {past.mode}, production {past.production}, tick {past.tick}"
    yield f"active: {', '.join(past.active) or 'no operation'}"
    yield f"running: {', '.join(past.running) or 'nothing'}"
    yield f"plan {past.plan.status}: {past.plan.reason}"
    for step in past.plan.steps:
        yield f"  {'called off' if step.called_off else step.status}: {step.ability}"
    for name, value in past.values.items():
        text = "unknown" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
        yield f"{name} = {text}"


@contextmanager
def _replaying(
    model: StationFolder, database: str | None, archive: Path | None
) -> Iterator[tuple[WholeRun, Automaton, Supervisor]]:
    """Give what a replay needs; what keeps it from being done is said with exit code 2."""
    from sequence_planner.cli.analysing import supervisor_of  # noqa: PLC0415
    from sequence_planner.cli.loading import usable_automaton  # noqa: PLC0415
    from sequence_planner.execution.record.codec import HistoryError  # noqa: PLC0415
    from sequence_planner.journal.archive import Archive  # noqa: PLC0415
    from sequence_planner.journal.full_run import WholeRun  # noqa: PLC0415
    from sequence_planner.synthesis.supervisor import SynthesisError  # noqa: PLC0415

    automaton = usable_automaton(model)
    try:
        supervisor = supervisor_of(automaton)
        with the_database(model, database) as opened, opened.reading() as connection:
            yield WholeRun(connection, Archive(archive)), automaton, supervisor
    except (HistoryError, SynthesisError) as error:
        refuse(str(error))


# `journal`: who did what, what has happened at the station, and whether the record of both is whole.

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
        from sequence_planner.cli.station.journal_lines import documents, latest, verification  # noqa: PLC0415

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
        from sequence_planner.cli.station.journal_lines import happenings  # noqa: PLC0415

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
        from sequence_planner.cli.local_actor import at_the_command_line  # noqa: PLC0415
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
        from sequence_planner.cli.station.archive_lines import archived  # noqa: PLC0415

        for line in archived(opened, archive):
            typer.echo(line)


def _archive_folder(named: str | None, model: Path | None, database: str | None) -> Path | None:
    """Return where what is cut goes to; None where that was said to be nowhere."""
    if named == NO_ARCHIVE:
        return None
    from sequence_planner.db.location import SqliteFile, address  # noqa: PLC0415
    from sequence_planner.retention.retention import usable  # noqa: PLC0415

    try:
        if named is None and model is None and not isinstance(address(database or ""), SqliteFile):
            refuse(
                f"say where what is cut goes to: name the station's folder, or --archive-folder FOLDER or {NO_ARCHIVE}"
            )
        return usable(None if named is None else Path(named), database or default_url(model or Path()), model)
    except StorageError as error:
        refuse(str(error))


journal.command()(replay)
journal.command()(show)
