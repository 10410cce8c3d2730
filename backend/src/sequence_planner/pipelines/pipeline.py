"""The pipeline of one topic, incoming or outgoing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.automaton.structure import State
from sequence_planner.expressions.types import Value
from sequence_planner.pipelines.stages import (
    ConstantStage,
    DiscretiseStage,
    FieldStage,
    Reading,
    Record,
    RememberStage,
    UndiscretiseStage,
)
from sequence_planner.ros.transport import QualityOfService


@dataclass(frozen=True)
class Topic:
    """A topic as the station uses it."""

    name: str
    type_name: str
    resource: str
    quality: QualityOfService


@dataclass(frozen=True)
class IncomingPipeline:
    """From messages to measured variables. Without a message for `deadline` seconds they are unknown."""

    topic: Topic
    deadline: float | None
    fields: tuple[FieldStage, ...] = ()
    discretised: tuple[DiscretiseStage, ...] = ()
    remembered: tuple[RememberStage, ...] = ()

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables this topic feeds."""
        names = [stage.variable for stage in self.fields]
        names += [stage.variable for stage in self.discretised]
        return (*names, *(stage.variable for stage in self.remembered))

    def read(self, record: Record, memory: dict[str, Value | None]) -> Reading:
        """What a decoded message says; `memory` is kept from message to message by the caller."""
        reading = Reading()
        for stage in self.fields:
            stage.read(record, reading)
        for discretising in self.discretised:
            discretising.read(record, reading)
        for remembering in self.remembered:
            remembering.read(memory, reading)
        return reading

    def device_record(self, state: State, numbers: Mapping[str, tuple[float, ...]]) -> dict[str, object]:
        """The message with which a device would say `state`; `numbers` are those behind each discretised variable."""
        record: dict[str, object] = {}
        for stage in self.fields:
            stage.write(state, record)
        for discretised in self.discretised:
            record[discretised.field] = list(numbers[discretised.variable])
        return record


@dataclass(frozen=True)
class OutgoingPipeline:
    """From output variables to messages, repeated `every` so many seconds."""

    topic: Topic
    every: float | None
    fields: tuple[FieldStage, ...] = ()
    undiscretised: tuple[UndiscretiseStage, ...] = ()
    constants: tuple[ConstantStage, ...] = ()

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables whose change makes a new message."""
        names = (*(s.variable for s in self.fields), *(s.variable for s in self.undiscretised))
        return tuple(dict.fromkeys(names))

    def write(self, state: State) -> dict[str, object]:
        """The message that says `state`; fields nobody sets keep their default."""
        record: dict[str, object] = {}
        for stage in self.fields:
            stage.write(state, record)
        for undiscretising in self.undiscretised:
            undiscretising.write(state, record)
        for constant in self.constants:
            constant.write(record)
        return record

    def device_reading(self, record: Record) -> Reading:
        """What a device takes from a message: the output variables it carries."""
        reading = Reading()
        for undiscretised in self.undiscretised:
            undiscretised.read(record, reading)
        for stage in self.fields:  # a name says more than its coordinates
            stage.read(record, reading)
        return reading


@dataclass(frozen=True)
class StationPipelines:
    """All pipelines of a station, by topic."""

    incoming: Mapping[str, IncomingPipeline]
    outgoing: Mapping[str, OutgoingPipeline]

    @property
    def feeds(self) -> Mapping[str, str]:
        """The topic that feeds each measured variable."""
        return {variable: name for name, pipeline in self.incoming.items() for variable in pipeline.variables}
