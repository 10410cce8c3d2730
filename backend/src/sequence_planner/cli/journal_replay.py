"""`journal replay` and `journal show`: the run done again from its journal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sequence_planner.cli.journal_database import ArchiveOption, the_database
from sequence_planner.cli.options import FINDINGS, AsJson, DatabaseOption, StationFolder, print_json, refuse

if TYPE_CHECKING:
    from sequence_planner.automaton.state_set import Supervisor
    from sequence_planner.automaton.structure import Automaton
    from sequence_planner.history.view import PastView
    from sequence_planner.journal.whole_run import WholeRun

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
    from sequence_planner.history.replay import replay as replayed  # noqa: PLC0415

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
    from sequence_planner.history.looking_back import looking_back  # noqa: PLC0415
    from sequence_planner.history.moment_view import moment_view  # noqa: PLC0415

    with _replaying(model, database, archive) as (run, automaton, supervisor):
        found = moment_view(looking_back(run, automaton, supervisor, number))
    if json:
        print_json(found.model_dump(mode="json"))
        return
    record = found.record
    typer.echo(f"record {record.number}, {record.kind}, at {record.time:.3f} s")
    for line in _lines(found.past):
        typer.echo(f"  {line}")


def _lines(past: PastView) -> Iterator[str]:
    yield f"mode {past.mode}, production {past.production}, tick {past.tick}"
    yield f"active: {', '.join(past.active) or 'no operation'}"
    yield f"running: {', '.join(past.running) or 'nothing'}"
    yield f"plan {past.plan.status}: {past.plan.reason}"
    for step in past.plan.steps:
        yield f"  {step.status}: {step.ability}"
    for name, value in past.values.items():
        text = "unknown" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
        yield f"{name} = {text}"


@contextmanager
def _replaying(
    model: StationFolder, database: str | None, archive: Path | None
) -> Iterator[tuple[WholeRun, Automaton, Supervisor]]:
    """What a replay needs; what keeps it from being done is said with exit code 2."""
    from sequence_planner.cli.analysing import supervisor_of  # noqa: PLC0415
    from sequence_planner.cli.loading import usable_automaton  # noqa: PLC0415
    from sequence_planner.history.error import HistoryError  # noqa: PLC0415
    from sequence_planner.journal.archive import Archive  # noqa: PLC0415
    from sequence_planner.journal.whole_run import WholeRun  # noqa: PLC0415
    from sequence_planner.synthesis.supervision import SynthesisError  # noqa: PLC0415

    automaton = usable_automaton(model)
    try:
        supervisor = supervisor_of(automaton)
        with the_database(model, database) as opened, opened.reading() as connection:
            yield WholeRun(connection, Archive(archive)), automaton, supervisor
    except (HistoryError, SynthesisError) as error:
        refuse(str(error))
