"""All incoming pipelines of a station while they run: messages in, values of measured variables out.

Every record goes on at once through everything behind it, in the order of the graph: a flow that comes of one topic by
two ways has one record of it and not two. There is no clock and no thread here.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Set
from dataclasses import dataclass, field

from sequence_planner.language.records.field_paths import shown
from sequence_planner.language.records.record import Record
from sequence_planner.language.types import Value, contains
from sequence_planner.model.stages.base import Overriding
from sequence_planner.pipelines.chain_runtime import RunningChain
from sequence_planner.pipelines.graph import (
    Flow,
    IncomingPipeline,
    Joining,
    PipelineView,
    StationPipelines,
    VariableField,
)


@dataclass
class _Node:
    """A topic or a flow: its chain, and what its last record said. `latest` has the last record of each source.

    While it `is_spoilt`, the last message could not be read, and what stages still have of those before counts no more.
    """

    description: IncomingPipeline | Flow
    chain: RunningChain
    values: dict[str, Value | None] = field(default_factory=dict)
    trouble: str | None = None
    latest: dict[str, Record] = field(default_factory=dict)
    repeated: int = 0
    is_spoilt: bool = False

    def write(self, record: Record) -> None:
        """The variables take what the record says; values they cannot have make them unknown."""
        self.values, self.trouble = written_values(self.description.writings, record)

    def forget(self, sources: Set[str]) -> None:
        """As if nothing had come so far of these sources, and nothing had come of it itself."""
        self.chain.restart()
        self.is_spoilt = False
        self.values = {}
        self.trouble = None
        self.latest = {alias: record for alias, record in self.latest.items() if alias not in sources}


def written_values(writings: Iterable[VariableField], record: Record) -> tuple[dict[str, Value | None], str | None]:
    """The variables as the last record of a chain has them, and what made no sense; values they cannot have do not."""
    troubles = list(record.troubles)
    values = {writing.variable: _value(writing, record, troubles) for writing in writings}
    return values, "; ".join(troubles) or None


def _value(writing: VariableField, record: Record, troubles: list[str]) -> Value | None:
    value = record.values.get(writing.field)
    if value is None:
        return None
    if contains(writing.type, value):
        assert isinstance(value, bool | int | str)
        return value
    troubles.append(f"{writing.field} is {shown(value)}, and {writing.variable} ranges over {writing.type}")
    return None


class RunningPipelines:
    """The incoming graph. With `patient`, stages that work beside are waited for, as in an example."""

    def __init__(self, pipelines: StationPipelines, patient: bool = False) -> None:
        descriptions: dict[str, IncomingPipeline | Flow] = {**pipelines.sources, **pipelines.flows}
        self._nodes = {name: _Node(each, RunningChain(each.chain, patient)) for name, each in descriptions.items()}
        self._topics = {name: pipelines.topics_of(name) for name in self._nodes}
        self._behind = {
            topic: [name for name in self._nodes if topic in self._topics[name]] for topic in pipelines.sources
        }
        self._readers = {name: [flow.name for flow in pipelines.readers(name)] for name in self._nodes}
        self._timed = [node for node in self._nodes.values() if node.description.chain.is_timed]
        self._now = float("-inf")
        self._values: dict[str, Value | None] = {}  # as last told, when these topics were fresh
        self._fresh: dict[str, bool] | None = None
        self._changed: set[str] = set()  # the nodes whose values may have changed since
        self.repeats = {topic: self._may_repeat(names) for topic, names in self._behind.items()}

    def _may_repeat(self, names: Iterable[str]) -> bool:
        """Return whether a message that says the same as the one before makes no difference anywhere behind it."""
        nodes = [self._nodes[name].description for name in names]
        is_ordered = any(isinstance(each, Flow) and each.joining is Joining.INTERLEAVE for each in nodes)
        return not is_ordered and not any(each.chain.is_timed for each in nodes)

    def take(self, topic: str, values: dict[str, object], now: float) -> None:
        """Take a message, as its fields."""
        now = self._forward(now)
        self._nodes[topic].is_spoilt = False
        record = self._nodes[topic].chain.take(Record(values), now)
        if record is not None:
            self._carry({topic: [record]}, now, self._behind[topic])

    def repeat(self, topic: str) -> None:
        """Take a message that says the same as the one before, where `repeats` allows not to look at it."""
        self._nodes[topic].repeated += 1

    def spoil(self, topic: str, trouble: str) -> None:
        """A message could not be read: what comes of the topic is unknown until the next."""
        behind = self._behind[topic]
        self._changed.update(behind)
        for name in behind:
            node = self._nodes[name]
            node.values = {}
            node.is_spoilt = True
            if isinstance(node.description, Flow):
                lost = {alias for alias, source in node.description.sources.items() if source in behind}
                node.latest = {alias: record for alias, record in node.latest.items() if alias not in lost}
        self._nodes[topic].trouble = trouble

    def forget(self, topic: str) -> None:
        """The topic has fallen silent: what comes of it alone is as at the beginning, a merge waits for it again."""
        forgotten: set[str] = set()
        self._changed.update(self._behind[topic])
        for name in self._behind[topic]:
            node = self._nodes[name]
            sources = node.description.sources if isinstance(node.description, Flow) else {}
            gone = {alias for alias, source in sources.items() if source in forgotten}
            if not sources or gone == set(sources) or (gone and _needs_all(node.description)):
                forgotten.add(name)
                node.forget(gone)

    @property
    def due(self) -> float | None:
        """The moment when time next makes a difference if nothing comes before."""
        return min((due for node in self._timed if (due := node.chain.due) is not None), default=None)

    def wake(self, now: float) -> dict[str, str]:
        """Let time pass; what made no sense in what has come of it, by topic."""
        now = self._forward(now)
        came = {name: list(node.chain.wake(now)) for name, node in self._nodes.items() if _is_due(node, now)}
        self._carry(came, now, self._nodes)
        said = ((name, self._nodes[name].trouble) for name, records in came.items() if records)
        return {min(self._topics[name]): trouble for name, trouble in said if trouble is not None}

    def values(self, fresh: Mapping[str, bool]) -> dict[str, Value | None]:
        """All measured variables that are fed; those are unknown of which a source is not fresh."""
        if fresh != self._fresh:
            self._fresh = dict(fresh)
            self._changed = set(self._nodes)
        for name in self._changed:
            node = self._nodes[name]
            own = node.values if self.is_fresh(name, fresh) else {}
            for writing in node.description.writings:
                self._values[writing.variable] = own.get(writing.variable)
        self._changed = set()
        return dict(self._values)

    def is_fresh(self, name: str, fresh: Mapping[str, bool]) -> bool:
        """Return whether what a topic or a flow says counts, where these topics are `fresh`."""
        description = self._nodes[name].description
        if isinstance(description, IncomingPipeline):
            return fresh[name]
        sources = (self.is_fresh(source, fresh) for source in description.sources.values())
        return any(sources) if description.joining is Joining.INTERLEAVE else all(sources)

    def trouble(self, topic: str) -> str | None:
        """Say what in the last messages made no sense, in the topic's pipeline and in the flows behind it."""
        nodes = [self._nodes[name] for name in self._behind[topic]]
        said = [each for node in nodes for each in (node.trouble, node.chain.dropped) if each]
        return "; ".join(dict.fromkeys(said)) or None

    def overrides(self, pipeline: str) -> dict[str, Overriding]:
        """The stages of a pipeline that a person can set, by name. Raises KeyError for names that are none."""
        return self._nodes[pipeline].chain.overrides

    def set_override(self, pipeline: str, name: str, fields: Mapping[str, object], now: float, actor: str) -> None:
        """A person sets fields. Raises ValueError for what the model does not allow, and KeyError for other names."""
        now = self._forward(now)
        record = self._nodes[pipeline].chain.set_override(name, fields, now, actor)
        self._carry({pipeline: [] if record is None else [record]}, now, self._nodes)

    def clear_override(self, pipeline: str, name: str, now: float) -> None:
        """A person takes back what was set. Raises KeyError for names that are none."""
        now = self._forward(now)
        record = self._nodes[pipeline].chain.clear_override(name, now)
        self._carry({pipeline: [] if record is None else [record]}, now, self._nodes)

    def observed(self, among: Container[str] | None = None) -> dict[str, PipelineView]:
        """Return what has passed each edge of each pipeline, or of those `among` these."""
        views = {}
        for name, node in self._nodes.items():
            if among is not None and name not in among:
                continue
            sources = tuple(node.description.sources.values()) if isinstance(node.description, Flow) else ()
            end = ", ".join(node.description.variables) or ", ".join(self._readers[name])
            overrides = {each: course.override for each, course in node.chain.overrides.items()}
            views[name] = PipelineView(name, sources, node.chain.edges(end), node.repeated, overrides)
        return views

    def close(self) -> None:
        """End what stages have started beside. May be repeated."""
        for node in self._nodes.values():
            node.chain.close()

    def _forward(self, now: float) -> float:
        """Messages are taken when their turn comes, and may have been received before time last passed here."""
        self._now = max(self._now, now)
        return self._now

    def _carry(self, came: dict[str, list[Record]], now: float, among: Iterable[str]) -> None:
        """Carry records from the ends of chains on to variables and through the flows behind, in the graph's order."""
        self._changed.update(among)
        for name in among:
            node = self._nodes[name]
            if node.is_spoilt:
                came.pop(name, None)
            if isinstance(node.description, Flow):
                joined = _joined(node, node.description, came)
                node.is_spoilt = node.is_spoilt and not joined
                out = [record for each in joined if (record := node.chain.take(each, now)) is not None]
                if out:
                    came[name] = [*came.get(name, ()), *out]
            for record in came.get(name, ()):
                node.write(record)


def _needs_all(description: IncomingPipeline | Flow) -> bool:
    return not isinstance(description, Flow) or description.joining is not Joining.INTERLEAVE


def _is_due(node: _Node, now: float) -> bool:
    due = node.chain.due
    return due is not None and due <= now


def _joined(node: _Node, flow: Flow, came: Mapping[str, list[Record]]) -> list[Record]:
    """The records with which a flow begins because its sources have had these, which have said what made no sense."""
    news = [(alias, record) for alias, source in flow.sources.items() for record in came.get(source, ())]
    if flow.joining is not Joining.MERGE:
        fields = flow.chain.fields[0]
        return [Record({name: record.values.get(name) for name in fields}) for _, record in news]
    if not news:
        return []
    node.latest.update(news)
    if len(node.latest) < len(flow.sources):
        return []
    values = {
        f"{alias}.{name}": value for alias, record in node.latest.items() for name, value in record.values.items()
    }
    return [Record(values)]
