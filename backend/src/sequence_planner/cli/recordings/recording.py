"""`recording`: what a recording of ROS 2 traffic has for a station, and the state that it gives at a moment."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Final

import typer

from sequence_planner.cli.loading import usable_model
from sequence_planner.cli.options import FINDINGS, AsJson, StationFolder, print_json, refuse
from sequence_planner.editor.recordings.bag import Bag
from sequence_planner.editor.recordings.files import MB, RecordingError, lay_out
from sequence_planner.editor.recordings.reading import RecordingReading, SaidValue, read_recording
from sequence_planner.editor.schemas.what_if import RecordedStanding, transferred
from sequence_planner.language.printer import print_value
from sequence_planner.process.budget import Budget
from sequence_planner.station import ReadyStation

MOST_UNPACKED: Final = 20_000  # MB
MOST_MOMENTS: Final = 1_000_000


def recording(
    model: StationFolder,
    path: Annotated[
        Path,
        typer.Argument(
            metavar="RECORDING",
            exists=True,
            help="The folder that `ros2 bag record` has made, its .mcap or .db3 file, or a .zip of it.",
        ),
    ],
    at: Annotated[
        float | None,
        typer.Option(min=0.0, metavar="SECONDS", help="The state so many seconds after the recording began."),
    ] = None,
    deadline: Annotated[float, typer.Option(min=1.0, metavar="SECONDS", help="Read for so long at most.")] = 600.0,
    as_json: AsJson = False,
) -> None:
    """Say what a recording of ROS 2 traffic has for a station, or with --at where the station was at a moment."""
    station = usable_model(model).station
    if station is None:
        refuse(f"{model} is no station: a recording is read with the pipelines of one")
    try:
        with tempfile.TemporaryDirectory(prefix="sequence-planner-recording-") as folder:
            lay_out(path, path.name, Path(folder), MOST_UNPACKED * MB)
            with Bag(Path(folder)) as bag:
                read = read_recording(bag, station, Budget.seconds(deadline), MOST_MOMENTS)
        said = None if at is None else read.said_by(at)
    except RecordingError as error:
        refuse(str(error.why))
    if said is not None:
        _tell_state(station, said, as_json)
        return
    if as_json:
        print_json(_document(read))
    else:
        for line in _lines(station, read):
            typer.echo(line)
    if read.otherwise or read.troubles or read.missing or read.incomplete is not None:
        raise typer.Exit(FINDINGS)


def _tell_state(station: ReadyStation, said: Mapping[str, SaidValue], as_json: bool) -> None:
    state = transferred(station.automaton, {name: each.value for name, each in said.items()})
    if as_json:
        print_json({"state": {name: state[name] for name in station.automaton.variables}, "active": []})
        return
    for name in station.automaton.variables:
        standing = said[name].standing if name in said else RecordedStanding.NOT_RECORDED
        note = "" if standing is RecordedStanding.RECORDED else f"  ({standing.value.replace('-', ' ')})"
        typer.echo(f"{name} == {_shown(state[name])}{note}")


def _lines(station: ReadyStation, read: RecordingReading) -> Iterator[str]:
    yield f"{read.seconds:.3f} s, {read.messages} messages read, {len(read.moments)} moments"
    for each in read.heard:
        yield f"  {each.name}  {read.counts.get(each.name, 0)} messages"
    for name in read.missing:
        yield f"  {name}  not recorded"
    for other in read.otherwise:
        yield f"  {other.topic.name}  not read: another {other.difference.value} ({other.topic.type_name})"
    for trouble in read.troubles:
        yield f"  {trouble.topic}  {trouble.count} times, first at {trouble.first:.3f} s: {trouble.text}"
    if read.incomplete is not None:
        yield f"  read to {read.until:.3f} s only: too many {read.incomplete.value}"
    for moment in read.moments:
        changes = (
            f"{name} := {_shown(after.value)}" + (" (stale)" if after.standing is RecordedStanding.STALE else "")
            for name, (_, after) in moment.changes.items()
        )
        yield f"{moment.at:.3f}  {', '.join(changes)}"


def _document(read: RecordingReading) -> dict[str, object]:
    return {
        "began": read.began,
        "seconds": read.seconds,
        "until": read.until,
        "incomplete": read.incomplete,
        "messages": dict(read.counts),
        "missing": list(read.missing),
        "otherwise": [
            {"topic": each.topic.name, "recorded": each.topic.type_name, "difference": each.difference}
            for each in read.otherwise
        ],
        "troubles": [
            {"topic": each.topic, "text": each.text, "count": each.count, "first": each.first} for each in read.troubles
        ],
        "moments": [
            {
                "at": moment.at,
                "changes": {
                    name: {"before": before.value, "after": after.value, "standing": after.standing}
                    for name, (before, after) in moment.changes.items()
                },
            }
            for moment in read.moments
        ],
    }


def _shown(value: bool | int | str | None) -> str:
    return "unknown" if value is None else print_value(value)
