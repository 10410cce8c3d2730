"""What is found of whole models beside a check: each takes a while, and is done in a process of its own."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path

from sequence_planner.analysis.document import TraceDocument
from sequence_planner.analysis.finding import analyses
from sequence_planner.control.definition_view import AutomatonView
from sequence_planner.control.view_part import View
from sequence_planner.expressions.types import Value
from sequence_planner.model.source import ModelError
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.workshop.comparison import (
    Meant,
    behaviour_differences,
    differences,
    plan_differences,
    text_differences,
)
from sequence_planner.workshop.comparison_view import ComparisonView, TransferView
from sequence_planner.workshop.files import Files, write_files
from sequence_planner.workshop.playing import played
from sequence_planner.workshop.transfer import transfer, untransferred
from sequence_planner.workshop.what_if import what_if
from sequence_planner.workshop.what_if_view import WhatIfView


class Unusable(Exception):
    """A model that cannot be used, and why."""


def told(name: str, *arguments: object) -> Iterator[str]:
    """What the task `name` finds, as JSON."""
    for each in _TOLD[name](*arguments):
        yield each.model_dump_json()


def compared(old: Files, new: Files, stages: Path | None, folder: Path) -> Iterator[ComparisonView]:
    """How two models differ; `folder` is empty."""
    text = text_differences(old, new)
    try:
        before = _meant("the older one", old, stages, folder / "old")
        after = _meant("the newer one", new, stages, folder / "new")
    except Unusable as error:
        yield ComparisonView(text=text, parts=None, behaviour=None, plans=None, obstacle=str(error))
        return
    yield ComparisonView(
        text=text,
        parts=differences(before, after),
        behaviour=list(behaviour_differences(before, after)),
        plans=list(plan_differences(before, after)),
        obstacle=None,
    )


def fitted(
    old: Files,
    new: Files,
    stages: Path | None,
    present: Mapping[str, Value | None],
    running: Collection[str],
    reset: bool,
    folder: Path,
) -> Iterator[TransferView]:
    """Whether a station in its `present` state, with abilities `running`, can take `new`, or if all of it is `reset`;
    `folder` is empty.
    """
    try:
        after = _meant("the model", new, stages, folder / "new")
    except Unusable as error:
        yield untransferred(str(error))
        return
    try:
        before = _station(old, stages, folder / "old").automaton
    except ModelError:
        before = None
    yield transfer(before, after.automaton, after.supervisor, present, running, reset=reset)


def simulated(
    files: Files,
    stages: Path | None,
    present: Mapping[str, Value | None],
    seconds: float,
    deadline: float,
    folder: Path,
) -> Iterator[WhatIfView]:
    """How a station would go on with a model from a state; `folder` is empty."""
    try:
        meant = _meant("the model", files, stages, folder / "new")
    except Unusable as error:
        yield WhatIfView(
            seconds=0.0,
            safe=False,
            runs=[],
            completed=[],
            before={},
            after={},
            active=[],
            unplanned="",
            obstacle=str(error),
        )
        return
    yield what_if(meant.station, meant.supervisor, present, seconds, deadline)


def drawn(
    files: Files, stages: Path | None, ability: str, trace: TraceDocument, folder: Path
) -> Iterator[list[AutomatonView] | str]:
    """How an ability goes through a run, or why nobody can say; `folder` is empty."""
    try:
        automaton = _station(files, stages, folder / "new").automaton
    except ModelError as error:
        yield f"the model cannot be used: {error.findings[0]}"
        return
    found = automaton.abilities.get(ability)
    yield f"the model has no ability `{ability}`" if found is None else played(automaton, found, trace)


_TOLD: Mapping[str, Callable[..., Iterator[View]]] = {
    "compared": compared,
    "fitted": fitted,
    "simulated": simulated,
}


def _meant(what: str, files: Files, stages: Path | None, folder: Path) -> Meant:
    """What a model means. Raises `Unusable`."""
    try:
        station = _station(files, stages, folder)
    except ModelError as error:
        raise Unusable(f"{what} cannot be used: {error.findings[0]}") from error
    found = None
    for found in analyses(station.automaton):
        if found.supervisor is not None and found.guards is not None:
            return Meant(station, found.supervisor, found.guards)
    why = "; ".join(warning.message for warning in (found.warnings if found else None) or ())
    raise Unusable(f"{what} has no supervisor: {why}")


def _station(files: Files, stages: Path | None, folder: Path) -> ReadyStation:
    """Raises `ModelError`."""
    folder.mkdir()
    write_files(files, folder, stages)
    with contextlib.chdir(folder):
        return prepare_station(Path())
