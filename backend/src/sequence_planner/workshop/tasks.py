"""What is found of whole models beside a check: each takes a while, and is done in a process of its own."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path

from sequence_planner.analysis.analysis import analyses
from sequence_planner.expressions.types import Value
from sequence_planner.model.source import ModelError
from sequence_planner.station import prepare_station
from sequence_planner.workshop.comparison import (
    Meant,
    behaviour_differences,
    differences,
    plan_differences,
    text_differences,
)
from sequence_planner.workshop.comparison_view import ComparisonView, TransferView
from sequence_planner.workshop.files import Files, write_files
from sequence_planner.workshop.transfer import transfer


class Unusable(Exception):
    """A model that cannot be used, and why."""


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
    files: Files, stages: Path | None, present: Mapping[str, Value | None], folder: Path
) -> Iterator[TransferView]:
    """Whether a station in its `present` state can take a model; `folder` is empty."""
    try:
        meant = _meant("the model", files, stages, folder / "new")
    except Unusable as error:
        yield TransferView(legal=False, changes=[], violated=[], ways=[], obstacle=str(error))
        return
    yield transfer(meant.automaton, meant.supervisor, present)


def _meant(what: str, files: Files, stages: Path | None, folder: Path) -> Meant:
    """What a model means. Raises `Unusable`."""
    folder.mkdir()
    write_files(files, folder, stages)
    try:
        with contextlib.chdir(folder):
            automaton = prepare_station(Path()).automaton
    except ModelError as error:
        raise Unusable(f"{what} cannot be used: {error.findings[0]}") from error
    found = None
    for found in analyses(automaton):
        if found.supervisor is not None and found.guards is not None:
            return Meant(automaton, found.supervisor, found.guards)
    why = "; ".join(warning.message for warning in (found.warnings if found else None) or ())
    raise Unusable(f"{what} has no supervisor: {why}")
