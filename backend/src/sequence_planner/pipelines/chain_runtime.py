"""Runtime of pipeline chains: records through stages over time, and outgoing messages from the state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

from sequence_planner.automaton.automaton import State
from sequence_planner.language.records.record import Record
from sequence_planner.model.stages.base import Closable, Overriding, Patient, Stage, StageInstance
from sequence_planner.pipelines.graph import Chain, Edge, EdgeView, OutgoingPipeline, PipelineView

# A chain of stages while it runs: records in, records out, time passing, and what has passed each edge.


class RunningChain:
    """One chain. With `patient`, stages that work beside are waited for, as in an example."""

    def __init__(self, chain: Chain, patient: bool = False) -> None:
        self._chain = chain
        self._patient = patient
        self._edges = [Edge() for _ in range(len(chain.stages) + 1)]
        self._courses: list[StageInstance] = []
        self.dropped: str | None = None  # what made no sense in the last record, if a filter has dropped it for that
        self.restart()

    def restart(self) -> None:
        """Forget every record. What a person has set stays until it expires."""
        self.close()
        kept = [each.override if isinstance(each, Overriding) else None for each in self._courses]
        self._courses = [self._begun(stage) for stage in self._chain.stages]
        for course, override in zip(self._courses, kept, strict=False):
            if override is not None and isinstance(course, Overriding):
                course.restore(override)

    def _begun(self, stage: Stage) -> StageInstance:
        return stage.begin_patiently() if self._patient and isinstance(stage, Patient) else stage.begin()

    @property
    def due(self) -> float | None:
        """The moment when time next makes a difference if nothing comes before."""
        moments = [due for course in self._courses if (due := course.due) is not None]
        return min(moments, default=None)

    def take(self, record: Record, now: float) -> Record | None:
        """Return what comes out at the end because of a record."""
        return self._push(record, 0, now)

    def wake(self, now: float) -> Iterator[Record]:
        """Yield what comes out at the end because time has passed, from the first stage on."""
        for index, course in enumerate(self._courses):
            if (due := course.due) is not None and due <= now and (record := course.wake(now)) is not None:
                came = self._push(record, index + 1, now)
                if came is not None:
                    yield came

    @property
    def overrides(self) -> dict[str, Overriding]:
        """The stages that a person can set, by name."""
        return {course.name: course for course in self._courses if isinstance(course, Overriding)}

    def set_override(self, name: str, fields: Mapping[str, object], now: float, actor: str) -> Record | None:
        """Return what comes out because a person sets fields. Raises ValueError for what the model does not allow."""
        return self._after(name, self.overrides[name].set_override(fields, now, actor), now)

    def clear_override(self, name: str, now: float) -> Record | None:
        """Return what comes out because a person takes back what was set."""
        return self._after(name, self.overrides[name].clear_override(now), now)

    def _after(self, name: str, record: Record | None, now: float) -> Record | None:
        if record is None:
            return None
        index = next(i for i, each in enumerate(self._courses) if isinstance(each, Overriding) and each.name == name)
        return self._push(record, index + 1, now)

    def edges(self, end: str) -> tuple[EdgeView, ...]:
        """Return what has passed each edge; `end` is what the last one leads to."""
        counts = [edge.records for edge in self._edges]
        names = [f"{number} {stage.kind}" for number, stage in enumerate(self._chain.stages, start=1)]
        held = [max(0, before - after) for before, after in pairwise(counts)]
        return tuple(
            EdgeView(
                name,
                edge.records,
                kept,
                None if edge.last is None else dict(edge.last.values),
                () if edge.last is None else tuple(edge.last.troubles),
                edge.at,
            )
            for name, edge, kept in zip((*names, end), self._edges, (*held, 0), strict=True)
        )

    def close(self) -> None:
        """End what stages have started beside. May be repeated."""
        for course in self._courses:
            if isinstance(course, Closable):
                course.close()

    def _push(self, record: Record, first: int, now: float) -> Record | None:
        """Carry a record from before a stage to the end. Each stage has a copy: what has passed an edge stays so."""
        edges = self._edges
        self.dropped = None
        for index in range(first, len(self._courses)):
            edges[index].passed(record, now)
            given = record.copy()
            taken = self._courses[index].take(given, now)
            if taken is None:
                if self._chain.stages[index].kind == "filter":
                    self.dropped = "; ".join(given.troubles) or None
                return None
            record = taken
        edges[-1].passed(record, now)
        return record


# An outgoing pipeline while it runs: from the state to records, and from a record to the message it says.


class RunningOutgoing:
    """One outgoing topic. Nothing is sent here: messages are returned, as their fields.

    `troubles` say what made no sense in the record of which the last message came.
    """

    def __init__(self, pipeline: OutgoingPipeline, patient: bool = False) -> None:
        self.chain = RunningChain(pipeline.chain, patient)
        self.troubles: tuple[str, ...] = ()
        self._pipeline = pipeline

    def take(self, state: State, now: float) -> dict[str, object] | None:
        """The message that says `state`; None when a stage does not let it through, or not yet."""
        record = self.chain.take(Record({name: state[variable] for name, variable in self._pipeline.read.items()}), now)
        return None if record is None else self._message(record)

    def wake(self, now: float) -> Iterator[dict[str, object]]:
        """The messages that come because time has passed."""
        return map(self._message, self.chain.wake(now))

    def set_override(self, name: str, fields: Mapping[str, object], now: float, actor: str) -> dict[str, object] | None:
        """The message that comes because a person sets fields. Raises ValueError for what the model does not allow."""
        record = self.chain.set_override(name, fields, now, actor)
        return None if record is None else self._message(record)

    def clear_override(self, name: str, now: float) -> dict[str, object] | None:
        """The message that comes because a person takes back what was set."""
        record = self.chain.clear_override(name, now)
        return None if record is None else self._message(record)

    def _message(self, record: Record) -> dict[str, object]:
        self.troubles = tuple(record.troubles)
        return message_of(self._pipeline, record)

    def observed(self) -> PipelineView:
        """Return what has passed each edge."""
        overrides = {name: course.override for name, course in self.chain.overrides.items()}
        topic = self._pipeline.topic.name
        return PipelineView(topic, self._pipeline.variables, self.chain.edges(topic), 0, overrides)


def first_message(pipeline: OutgoingPipeline, state: State) -> dict[str, object] | None:
    """The message that says `state` when it is the first; None when a stage does not let it through."""
    running = RunningOutgoing(pipeline, patient=True)
    try:
        return running.take(state, 0.0)
    finally:
        running.chain.close()


def message_of(pipeline: OutgoingPipeline, record: Record) -> dict[str, object]:
    """The fields of the message that a record says. Those that are unknown keep their default."""
    message: dict[str, object] = {}
    for setting in pipeline.settings:
        value = record.values.get(setting.field)
        if value is not None:
            put(message, setting.field.split("."), value)
    return message


def put(message: dict[str, object], path: list[str], value: object) -> None:
    """Put a value at a path of a nested message, beside what is there."""
    for name in path[:-1]:
        inner = message.get(name)
        inner = dict(inner) if isinstance(inner, dict) else {}
        message[name] = inner
        message = inner
    message[path[-1]] = value
