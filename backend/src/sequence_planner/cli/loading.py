"""Models that commands are given: a station's folder, or the file of a plain automaton."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sequence_planner.analysis.store import content_key, read, write
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.cli.options import refuse

if TYPE_CHECKING:
    from sequence_planner.analysis.checks.connections import Connections
    from sequence_planner.station import ReadyStation

PLAIN_SUFFIX = ".efa.json"


@dataclass(frozen=True)
class LoadedModel:
    """An automaton, and the station that it is of; a plain automaton is of none."""

    automaton: Automaton
    station: ReadyStation | None

    @property
    def connections(self) -> Connections | None:
        """The connections that topics, services and actions feed and carry."""
        return None if self.station is None else self.station.connections


def load_model(path: Path) -> LoadedModel:
    """Read a model. Raises `ModelError` with the findings."""
    if path.name.endswith(PLAIN_SUFFIX):
        from sequence_planner.automaton.plain.meaning import plain_automaton  # noqa: PLC0415
        from sequence_planner.model.efa_document import load_plain  # noqa: PLC0415

        return LoadedModel(plain_automaton(load_plain(path)), None)
    from sequence_planner.station import prepare_station  # noqa: PLC0415 (a plain automaton needs no pipelines)

    station = prepare_station(path)
    return LoadedModel(station.automaton, station)


def usable_model(path: Path) -> LoadedModel:
    """Read a model, or end with what is wrong with it."""
    from sequence_planner.model.source import ModelError  # noqa: PLC0415 (most commands read none: see below)

    try:
        return load_model(path)
    except ModelError as error:
        refuse(str(error))


def usable_automaton(path: Path) -> Automaton:
    """The automaton of a model, kept from before where it was read by this very program; or end with what is wrong."""
    content = content_key(path)
    known = None if content is None else read(content, Automaton)
    if known is None:
        known = usable_model(path).automaton
        if content is not None and content == content_key(path):  # nobody has changed it meanwhile
            write(content, known)
    return known
