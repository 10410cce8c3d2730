"""The check whether a station's devices can be emulated: every value must be sayable, every command understandable."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.language.types import Place
from sequence_planner.model.source import Finding
from sequence_planner.simulation.devices import CommandReader, NotUnderstoodError
from sequence_planner.simulation.messages import CannotSpeakError, spoken
from sequence_planner.station import ReadyStation


def emulation_findings(station: ReadyStation) -> list[Finding]:
    """Return what of the station cannot be emulated, with the stages that cannot be read backwards."""
    return sorted({*_unspoken(station), *_not_understood(station), *_unbegun(station)})


def _unspoken(station: ReadyStation) -> Iterator[Finding]:
    pipelines, automaton = station.pipelines, station.automaton
    for variable, name in pipelines.feeds.items():
        for topic in pipelines.topics_of(name):
            for value in automaton.variables[variable].type.domain:
                try:
                    spoken(pipelines, topic, {**automaton.initial_valuation, variable: value}, {})
                except CannotSpeakError as error:
                    yield error.finding


def _unbegun(station: ReadyStation) -> Iterator[Finding]:
    """Yield what the devices would have to say at the beginning, all of it together."""
    pipelines, automaton = station.pipelines, station.automaton
    for topic in pipelines.sources:
        try:
            spoken(pipelines, topic, automaton.initial_valuation, {})
        except CannotSpeakError as error:
            yield error.finding


def _not_understood(station: ReadyStation) -> Iterator[Finding]:
    for name, pipeline in {**station.pipelines.outgoing, **station.pipelines.requests}.items():
        try:
            CommandReader(pipeline, station.automaton)
        except NotUnderstoodError as error:
            first = next((stage.place for stage in pipeline.chain.stages), Place(name, 1, 1))
            yield Finding(first, str(error))
