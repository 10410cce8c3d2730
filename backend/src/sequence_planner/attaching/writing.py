"""A topic in the text of a resource's document. Every byte that was there stays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sequence_planner.attaching.network import FoundTopic
from sequence_planner.attaching.proposals import Proposal
from sequence_planner.model.editing import insert, replace, same
from sequence_planner.model.entries import Layout
from sequence_planner.model.layout import in_brackets
from sequence_planner.model.reading import read_text
from sequence_planner.ros.quality import QualityOfService

USUAL_DEADLINE = 1.0  # seconds without a message after which what it said counts no more

_INTRODUCTION = {
    "in": "What else could be made of its fields: stages of `pipeline`, what they give is declared under `measured`.",
    "out": "What else could be sent in its fields: stages of `pipeline`.",
}


def document(topic: FoundTopic, stages: Sequence[Mapping[str, object]]) -> dict[str, object]:
    """The entry of a topic."""
    entry: dict[str, object] = {"type": topic.type_name, "direction": topic.direction}
    if topic.direction == "in" and not topic.quality.transient_local:
        entry["deadline"] = USUAL_DEADLINE
    if topic.quality != QualityOfService.RELIABLE:
        entry["quality"] = _quality(topic.quality)
    return {**entry, "pipeline": [dict(stage) for stage in stages]} if stages else entry


def _quality(quality: QualityOfService) -> object:
    name = str(quality)
    if not name.startswith("{"):
        return name
    return {
        "reliability": "reliable" if quality.reliable else "best_effort",
        "durability": "transient_local" if quality.transient_local else "volatile",
        "depth": quality.depth,
        **({} if quality.deadline is None else {"deadline": quality.deadline}),
    }


def with_topic(text: str, topic: FoundTopic, entry: Mapping[str, object], measured: Mapping[str, object]) -> str:
    """The text of a document with the topic and these variables. Raises `EditError`."""
    text = _with_entries(text, "topics", {topic.name: entry})
    return _with_entries(text, "measured", measured) if measured else text


def _with_entries(text: str, section: str, entries: Mapping[str, object]) -> str:
    content = read_text(text, "the document").content
    present = content if isinstance(content, dict) else {}
    if section not in present:
        after = "topics" if section != "topics" and "topics" in present else "title" if "title" in present else None
        return insert(text, (section,), dict(entries), after=after)
    if not present[section]:
        return replace(text, (section,), dict(entries))
    for name, entry in entries.items():
        text = insert(text, (section, name), entry)
    return text


def with_proposals(text: str, topic: FoundTopic, proposals: Sequence[Proposal]) -> str:
    """The text with comments above the topic that propose stages: where they belong to it, and leave with it."""
    layout = Layout.of(text)
    if layout is None or not proposals:
        return text
    at = layout.line_start(layout.entry(layout.find(("topics", topic.name))).start)
    line = text[at : layout.line_end(at)]
    margin = line[: len(line) - len(line.lstrip(" "))]
    lines = [f"{margin}# {_INTRODUCTION[topic.direction]}", *(f"{margin}#   - {_stage(each)}" for each in proposals)]
    commented = text[:at] + "".join(f"{line}\n" for line in lines) + text[at:]
    unchanged = same(read_text(text, "the document").content, read_text(commented, "the document").content)
    return commented if unchanged else text


def _stage(proposal: Proposal) -> str:
    return "; ".join(f"{kind}: {in_brackets(what)}" for kind, what in proposal.stage.items())
