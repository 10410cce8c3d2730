"""Models of the editor that can be used: written into a folder, read, and with their supervisor."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.kept import with_supervisor
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.views.wording import read_predicate
from sequence_planner.language.syntax import Expression
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import ModelError
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.texts.message import Message, joined, message


class UnusableModelError(Exception):
    """A model that cannot be used, and why."""

    def __init__(self, why: Message) -> None:
        super().__init__(why)
        self.why = why


class Usable(NamedTuple):
    """A model that can be used, and its supervisor."""

    station: ReadyStation
    supervisor: Supervisor

    @property
    def automaton(self) -> Automaton:
        """What the station does."""
        return self.station.automaton


Meant = TypeVar("Meant")


class KeptDraft(Generic[Meant]):
    """Keeps the files of a draft, of which a process is told what has changed, in `folder`, and what `prepare` makes of
    them.
    """

    def __init__(self, folder: Path, prepare: Callable[[str, Files, Path | None, Path], Meant]) -> None:
        self._folder = folder / "station"
        self._prepare = prepare
        self._files: dict[str, str] = {}
        self._meant: Meant | UnusableModelError | None = None

    def meant(self, changed: Mapping[str, str | None], stages: Path | None) -> Meant | UnusableModelError:
        """Return what the draft means with files that are others now, none for those that are gone: the same as long as
        none is.
        """
        for path, text in changed.items():
            if text is None:
                self._files.pop(path, None)
            else:
                self._files[path] = text
        if changed or self._meant is None:
            shutil.rmtree(self._folder, ignore_errors=True)
            try:
                self._meant = self._prepare("whole", self._files, stages, self._folder)
            except UnusableModelError as error:
                self._meant = error
        return self._meant


def read_condition(automaton: Automaton, text: str) -> Expression:
    """Return a condition of somebody who asks about a draft. Raises `EditError`."""
    try:
        return read_predicate(automaton, text)
    except CommandRefused as refused:
        raise EditError(refused.detail) from None


def prepared(which: str, files: Files, stages: Path | None, folder: Path) -> Usable:
    """Return a model, called the older, the newer or the whole one; `folder` is not there yet.

    Raises `UnusableModelError`.
    """
    station = station_of(which, files, stages, folder)
    return Usable(station, supervisor_in(which, with_supervisor(station.automaton)))


def station_of(which: str, files: Files, stages: Path | None, folder: Path) -> ReadyStation:
    """The station that a model describes, called as with `prepared`. Raises `UnusableModelError`."""
    try:
        return station_in(files, stages, folder)
    except ModelError as error:
        first = error.findings[0]
        model = message(f"obstacle.model.{which}")
        why = message("obstacle.unusable", model=model, place=str(first.place), what=first.message)
        raise UnusableModelError(why) from error


def supervisor_in(which: str, found: Analysis) -> Supervisor:
    """The supervisor that was found of a model, called as with `prepared`. Raises `UnusableModelError`."""
    if found.supervisor is not None:
        return found.supervisor
    told = [warning.message for warning in found.warnings or ()]
    model = message(f"obstacle.model.{which}")
    raise UnusableModelError(message("obstacle.unsupervised", model=model, why=joined(told) if told else ""))


def station_in(files: Files, stages: Path | None, folder: Path) -> ReadyStation:
    """The station that a model describes, written into `folder`. Raises `ModelError`."""
    folder.mkdir()
    write_files(files, folder, stages)
    with contextlib.chdir(folder):
        return prepare_station(Path())
