"""Comparison of two versions of a model, piece by piece, what needs least time first."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

from sequence_planner.analysis.kept import with_guards
from sequence_planner.editor.comparing.behaviour import behaviour_differences, plan_differences
from sequence_planner.editor.comparing.diff import Written, differences, text_differences
from sequence_planner.editor.comparing.meant import Meant
from sequence_planner.editor.schemas.diff import ComparisonView, comparison_begun
from sequence_planner.editor.usable import UnusableModelError, station_of, supervisor_in
from sequence_planner.model.files import Files
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import Message, message


def compared(
    old: Files, new: Files, stages: Path | None, folder: Path, *, written_only: bool = False
) -> Iterator[ComparisonView]:
    """Tell how two models differ, again and again, each time more of it; `folder` is empty. With `written_only` what
    follows from what is written is not found out.
    """
    began = time.monotonic()
    view = comparison_begun(text_differences(old, new))
    yield view

    def more(doing: Message | None, **found: object) -> ComparisonView:
        now = {"doing": doing or "", "doing_message": doing, "seconds": time.monotonic() - began}
        return view.model_copy(update={**now, **found})

    try:
        before, after = (
            station_of("older", old, stages, folder / "old"),
            station_of("newer", new, stages, folder / "new"),
        )
        written = differences(Written(before.automaton), Written(after.automaton))
        if written_only:
            yield more(None, parts=written)
            return
        yield (view := more(message("comparing.supervisor"), parts=written))
        one, other = _meant("older", before), _meant("newer", after, before)
    except UnusableModelError as error:
        yield more(None, obstacle=error.why, obstacle_message=error.why)
        return
    parts = differences(Written(before.automaton, one.guards), Written(after.automaton, other.guards))
    guards = len(one.guards), len(other.guards)
    yield (view := more(message("comparing.starts"), parts=parts, guards=guards, states=other.states))
    behaviour, undecided = behaviour_differences(one, other)
    yield (view := more(message("comparing.plans"), behaviour=behaviour, undecided=undecided))
    plans, unplanned = plan_differences(one, other, (behaviour, undecided))
    yield more(None, plans=plans, unplanned=unplanned)


def made_known(files: Files, stages: Path | None, folder: Path) -> Iterator[bool]:
    """Find out what a model is compared by, so that it is kept; tell whether there is anything."""
    try:
        station = station_of("older", files, stages, folder / "old")
        _meant("older", station)
    except UnusableModelError:
        yield False
    else:
        yield True


def comparison(
    old: Files, new: Files, written_only: bool, stages: Path | None, folder: Path
) -> Iterator[tuple[str, bool]]:
    """Tell the same as JSON, each time with whether that is all."""
    for view in compared(old, new, stages, folder, written_only=written_only):
        yield view.model_dump_json(), not view.doing


def _meant(which: str, station: ReadyStation, other: ReadyStation | None = None) -> Meant:
    """Return what it means with the guards that its supervisor adds, which may be known of the `other` one."""
    found = with_guards(station.automaton, None if other is None else other.automaton)
    return Meant(station.automaton, supervisor_in(which, found), found.guards or {}, found.reached)
