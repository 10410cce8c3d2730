"""Check of a draft: errors, warnings, supervisor guards and example runs; transfer to it, and simulation of it."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path

from sequence_planner.analysis.checks.rules import check_automaton
from sequence_planner.analysis.kept import documents
from sequence_planner.analysis.report import (
    FindingDocument,
    TraceDocument,
    error_document,
    findings_of,
)
from sequence_planner.automaton.automaton import Ability, Automaton
from sequence_planner.controller.views.automaton_diagram import Drawing
from sequence_planner.controller.views.details import AutomatonView
from sequence_planner.controller.views.part import View
from sequence_planner.editor.schemas.check import (
    CheckedView,
    CheckState,
    CheckView,
    SummaryView,
    doing,
    listed,
    waiting,
)
from sequence_planner.editor.schemas.diff import TransferView
from sequence_planner.editor.schemas.what_if import WhatIfView, transfer, transferred, untransferred
from sequence_planner.editor.usable import UnusableModelError, prepared, station_in
from sequence_planner.editor.what_if import what_if
from sequence_planner.language.types import Value
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.source import ModelError
from sequence_planner.process.gc_tuning import collection_put_off
from sequence_planner.simulation.start_findings import start_findings
from sequence_planner.station import prepare_station
from sequence_planner.texts.message import message

# What is found in a draft: that it cannot be used, or what is suspicious in it and what its supervisor adds.
#
# It is found piece by piece, what needs least time first; whoever waits for all of it sees how far it has come.


def checked(number: int, files: Files, stages: Path | None, start: StartNeeds, folder: Path) -> Iterator[CheckView]:
    """All that is found of the files, again and again, each time more of it: also whether a station that is run as
    `start` says could be started with them. They are written into the empty `folder`, which is also where Python stages
    of the model `stages` are copied to.
    """
    write_files(files, folder, stages)
    with contextlib.chdir(folder):  # so that places bear the names that files have in the model
        begun = waiting(number).model_copy(update={"state": CheckState.CHECKING, **doing(message("pending.reading"))})
        yield from _timed(_found(begun, start))


def _timed(views: Iterable[CheckView]) -> Iterator[CheckView]:
    """Yield them with what was looked for, and how long that took."""
    looked: list[CheckedView] = []
    last: CheckView | None = None
    began = time.monotonic()
    for view in views:
        if last is not None and view.doing != last.doing:
            now = time.monotonic()
            seconds, began = now - began, now
            looked.append(CheckedView(what=last.doing, what_message=last.doing_message, seconds=seconds))
        last = view
        yield view.model_copy(update={"looked": list(looked)})


def _found(view: CheckView, start: StartNeeds) -> Iterator[CheckView]:
    yield view
    try:
        station = prepare_station(Path())
        view = view.model_copy(update=doing(message("pending.examples")))
        yield view
        if wrong := station.failures() or start_findings(station, start):
            raise ModelError(wrong)
    except ModelError as error:
        errors = [error_document(finding) for finding in error.findings]
        yield view.model_copy(update={"state": CheckState.DONE, **doing(None), "findings": listed(errors)})
        return
    automaton = station.automaton
    summary = SummaryView(
        title=automaton.title,
        variables=len(automaton.variables),
        abilities=len(automaton.abilities),
        operations=len(automaton.operations),
        specifications=len(automaton.specifications),
        examples=len(station.examples),
    )
    view = view.model_copy(update={"summary": summary, **doing(message("pending.suspicious"))})
    yield view
    with collection_put_off():
        warnings = findings_of(automaton, check_automaton(automaton, station.connections), station.suspicions())
    view = view.model_copy(update={"findings": listed(sorted(warnings, key=_place))})
    for document in documents(automaton):
        found = sorted([*warnings, *(document.findings or ())], key=_place)
        more = {
            "findings": listed(found),
            **doing(document.pending_message),
            "state": CheckState.DONE if document.pending is None else CheckState.CHECKING,
            "analysis": document.model_copy(update={"findings": None}),
        }
        view = view.model_copy(update=more)
        yield view


def _place(finding: FindingDocument) -> tuple[str, int, int, str]:
    return finding.file, finding.line, finding.column, finding.kind


# A run that shows a finding, as an ability goes through it.


def played(automaton: Automaton, ability: Ability, trace: TraceDocument) -> list[AutomatonView]:
    """The automaton of `ability` in the initial state of a run, and after each step; without a supervisor, which such a
    run has not been held back by.
    """
    states = (transferred(automaton, values) for values in _values(trace))
    return [Drawing(automaton, state, {}, None).of(ability) for state in states]


def _values(trace: TraceDocument) -> Iterator[Mapping[str, Value | None]]:
    values = dict(trace.initial)
    yield values
    for step in trace.steps:
        values = {**values, **step.changes}
        yield values


# What is found of whole models beside a check: each takes a while, and is done in a process of its own.


def told(name: str, *arguments: object) -> Iterator[str]:
    """Yield what the task `name` finds, as JSON."""
    for each in _TOLD[name](*arguments):
        yield each.model_dump_json()


def fitted(
    old: Files,
    new: Files,
    stages: Path | None,
    present: Mapping[str, Value | None],
    running: Collection[str],
    reset: bool,
    folder: Path,
) -> Iterator[TransferView]:
    """Tell whether a station in its `present` state, with abilities `running`, can take `new`, or if all of it is
    `reset`; `folder` is empty.
    """
    try:
        after = prepared("whole", new, stages, folder / "new")
    except UnusableModelError as error:
        yield untransferred(error.why)
        return
    try:
        before = station_in(old, stages, folder / "old").automaton
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
    """Tell how a station would go on with a model from a state; `folder` is empty."""
    try:
        meant = prepared("whole", files, stages, folder / "new")
    except UnusableModelError as error:
        yield WhatIfView(
            seconds=0.0,
            safe=False,
            runs=[],
            completed=[],
            before={},
            after={},
            active=[],
            unplanned="",
            unplanned_message=None,
            obstacle=error.why,
            obstacle_message=error.why,
        )
        return
    yield what_if(meant.station, meant.supervisor, present, seconds, deadline)


def drawn(
    files: Files, stages: Path | None, ability: str, trace: TraceDocument, folder: Path
) -> Iterator[list[AutomatonView] | str]:
    """Tell how an ability goes through a run, or why nobody can say; `folder` is empty."""
    try:
        automaton = station_in(files, stages, folder / "new").automaton
    except ModelError as error:
        first = error.findings[0]
        yield message("edit.unusable", place=str(first.place), what=first.message)
        return
    found = automaton.abilities.get(ability)
    yield message("edit.no-ability", name=ability) if found is None else played(automaton, found, trace)


_TOLD: Mapping[str, Callable[..., Iterator[View]]] = {"fitted": fitted, "simulated": simulated}
