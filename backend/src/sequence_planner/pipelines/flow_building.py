"""Flows from documents: what their sources are, in which order they stand, and what their records begin with."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.expressions.lexer import KEYWORDS
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.flow_documents import FlowDocument
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.chains import Findings
from sequence_planner.pipelines.graph import Joining
from sequence_planner.pipelines.record import FieldType, RecordType

_NAME = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class WrittenFlow:
    """A flow as written, with its sources found: by alias, the full name of each."""

    name: str
    resource: str
    written: SourceText
    document: FlowDocument
    joining: Joining
    sources: Mapping[str, str]


def _why_no_name(text: str) -> str:
    return "it is a word of the language" if text in KEYWORDS else "use letters, digits and _"


def flow_name(resource: str, name: str) -> str:
    """The full name of a flow; topics have a slash before theirs."""
    return f"{resource}.{name}"


def found_flows(
    documents: Mapping[str, Mapping[SourceText, FlowDocument]],
    incoming: Iterable[str],
    outgoing: Iterable[str],
    findings: Findings,
) -> list[WrittenFlow]:
    """The flows of all resources, each behind its sources. Those with findings are left out, and those behind them."""
    names = {flow_name(resource, name) for resource, flows in documents.items() for name in flows}
    topics = set(incoming)
    finding = _Sources(names, topics, set(outgoing), findings)
    flows = {}
    for resource, written in documents.items():
        for name, document in written.items():
            if (flow := finding.flow(resource, name, document)) is not None:
                flows[flow.name] = flow
    return list(_in_order(flows, topics, findings))


@dataclass(frozen=True)
class _Sources:
    flows: set[str]
    topics: set[str]
    outgoing: set[str]
    findings: Findings

    def flow(self, resource: str, name: SourceText, document: FlowDocument) -> WrittenFlow | None:
        """A flow with its sources, or findings."""
        if not _NAME.fullmatch(name) or name in KEYWORDS:
            self.findings.add(name.place, f"`{name}` is no name for a flow: {_why_no_name(name)}")
            return None
        match document.source:
            case dict() as aliases:
                joining, written = Joining.MERGE, list(aliases.items())
            case list() as names:
                joining, written = Joining.INTERLEAVE, [(each, each) for each in names]
            case single:
                joining, written = Joining.BRANCH, [(single, single)]
        sources: dict[str, str] = {}
        is_sound = True
        for alias, source in written:
            if joining is Joining.MERGE and (not _NAME.fullmatch(alias) or alias in KEYWORDS):
                self.findings.add(alias.place, f"`{alias}` is no name for a source: {_why_no_name(alias)}")
                is_sound = False
            full = self._full(resource, source)
            if full is None:
                is_sound = False
            elif full in sources.values() and joining is not Joining.MERGE:
                self.findings.add(source.place, f"`{source}` is a source of this flow already")
                is_sound = False
            else:
                sources[str(alias) if joining is Joining.MERGE else full] = full
        return WrittenFlow(flow_name(resource, name), resource, name, document, joining, sources) if is_sound else None

    def _full(self, resource: str, source: SourceText) -> str | None:
        if source in self.topics:
            return str(source)
        for full in (flow_name(resource, source), str(source)):
            if full in self.flows:
                return full
        if source in self.outgoing:
            message = f"`{source}` is an outgoing topic: a flow comes of incoming topics and other flows"
        else:
            own = [each.removeprefix(f"{resource}.") for each in self.flows]
            message = f"there is no topic or flow `{source}`{suggestion(source, [*self.topics, *own])}"
        self.findings.add(source.place, message)
        return None


def _in_order(flows: Mapping[str, WrittenFlow], topics: set[str], findings: Findings) -> Iterator[WrittenFlow]:
    placed = set(topics)
    waiting = dict(flows)
    while ready := [flow for flow in waiting.values() if placed.issuperset(flow.sources.values())]:
        for flow in ready:
            yield flow
            placed.add(flow.name)
            del waiting[flow.name]
    said: set[str] = set()
    for flow in waiting.values():
        if flow.name not in said and (cycle := _cycle(flow.name, waiting)):
            said.update(cycle)
            findings.add(flow.written.place, f"`{flow.name}` comes from itself: {' → '.join(cycle)}")


def _cycle(name: str, flows: Mapping[str, WrittenFlow]) -> list[str] | None:
    """The way from a flow along what reads it back to itself, each behind its source."""
    ways = [[name]]
    seen = {name}
    while ways:
        way = ways.pop(0)
        for each in flows.values():
            if way[-1] in each.sources.values():
                if each.name == name:
                    return [*way, name]
                if each.name not in seen:
                    seen.add(each.name)
                    ways.append([*way, each.name])
    return None


def joined_fields(joining: Joining, ends: Mapping[str, RecordType]) -> dict[str, FieldType]:
    """The fields with which the records of a flow begin; `ends` has those of its sources by alias."""
    if joining is Joining.MERGE:
        return {f"{alias}.{name}": type_ for alias, fields in ends.items() for name, type_ in fields.items()}
    first, *others = ends.values()
    return {name: type_ for name, type_ in first.items() if all(each.get(name) == type_ for each in others)}
